// Pages from the files of this folder, which are part of the library.

#include <embedded.h>
#include <kaboum/page/page.h>

namespace kaboum::page {

std::string in_script(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

std::string filled(std::string_view file, const std::map<std::string, std::string>& values) {
  std::string_view page = embedded(file);
  std::string out;
  for (;;) {
    const std::size_t begin = page.find("{{");
    out += page.substr(0, begin);
    if (begin == std::string_view::npos) return out;
    const std::size_t end = page.find("}}", begin);
    const std::string name(page.substr(begin + 2, end - begin - 2));
    const std::string_view text = embedded(name);
    out += text.empty() ? std::string_view(values.at(name)) : text;
    page.remove_prefix(end + 2);
  }
}

}  // namespace kaboum::page

// Notes about files, each said once.

#include <kaboum/base/notes.h>

#include <algorithm>

namespace kaboum {

void Notes::add(const std::string& file, const std::string& text) {
  auto at = std::find_if(notes_.begin(), notes_.end(),
                         [&](const auto& note) { return note.first == text; });
  if (at == notes_.end()) at = notes_.insert(at, {text, {}});
  std::vector<std::string>& files = at->second;
  if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
}

std::vector<std::string> Notes::lines(const std::function<bool(std::string_view)>& wanted) const {
  std::vector<std::string> out;
  for (const auto& [text, files] : notes_) {
    if (wanted && !wanted(text)) continue;
    std::string line = files.front();
    if (files.size() == 2) line += " and " + files.back();
    if (files.size() > 2) line += " and " + std::to_string(files.size() - 1) + " more meshes";
    out.push_back(line.append(": ").append(text));
  }
  return out;
}

}  // namespace kaboum

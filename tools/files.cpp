// Formats by option or name, outputs that are not to be inputs, rules for make.

#include "files.h"

#include <kaboum/base/error.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "xml_route.h"

namespace kaboum::tools {
namespace {

std::string lower_extension(const std::string& path) {
  std::string out = std::filesystem::path(path).extension().string();
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return out;
}

/// What to do with a file of a kind that is no mesh to read; empty when there is nothing to say.
std::string route(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".brep") return "this kind of CAD file is not read; export it as STEP";
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* n) { return extension == n; });
  };
  if (!is({".xacro", ".urdf", ".srdf", ".sdf", ".world", ".mjcf", ".xml", ".rlkin", ".rlmdl"}))
    return {};
  io::XmlKind kind = io::XmlKind::None;
  try {
    const std::vector<char> bytes = io::read_file(path);
    kind = io::xml_kind({bytes.data(), bytes.size()});
  } catch (const Error& error) {
    return error.what();
  }
  if (extension == ".xacro") kind = io::XmlKind::Xacro;
  if (kind != io::XmlKind::None) return route_to_mesh(kind, path);
  return "neither a mesh nor well-formed XML";
}

/// Without slashes at the end.
std::filesystem::path without_slash(std::string name) {
  while (name.size() > 1 && name.back() == '/') name.pop_back();
  return name;
}

}  // namespace

bool is_folder(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_directory(path, error);
}

io::Format format_for(const std::string& path, const std::string& name, const char* option) {
  const auto listed = [](const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& n : names) text += (text.empty() ? "" : ", ") + n;
    return text;
  };
  const bool reading = std::string_view(option) != "--output-format";
  if (!reading && path.ends_with('/'))
    throw Error(ErrorCode::InvalidArgument, path + ": name a file, not a folder");
  if (reading && is_folder(path))
    throw Error(ErrorCode::InvalidInput, path + " is a folder, not a mesh file");
  const std::string choices = listed(reading ? io::readable_formats() : io::writable_formats());
  if (!name.empty()) {
    if (const auto f = io::format_from_name(name)) return *f;
    throw Error(ErrorCode::InvalidArgument,
                std::string(option) + ": unknown format '" + name + "'; known: " + choices);
  }
  if (path == "-")
    throw Error(ErrorCode::InvalidArgument,
                std::string(option) + " is needed with '-'; known: " + choices);
  if (const auto f = io::format_from_name(std::filesystem::path(path).extension().string()))
    return *f;
  if (std::error_code error; reading && !std::filesystem::exists(path, error))
    throw Error(ErrorCode::InvalidInput, path + ": no such file or folder");
  if (const std::string way = reading ? route(path) : std::string(); !way.empty())
    throw Error(ErrorCode::InvalidInput, path + ": " + way);
  throw Error(reading ? ErrorCode::InvalidInput : ErrorCode::InvalidArgument,
              path + ": unknown file extension; use one of " + choices + ", or give " + option);
}

namespace {

/// What cannot be written is noticed before anything is computed.
/// @throws Error{OutputFailed}
void require_writable(const std::string& option, const std::string& file) {
  // Only results may be folders that are made.
  const bool result = option == "--output";
  std::filesystem::path folder =
      (result ? without_slash(file) : std::filesystem::path(file)).parent_path();
  if (folder.empty()) folder = ".";
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::OutputFailed, option + ": " + what);
  };
  std::error_code error;
  const auto type = std::filesystem::status(folder, error).type();
  if (type == std::filesystem::file_type::none && error)
    fail(folder.string() + ": " + error.message());
  if (type == std::filesystem::file_type::not_found)
    fail("there is no folder " + folder.string() + "; create it first");
  if (type != std::filesystem::file_type::directory) fail(folder.string() + " is no folder");
  const auto own = std::filesystem::status(file, error).type();
  if (own == std::filesystem::file_type::directory && !result)
    fail(file + " is a folder; name a file");
  // Files are written beside their place and renamed; devices and pipes are written to, and links
  // lead elsewhere.
  const bool renamed =
      !std::filesystem::is_symlink(file, error) &&
      (own == std::filesystem::file_type::not_found || own == std::filesystem::file_type::regular);
  if (renamed && ::access(folder.c_str(), W_OK) != 0)
    fail("the folder " + folder.string() + " cannot be written to");
}

}  // namespace

void require_apart(const std::vector<std::pair<std::string, std::string>>& outputs,
                   const std::vector<std::string>& inputs) {
  const auto place = [](const std::string& file) {
    if (file == "-") return std::filesystem::path("-");
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::absolute(without_slash(file), error);
    const std::filesystem::path found = std::filesystem::weakly_canonical(whole, error);
    return error ? whole.lexically_normal() : found;
  };
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::string& file = outputs[i].second;
    if (file.empty()) continue;
    if (file != "-") require_writable(outputs[i].first, file);
    for (const std::string& input : inputs) {
      if (input != "-" && place(file) == place(input))
        throw Error(ErrorCode::InvalidArgument,
                    outputs[i].first + " would overwrite the input " + input);
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (!outputs[j].second.empty() && place(file) == place(outputs[j].second))
        throw Error(ErrorCode::InvalidArgument,
                    outputs[j].first + " and " + outputs[i].first + " cannot both be " + file);
    }
  }
}

void write_depfile(const std::string& path, const std::vector<std::string>& targets,
                   const std::vector<std::string>& inputs) {
  const auto escaped = [](const std::string& s) {
    std::string out;
    for (const char c : s) {
      if (c == ' ' || c == '#' || c == '\\') out += '\\';
      if (c == '$') out += '$';
      out += c;
    }
    return out;
  };
  std::string text;
  for (const std::string& target : targets)
    if (!target.empty()) text += (text.empty() ? "" : " ") + escaped(target);
  text += ":";
  std::set<std::string> listed{"-"};
  for (const std::string& input : inputs)
    if (listed.insert(input).second) text += " " + escaped(input);
  text += "\n";
  io::write_file(path, text);
}

std::vector<std::string> inputs_in_depfile(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return {};
  const std::vector<char> text = io::read_file(path);
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool escaped = (c == '\\' || c == '$') && i + 1 < text.size();
    if (c == ' ' || c == '\n')
      words.emplace_back();
    else
      words.back() += escaped ? text[++i] : c;
  }
  const auto last_target =
      std::ranges::find_if(words, [](const auto& w) { return w.ends_with(':'); });
  if (last_target != words.end()) words.erase(words.begin(), last_target + 1);
  std::erase(words, std::string());
  return words;
}

}  // namespace kaboum::tools

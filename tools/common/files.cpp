// Formats by option or name, outputs that are not to be inputs, rules for make.

#include "files.h"

#include <kaboum/base/error.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
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
  if (std::string way = io::route_to_assimp(path); !way.empty()) return way;
  const std::string extension = lower_extension(path);
  if (extension == ".brep") return "this kind of CAD file is not read; export it as STEP";
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* n) { return extension == n; });
  };
  if (!is({".xacro", ".urdf", ".srdf", ".sdf", ".world", ".mjcf", ".xml", ".rlkin", ".rlmdl"}))
    return {};
  io::XmlKind kind = io::XmlKind::None;
  std::string other;
  try {
    const std::vector<char> bytes = io::read_file(path);
    kind = io::xml_kind({bytes.data(), bytes.size()});
    other = io::describe_other({bytes.data(), bytes.size()});
  } catch (const Error& error) {
    return error.what();
  }
  if (extension == ".xacro") kind = io::XmlKind::Xacro;
  if (kind == io::XmlKind::None) return "neither a mesh nor a robot: " + other;
  if (kind == io::XmlKind::Other) return other + "; " + route_to_mesh(kind, path);
  return route_to_mesh(kind, path);
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

std::optional<io::Format> InputFormat::stated() const {
  if (!importer.empty()) return io::Format::Assimp;
  return io::format_from_name(name);
}

void add_input_format(CLI::App& app, InputFormat& format, const std::string& text) {
  CLI::Option* name = app.add_option("--input-format", format.name, text)->type_name("NAME");
  std::string extensions;
  for (const std::string& extension : io::imported_extensions())
    extensions.append(extensions.empty() ? "" : ", ").append(extension);
  app.add_option("--importer", format.importer,
                 "Have assimp read files of formats that have no reader here: " + extensions +
                     ". It delivers 32-bit floats and leaves out without a message what it does "
                     "not know: what is claimed is about the triangles that it delivers")
      ->check(CLI::IsMember({"assimp"}).description(""))
      ->excludes(name)
      ->type_name("assimp");
}

io::Format format_for(const std::string& path, const InputFormat& format) {
  if (format.importer.empty() || is_folder(path))
    return format_for(path, format.name, "--input-format");
  return io::format_of_file(path, format.stated());
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
  std::string depfile;
  std::vector<std::string> targets;
  for (const auto& [option, file] : outputs) {
    if (option == "--depfile") depfile = file;
    if (option == "--output" || option == "--progressive") targets.push_back(file);
  }
  require_depfile(depfile, targets, inputs);
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

namespace {

/// Where a list of files is written instead of a rule: any name can be in it.
bool is_list(const std::string& depfile) { return depfile.ends_with(".list"); }

/// Why a character cannot be in a name within a rule; empty where it can. There is no way to write
/// these that GNU make and ninja both read so.
std::string_view no_place_for(char c, bool target) {
  if (static_cast<unsigned char>(c) < ' ' || c == '\x7F') return "a control character";
  if (c == '*' || c == '?' || c == '[') return "a wildcard of make";
  if (c == '\'' || c == '"' || c == '`') return "a quotation mark";
  if (c == '<' || c == '>') return "'<' or '>'";
  if (c == '=') return "'='";
  if (c == ';') return "';'";
  if (c == '|') return "'|'";
  if (c == '&') return "'&'";
  if (c == '^') return "'^'";
  if (target && c == '%') return "'%'";
  return {};
}

/// A name as GNU make and ninja both read it.
/// @throws Error{InvalidArgument} where there is no such way
std::string in_rule(const std::string& name, bool target) {
  const auto refuse = [&](std::string_view what) {
    std::string shown = name;
    std::ranges::replace_if(
        shown, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7F'; }, '?');
    throw Error(ErrorCode::InvalidArgument,
                "--depfile: the name '" + shown + "' has " + std::string(what) +
                    ", which has no place in a rule of make; rename it, or let the name of the "
                    "dependency file end in .list");
  };
  std::string out;
  std::size_t backslashes = 0;  // right before
  for (const char c : name) {
    if (const std::string_view why = no_place_for(c, target); !why.empty()) refuse(why);
    if ((c == '#' || c == ':') && backslashes > 0) refuse("a backslash before '#' or ':'");
    if (c == ' ') out.append(backslashes, '\\');  // they are halved there
    if (c == ' ' || c == '#' || c == ':') out += '\\';
    if (c == '$') out += '$';
    out += c;
    backslashes = c == '\\' ? backslashes + 1 : 0;
  }
  if (backslashes > 0) refuse("a backslash at its end");
  if (name.starts_with('~')) refuse("'~' at its beginning");
  if (name.ends_with(')')) refuse("')' at its end");
  return out;
}

std::string rule_of(const std::vector<std::string>& targets,
                    const std::vector<std::string>& inputs) {
  std::string text;
  for (const std::string& target : targets)
    if (!target.empty()) text += (text.empty() ? "" : " ") + in_rule(target, true);
  text += ":";
  std::set<std::string> listed{"-"};
  for (const std::string& input : inputs)
    if (listed.insert(input).second) text += " " + in_rule(input, false);
  return text + "\n";
}

std::string list_of(const std::vector<std::string>& inputs) {
  std::string text;
  std::set<std::string> listed{"-"};
  for (const std::string& input : inputs)
    if (listed.insert(input).second) text += input + '\0';
  return text;
}

}  // namespace

void require_depfile(const std::string& path, const std::vector<std::string>& targets,
                     const std::vector<std::string>& inputs) {
  if (!path.empty() && !is_list(path)) rule_of(targets, inputs);
}

void write_depfile(const std::string& path, const std::vector<std::string>& targets,
                   const std::vector<std::string>& inputs) {
  io::write_file(path, is_list(path) ? list_of(inputs) : rule_of(targets, inputs));
}

}  // namespace kaboum::tools

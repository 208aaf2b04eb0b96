#include "cli.h"

#include <kaboum/base/error.h>

#include <sys/resource.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iostream>
#include <new>
#include <set>
#include <sstream>

#include "help.h"
#include "xml_kind.h"

namespace kaboum::tools {
namespace {

int exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::InvalidArgument:
      return kUsage;
    case ErrorCode::InvalidInput:
      return kBadInput;
    case ErrorCode::OutputFailed:
      return kOutputFailed;
    case ErrorCode::NotBuilt:
      return kNotBuilt;
    case ErrorCode::LimitReached:
      return kLimit;
    case ErrorCode::Internal:
      break;
  }
  return kInternal;
}

/// As std::from_chars, after a plus sign that may come first.
std::from_chars_result parse_number(std::string_view text, double& value) {
  const char *begin = text.data(), *end = begin + text.size();
  if (text.starts_with('+') && !text.starts_with("+-")) ++begin;
  return std::from_chars(begin, end, value);
}

std::string lower_extension(const std::string& path) {
  std::string out = std::filesystem::path(path).extension().string();
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return out;
}

/// What to do with a file of a kind that is no mesh to read; empty when there is nothing to say.
std::string route(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".step" || extension == ".stp" || extension == ".iges" || extension == ".igs" ||
      extension == ".brep")
    return "CAD files are not read; make a mesh of it, for example by gmsh: gmsh " + path +
           " -2 -clmax 5 -o part.stl (5: longest edge, in its unit)";
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* n) { return extension == n; });
  };
  if (!is({".xacro", ".urdf", ".srdf", ".sdf", ".world", ".mjcf", ".xml", ".rlkin", ".rlmdl"}))
    return {};
  XmlKind kind = XmlKind::None;
  try {
    const std::vector<char> bytes = io::read_file(path);
    kind = xml_kind({bytes.data(), bytes.size()});
  } catch (const Error& error) {
    return error.what();
  }
  if (extension == ".xacro") kind = XmlKind::Xacro;
  if (kind != XmlKind::None) return route_to_mesh(kind, path);
  return "neither a mesh nor well-formed XML";
}

/// Without slashes at the end.
std::filesystem::path without_slash(std::string name) {
  while (name.size() > 1 && name.back() == '/') name.pop_back();
  return name;
}

}  // namespace

const char* version() { return KABOUM_VERSION; }

int run(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  app.set_version_flag("--version", app.get_name() + " " + KABOUM_VERSION);
  wrap_help(app);
  const std::string name = app.get_name();
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    if (app.exit(success) != 0) return kInternal;
    if (std::cout.flush()) return kDone;
    std::cerr << name << ": standard output: writing failed\n";
    return kOutputFailed;
  } catch (const CLI::ParseError& error) {
    const std::string unknown = explain_unknown(app, argc, argv);
    std::cerr << name << ": " << (unknown.empty() ? error.what() : unknown) << " (see " << name
              << " --help)\n";
    return kUsage;
  }
  try {
    const int code = body();
    if (!std::cout.flush()) throw Error(ErrorCode::OutputFailed, "standard output: writing failed");
    return code;
  } catch (const Error& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return exit_code(error.code());
  } catch (const std::bad_alloc&) {
    std::cerr << name << ": out of memory\n";
    return kLimit;
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << name << ": " << error.path1().string() << ": " << error.code().message() << '\n';
    return kOutputFailed;  // inputs are opened, not looked at
  } catch (const std::exception& error) {
    std::cerr << name << ": internal error: " << error.what() << '\n';
    return kInternal;
  }
}

void add_common_options(CLI::App& app, CommonOptions& options) {
  app.add_option("--report", options.report, "Write a JSON report to this file (- for stdout)")
      ->type_name("FILE");
  app.add_option("--threads", options.threads,
                 "Number of threads; 0: one per core; same bytes for any")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--seed", options.seed, "Seed of whatever is random; the result itself is not")
      ->capture_default_str()
      ->type_name("N");
  app.add_flag("--quiet", options.quiet, "Print errors only");
}

struct ThreadLimit::Impl {
  explicit Impl(std::size_t n) : control(tbb::global_control::max_allowed_parallelism, n) {}
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
    : impl_(threads > 0 ? std::make_unique<Impl>(static_cast<std::size_t>(threads)) : nullptr) {}
ThreadLimit::~ThreadLimit() = default;

std::optional<Length> parse_length(const std::string& text) {
  Length length;
  const char* end = text.data() + text.size();
  const auto [stop, error] = parse_number(text, length.value);
  if (error != std::errc() || !std::isfinite(length.value) || !(length.value > 0))
    return std::nullopt;
  length.percent = stop != end && *stop == '%';
  if (stop + (length.percent ? 1 : 0) != end) return std::nullopt;
  return length;
}

CLI::Validator number_from(double low, double high) {
  std::ostringstream text;
  text << "must be a number from " << low << " to " << high << ", without a unit";
  return {[=, why = text.str()](std::string& s) {
            double x = 0;
            const auto [end, error] = parse_number(s, x);
            const bool whole = error == std::errc() && end == s.data() + s.size();
            return whole && x >= low && x <= high ? std::string() : why + ", not " + s;
          },
          ""};
}

CLI::Validator png_name() {
  return {[](std::string& s) {
            std::string extension = std::filesystem::path(s).extension().string();
            std::transform(extension.begin(), extension.end(), extension.begin(),
                           [](unsigned char c) { return std::tolower(c); });
            return s == "-" || extension == ".png"
                       ? std::string()
                       : "a PNG is written: give a name that ends with .png, not " + s;
          },
          ""};
}

CLI::Validator unit_name() {
  return CLI::IsMember({"m", "dm", "cm", "mm", "um", "km", "in", "ft"}).description("");
}

Progress::Progress(bool quiet) : active_(!quiet && isatty(STDERR_FILENO) == 1) {}
Progress::~Progress() {
  if (shown_) std::cerr << "\r\033[K";
}
void Progress::show(const std::string& text) {
  if (!active_) return;
  shown_ = true;
  std::cerr << '\r' << text << "\033[K" << std::flush;
}

void log(bool quiet, const std::string& text) {
  if (!quiet) std::cerr << text << '\n';
}

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

Json to_json(const geom::TopologyReport& t) {
  return {{"vertices", t.vertices},
          {"triangles", t.triangles},
          {"edges", t.edges},
          {"components", t.components},
          {"closed", t.closed()},
          {"manifold", t.manifold()},
          {"open_edges", t.open_edges},
          {"nonmanifold_edges", t.nonmanifold_edges},
          {"inconsistent_edges", t.inconsistent_edges},
          {"unbalanced_edges", t.unbalanced_edges},
          {"nonmanifold_vertices", t.nonmanifold_vertices},
          {"degenerate_triangles", t.degenerate_triangles},
          {"duplicate_triangles", t.duplicate_triangles}};
}

Json to_json(const geom::DirectedDistance& d, double diagonal) {
  return {{"max_lower", d.max_lower},
          {"max_upper", d.max_upper},
          {"max_upper_percent", diagonal > 0 ? 100 * d.max_upper / diagonal : 0.0},
          {"at", {d.at.x(), d.at.y(), d.at.z()}}};
}

double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void require_absent(const CLI::App& app, const std::string& option,
                    const std::vector<std::string>& others) {
  for (const std::string& other : others)
    if (app.get_option(other)->count() != 0)
      throw Error(ErrorCode::InvalidArgument,
                  std::string(option).append(" cannot be joined with ").append(other));
}

void write_json(const std::string& path, const Json& json) {
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  io::write_file(path, text);
}

void write_report(const CommonOptions& options, const char* tool, const Json& body) {
  if (options.report.empty()) return;
  Json report{{"schema", 1}, {"tool", tool}, {"version", version()}};
  report.update(body);
  report["resources"]["user_seconds"] = user_seconds();
  report["resources"]["peak_megabytes"] = peak_megabytes();
  write_json(options.report, report);
}

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
    // Only results may be folders that are made.
    const std::filesystem::path folder =
        (outputs[i].first == "--output" ? without_slash(file) : std::filesystem::path(file))
            .parent_path();
    if (file != "-" && !folder.empty()) {
      std::error_code error;
      const auto type = std::filesystem::status(folder, error).type();
      if (type == std::filesystem::file_type::none && error)
        throw Error(ErrorCode::OutputFailed,
                    outputs[i].first + ": " + folder.string() + ": " + error.message());
      if (type != std::filesystem::file_type::directory)
        throw Error(ErrorCode::OutputFailed, outputs[i].first + ": there is no folder " +
                                                 folder.string() + "; create it first");
    }
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

}  // namespace kaboum::tools

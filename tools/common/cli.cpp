// Runs a tool: its command line, its errors as exit codes, what it says.

#include "cli.h"

#include <kaboum/base/option.h>
#include <sys/ioctl.h>
#include <tbb/global_control.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <iostream>
#include <new>

#include "help.h"

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

/// An option or argument that was given without a value, as scripts do with variables that are not
/// set; nullptr: there is none.
const CLI::Option* without_value(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& value : option->results())
      if (value.empty()) return option;
  for (const CLI::App* command : app.get_subcommands())
    if (const CLI::Option* option = without_value(*command)) return option;
  return nullptr;
}

/// Of the terminal that stderr is.
std::size_t columns() {
  constexpr std::size_t kUsual = 80;
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : kUsual;
}

/// Bytes of the first characters of a UTF-8 text.
std::size_t size_within(const std::string& text, std::size_t characters) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U && characters-- == 0) return i;
  return text.size();
}

/// "kaboum-scene make", where a command was given.
std::string name_with_command(const CLI::App& app, int argc, char** argv) {
  if (argc > 1)
    for (const CLI::App* command : app.get_subcommands({}))
      if (command->check_name(argv[1])) return app.get_name() + " " + command->get_name();
  return app.get_name();
}

}  // namespace

const char* version() { return KABOUM_VERSION; }

int run(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  // A file that may not grow is one that cannot be written, as on a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
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
    std::cerr << name << ": " << (unknown.empty() ? error.what() : unknown) << " (see "
              << name_with_command(app, argc, argv) << " --help)\n";
    return kUsage;
  }
  if (const CLI::Option* option = without_value(app)) {
    std::cerr << name << ": " << option->get_name()
              << " is empty: give it a value, or leave it out\n";
    return kUsage;
  }
  try {
    const int code = body();
    if (!std::cout.flush()) throw Error(ErrorCode::OutputFailed, "standard output: writing failed");
    return code;
  } catch (const Error& error) {
    std::cerr << name << ": " << remedy_of_program(error.what()) << '\n';
    return exit_code(error.code());
  } catch (const std::bad_alloc&) {
    std::cerr << name << ": out of memory\n";
    return kLimit;
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << name << ": " << error.path1().string() << ": " << error.code().message() << '\n';
    return kOutputFailed;  // inputs are opened, not looked at
  } catch (const nlohmann::json::type_error& error) {
    constexpr int kNotUtf8 = 316;
    if (error.id != kNotUtf8) {
      std::cerr << name << ": internal error: " << error.what() << '\n';
      return kInternal;
    }
    std::cerr << name << ": a name is not UTF-8, which the result has to be; rename it\n";
    return kBadInput;
  } catch (const std::exception& error) {
    std::cerr << name << ": internal error: " << error.what() << '\n';
    return kInternal;
  }
}

void add_xacro_arguments(CLI::App& app, std::vector<std::string>& arguments) {
  app.add_option("--xacro-args", arguments,
                 "Arguments of a .xacro file, as the program xacro takes them, as in name:=left "
                 "prefix:=l_; further ones may follow, or the option may be repeated")
      ->type_name("NAME:=VALUE");
}

void add_common_options(CLI::App& app, CommonOptions& options) {
  app.add_option("--report", options.report, "Write a JSON report to this file (- for stdout)")
      ->type_name("FILE");
  app.add_option("--threads", options.threads,
                 "Number of threads; 0: one per core; same bytes for any")
      ->check(CLI::Range(0, 1024))
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

void require_absent(const CLI::App& app, const std::string& option,
                    const std::vector<std::string>& others) {
  for (const std::string& other : others)
    if (app.get_option(other)->count() != 0)
      throw Error(ErrorCode::InvalidArgument,
                  std::string(option).append(" cannot be joined with ").append(other));
}

Progress::Progress(bool quiet) : active_(!quiet && isatty(STDERR_FILENO) == 1) {}
Progress::~Progress() {
  if (shown_) std::cerr << "\r\033[K";
}
void Progress::show(const std::string& text) {
  if (!active_) return;
  shown_ = true;
  std::cerr << '\r' << text.substr(0, size_within(text, columns() - 1)) << "\033[K" << std::flush;
}

void log(bool quiet, const std::string& text) {
  if (!quiet) std::cerr << remedy_of_program(text) << '\n';
}

}  // namespace kaboum::tools

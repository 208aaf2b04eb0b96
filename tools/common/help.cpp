// How --help looks, and what is said of options that do not exist.

#include "help.h"

#include <kaboum/base/similar_name.h>

#include <sys/ioctl.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <vector>

namespace kaboum::tools {
namespace {

constexpr std::size_t kNarrowest = 40, kWidest = 110;
constexpr std::size_t kIndent = 6;  ///< of descriptions
constexpr std::size_t kGroupIndent = 2;

std::size_t terminal_width() {
  std::size_t width = 0;
  if (const char* columns = std::getenv("COLUMNS"))
    std::from_chars(columns, columns + std::string_view(columns).size(), width);
  winsize size{};
  if (width == 0 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) width = size.ws_col;
  if (width == 0) width = 80;
  return std::clamp(width, kNarrowest, kWidest);
}

/// `text` in lines of at most `width` columns where its words allow that, `indent` blanks before
/// each; lines that begin with a blank are examples and stay as they are.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width) {
  std::string out;
  const std::string margin(indent, ' ');
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.starts_with(' ')) {
      out.append(margin).append(line).append("\n");
      continue;
    }
    std::size_t column = 0;
    while (!line.empty()) {
      const std::string_view word = line.substr(0, line.find(' '));
      line.remove_prefix(std::min(line.size(), word.size() + 1));
      if (word.empty()) continue;
      if (column != 0 && column + 1 + word.size() > width) {
        out += '\n';
        column = 0;
      }
      out += column == 0 ? margin : " ";
      out += word;
      column = (column == 0 ? indent : column + 1) + word.size();
    }
    out += '\n';
  }
  return out;
}

/// "INT in [8 - 100]" and "{a,b}", as validators describe themselves, in words.
std::string in_words(std::string_view limits) {
  const std::size_t open = limits.find('['), close = limits.find(']');
  if (open != std::string_view::npos && close != std::string_view::npos && open < close) {
    const std::string_view range = limits.substr(open + 1, close - open - 1);
    const std::size_t dash = range.find(" - ");
    if (dash != std::string_view::npos)
      return std::string(range.substr(0, dash)).append(" to ").append(range.substr(dash + 3));
  }
  if (limits.starts_with('{') && limits.ends_with('}')) {
    std::string list;
    for (const char c : limits.substr(1, limits.size() - 2))
      list += c == ',' ? std::string(", ") : std::string(1, c);
    return "one of " + list;
  }
  return std::string(limits);
}

class WrappedHelp : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool positional) const override {
    std::string head = make_option_name(option, positional);
    // A flag that may have a value: "--prepare{auto}".
    if (const std::size_t implied = head.find('{'); implied != std::string::npos)
      head = head.substr(0, implied) + "[=" + option->get_type_name() + "]";
    std::vector<std::string> details;
    if (option->get_type_size() != 0) {
      const std::string type = option->get_type_name();
      const std::size_t colon = type.find(':');
      const std::string shown = type.substr(0, colon);
      // A positional is named like its type.
      if (!shown.empty() && shown != head) head += " " + shown;
      if (option->get_expected_max() == CLI::detail::expected_max_vector_size) head += " ...";
      if (option->get_required() && !positional) details.emplace_back("required");
      if (colon != std::string::npos) details.push_back(in_words(type.substr(colon + 1)));
      if (!option->get_default_str().empty())
        details.push_back("default: " + option->get_default_str());
    }
    if (!option->get_needs().empty()) details.push_back("needs " + names(option->get_needs()));
    if (!option->get_excludes().empty())
      details.push_back("not with " + names(option->get_excludes()));
    std::string text = make_option_desc(option);
    std::string last;
    for (const std::string& d : details) last += (last.empty() ? "" : "; ") + d;
    if (!last.empty()) text += (text.empty() ? "[" : " [") + last + "]";
    return wrapped(head, 2, width_) + wrapped(text, kIndent, width_);
  }
  std::string make_subcommand(const CLI::App* sub) const override {
    return wrapped(sub->get_name(), 2, width_) + wrapped(sub->get_description(), kIndent, width_);
  }
  /// Groups of options are indented.
  std::string make_expanded(const CLI::App* group) const override {
    WrappedHelp narrower = *this;
    narrower.width_ -= kGroupIndent;
    return narrower.Formatter::make_expanded(group);
  }
  std::string make_description(const CLI::App* app) const override {
    return wrapped(app->get_description(), 0, width_) + "\n";
  }
  std::string make_footer(const CLI::App* app) const override {
    const std::string footer = app->get_footer();
    return footer.empty() ? std::string() : "\n" + wrapped(footer, 0, width_);
  }

 private:
  static std::string names(const std::set<CLI::Option*>& options) {
    std::vector<std::string> sorted;  // the set is in the order of addresses
    sorted.reserve(options.size());
    for (const CLI::Option* option : options) sorted.push_back(option->get_name());
    std::sort(sorted.begin(), sorted.end());
    std::string list;
    for (const std::string& name : sorted) list += (list.empty() ? "" : ", ") + name;
    return list;
  }

  std::size_t width_ = terminal_width();
};

/// What is said of the first argument that is no option, where a command is to come; empty if there
/// is none.
std::string explain_command(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> known;
  for (const CLI::App* sub : app.get_subcommands(nullptr))
    if (!sub->get_name().empty()) known.push_back(sub->get_name());
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name.starts_with('-') && name != "-") return {};
    const std::string hint = kaboum::did_you_mean(name, known);
    return "unknown command '" + name + "'" + (hint.empty() ? "; commands: " + list : hint);
  }
  return "a command is to come first: " + list;
}

void set_formatter(CLI::App& app, const std::shared_ptr<WrappedHelp>& formatter) {
  app.formatter(formatter);
  for (CLI::App* sub : app.get_subcommands(nullptr)) set_formatter(*sub, formatter);
}

}  // namespace

void wrap_help(CLI::App& app) { set_formatter(app, std::make_shared<WrappedHelp>()); }

std::string explain_unknown(const CLI::App& app, int argc, char** argv) {
  std::vector<const CLI::App*> apps{&app};
  for (const CLI::App* sub : app.get_subcommands()) apps.push_back(sub);
  // Groups of options are commands without a name, of this one and of those that were given.
  for (std::size_t i = 0, count = apps.size(); i < count; ++i)
    for (const CLI::App* group :
         apps[i]->get_subcommands([](const CLI::App* sub) { return sub->get_name().empty(); }))
      apps.push_back(group);
  if (app.get_require_subcommand_min() > 0 && app.get_subcommands().empty())
    if (std::string why = explain_command(app, argc, argv); !why.empty()) return why;
  std::vector<std::string> known;
  for (const CLI::App* a : apps)
    for (const CLI::Option* option : a->get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--") return {};  // files follow
    if (!argument.starts_with("--")) continue;
    const std::string name(argument.substr(0, argument.find('=')));
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::optional<std::string> similar = kaboum::similar_name(name, known);
    return "unknown option " + name + (similar ? "; did you mean " + *similar + "?" : "");
  }
  return {};
}

}  // namespace kaboum::tools

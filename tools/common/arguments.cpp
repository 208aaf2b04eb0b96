// Numbers, lengths and names as options state them.

#include "arguments.h"

#include <kaboum/base/error.h>
#include <kaboum/base/length_unit.h>
#include <kaboum/base/option.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <sstream>
#include <string_view>

namespace kaboum::tools {
namespace {

/// As std::from_chars, after a plus sign that may come first.
std::from_chars_result parse_number(std::string_view text, double& value) {
  const char *begin = text.data(), *end = begin + text.size();
  if (text.starts_with('+') && !text.starts_with("+-")) ++begin;
  return std::from_chars(begin, end, value);
}

/// In small letters, with its dot.
std::string extension_of(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

}  // namespace

std::size_t parse_memory(const std::string& text, const char* option) {
  if (text.empty()) return 0;
  if (const auto bytes = kaboum::parse_memory(text)) return *bytes;
  throw Error(ErrorCode::InvalidArgument,
              std::string(option) + ": expected a size such as 500M or 2G");
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

bool is_page(const std::string& name) { return extension_of(name) == ".html"; }

bool is_scene(const std::string& name) { return extension_of(name) == ".glb"; }

CLI::Validator png_name() {
  return {[](const std::string& s) {
            return s == "-" || extension_of(s) == ".png"
                       ? std::string()
                       : "a PNG is written: give a name that ends with .png, not " + s;
          },
          ""};
}

CLI::Validator preview_name() {
  return {[](const std::string& s) {
            return s == "-" || extension_of(s) == ".png" || is_page(s)
                       ? std::string()
                       : "a picture or a page is written: give a name that ends with .png or "
                         ".html, not " +
                             s;
          },
          ""};
}

CLI::Validator preview_or_scene_name() {
  return {[](const std::string& s) {
            return s == "-" || extension_of(s) == ".png" || is_page(s) || is_scene(s)
                       ? std::string()
                       : "a picture, a page or a scene is written: give a name that ends with "
                         ".png, .html or .glb, not " +
                             s;
          },
          ""};
}

CLI::Validator page_name() {
  return {[](const std::string& s) {
            return is_page(s) ? std::string()
                              : "a page is written: give a name that ends with .html, not " + s;
          },
          ""};
}

CLI::Validator csv_name() {
  return {[](const std::string& s) {
            return extension_of(s) != ".json" ? std::string()
                                              : "CSV is written: give a name that ends with .csv, "
                                                "not " +
                                                    s;
          },
          ""};
}

CLI::Validator unit_name() {
  return CLI::IsMember(std::vector<std::string>(kLengthUnits.begin(), kLengthUnits.end()))
      .description("");
}

}  // namespace kaboum::tools

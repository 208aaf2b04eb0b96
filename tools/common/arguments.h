#pragma once

#include <kaboum/base/length.h>

#include <cstddef>
#include <optional>
#include <string>

namespace CLI {
class Validator;
}  // namespace CLI

/// Values of options: numbers, lengths, names.
namespace kaboum::tools {

using kaboum::Length;

/// Bytes of "500M", "2G" or "1000". Empty: 0.
/// @throws Error{InvalidArgument} naming the option
std::size_t parse_memory(const std::string& text, const char* option);

/// Refuses what is not a number from `low` to `high`, and says so.
CLI::Validator number_from(double low, double high);

/// Refuses names of pictures that are not .png: what is written is.
CLI::Validator png_name();
/// Refuses names of previews that are neither pictures (.png) nor pages (.html).
CLI::Validator preview_name();
/// The same, or scenes (.glb).
CLI::Validator preview_or_scene_name();
/// Refuses names of pages that are not .html.
CLI::Validator page_name();
/// Refuses names of JSON where CSV is written.
CLI::Validator csv_name();
/// Whether the name is that of a page.
bool is_page(const std::string& name);
/// Whether the name is that of a scene (.glb).
bool is_scene(const std::string& name);

/// Units of length that a container may name.
CLI::Validator unit_name();

}  // namespace kaboum::tools

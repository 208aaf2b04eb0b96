#pragma once

#include <kaboum/base/length.h>

#include <optional>
#include <string>

namespace CLI {
class Validator;
}  // namespace CLI

/// Values of options: numbers, lengths, names.
namespace kaboum::tools {

using kaboum::Length;

/// "0.005", "+0.005" or "0.5%"; nullopt unless it is a positive finite number.
std::optional<Length> parse_length(const std::string& text);

/// Refuses what is not a number from `low` to `high`, and says so.
CLI::Validator number_from(double low, double high);

/// Refuses names of pictures that are not .png: what is written is.
CLI::Validator png_name();

/// Units of length that a container may name.
CLI::Validator unit_name();

}  // namespace kaboum::tools

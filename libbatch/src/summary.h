#pragma once

#include <string>

#include "record.h"

/// What a batch comes to: one row for each file, in the order of their names.
namespace kaboum::batch {

std::string csv_of(const BatchResult& result);
/// A page by itself, but for pictures and results that it links to; columns are sorted by a click.
/// Of more files than a browser shows with ease, those that are not done come first.
std::string html_of(const BatchResult& result, const std::string& title);

}  // namespace kaboum::batch

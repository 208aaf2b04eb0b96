#pragma once

#include <string_view>
#include <unordered_set>

/// Entities of CAD files that carry no shape: colours, layers, dates, people, documents.
///
/// By lists of names, and a reading of the text, that the reader which makes triangles has no part
/// in. What is in no list may be a part of the shape.
namespace kaboum::verify {

/// The #numbers of a STEP file's entities that are harmless by all their types.
std::unordered_set<int> harmless_in_step(std::string_view text);

/// Whether entities of that number are harmless in IGES.
bool harmless_in_iges(int type);

}  // namespace kaboum::verify

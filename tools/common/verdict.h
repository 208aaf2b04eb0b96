#pragma once

#include <kaboum/base/number_text.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/verify/bracket.h>
#include <kaboum/verify/inclusion.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

/// What the relations of bound-verify share in telling what they found.
namespace kaboum::tools {

using kaboum::number_down;
using kaboum::number_up;

/// Six digits.
inline std::string number(double x) { return number_text(x); }

/// "at least X and at most Y", as far as they are known.
std::string in_words(const verify::Bracket& bracket);

/// End of a verdict where triangles stand for exact faces, of which no point was looked at.
inline constexpr const char* kOfTriangles =
    "; of the triangles, which stand for exact faces: of these nothing is said";

/// All digits.
std::string point(const geom::Vec3& p);

/// "with the margin 0.1 included", or "with their radii, 0.1 to 0.2, included"; empty where all are
/// 0.
std::string text_of_radii(const geom::ConvexSet& set);

/// The margin in reports: a number; the least and the largest radius where they differ or cores are
/// segments and points.
nlohmann::ordered_json margin_json(const geom::ConvexSet& set);

/// Triangles of sheets that were dropped on request, of each file.
using DroppedSheets = std::map<std::string, std::size_t>;

/// "; nothing is said of the 2 triangles of sheets dropped from FILE", which ends verdicts; empty
/// where none were dropped.
std::string except_sheets(const DroppedSheets& dropped);

int exit_code(verify::Answer answer);

}  // namespace kaboum::tools

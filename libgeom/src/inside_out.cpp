// What of a mesh as it is encloses nothing.

#include <kaboum/base/error.h>
#include <kaboum/geom/inside_out.h>
#include <kaboum/geom/prepare.h>

#include <iomanip>
#include <sstream>

namespace kaboum::geom {
namespace {

/// All digits.
std::string point(const Vec3& p) {
  std::ostringstream text;
  text << std::setprecision(17) << '(' << p.x() << ", " << p.y() << ", " << p.z() << ')';
  return text.str();
}

}  // namespace

std::optional<InsideOut> find_inside_out(const Mesh& mesh) {
  try {
    const Prepared prepared = prepare(mesh, {.drop_sheets = true});
    InsideOut out;
    if (prepared.report.inside_out.empty()) {
      if (!prepared.report.hollow) return {};
      out.hollow = prepared.report.hollow;
      return out;
    }
    out.parts = prepared.report.reversed_components;
    out.triangle = prepared.report.inside_out.front();
    for (const std::uint32_t v : mesh.triangles[out.triangle]) out.at += mesh.vertices[v] / 3;
    return out;
  } catch (const Error& error) {
    InsideOut out;
    out.refusal = error.what();
    return out;
  }
}

std::string text_of(const InsideOut& found) {
  if (!found.refusal.empty())
    return "whether parts of it are inside out is not known, for it cannot be prepared (" +
           found.refusal + "); such parts are not in the solid, and nothing is decided about them";
  if (found.hollow)
    return "what its surfaces enclose near " + point(*found.hollow) +
           " counts as outside, although it need not be a cavity: nothing is decided about it";
  return std::to_string(found.parts) + (found.parts == 1 ? " part of it is" : " parts of it are") +
         " inside out (the first at triangle " + std::to_string(found.triangle) + ", at " +
         point(found.at) +
         "): as the file is, what that encloses is not in the solid, and nothing is decided about "
         "it; preparing turns it, and then that solid is judged";
}

}  // namespace kaboum::geom

// Wavefront OBJ: vertices and faces. Statements that make other surfaces, and unknown ones, are
// refused; those that cannot make a surface are ignored. A backslash at the end of a line joins the
// next one to it, but in a statement that is ignored it takes no other statement into it: a name
// may end so.

#include <algorithm>
#include <array>
#include <limits>

#include "builder.h"
#include "bytes.h"
#include "formats.h"
#include "output.h"
#include "text.h"

namespace kaboum::io {
namespace {

/// Statements without surface: texture and normal coordinates, names, looks, and what only matters
/// to free-form surfaces, which are refused.
constexpr std::array<std::string_view, 31> kIgnored = {
    "vn",         "vt",   "vp",       "usemtl", "s",         "g",     "o",        "mtllib",
    "bevel",      "bmat", "c_interp", "con",    "cstype",    "ctech", "d_interp", "deg",
    "end",        "hole", "lod",      "maplib", "mg",        "parm",  "res",      "scrv",
    "shadow_obj", "sp",   "stech",    "step",   "trace_obj", "trim",  "usemap"};
constexpr std::array<std::string_view, 4> kSurfaces = {"bsp", "bzp", "cdp", "surf"};
constexpr std::array<std::string_view, 5> kLines = {"cdc", "curv", "curv2", "l", "p"};
constexpr std::array<std::string_view, 5> kOthers = {"call", "csh", "f", "fo", "v"};

class ObjReader {
 public:
  explicit ObjReader(const Source& source)
      : source_(source),
        scan_(source, {.comments = true, .continuation = true}),
        builder_(source) {}

  ReadResult read() {
    while (!scan_.done()) {
      const std::string_view record = scan_.token_on_line();
      if (record == "v") {
        read_vertex();
        scan_.skip_line();
      } else if (record == "f" || record == "fo") {
        read_face();
        scan_.skip_line();
      } else if (!record.empty()) {
        read_other(record);
        skip_other();
      } else {
        scan_.skip_line();
      }
    }
    if (highest_at_ != nullptr && highest_ >= builder_.point_count())
      builder_.corner(static_cast<std::int64_t>(highest_) + 1, 1, highest_at_);
    if (lines_ > 0)
      builder_.note(counted(lines_, "statement of points, lines or curves was",
                            "statements of points, lines or curves were") +
                    " ignored.");
    if (taken_apart_ > 0)
      builder_.note(counted(taken_apart_, "line that ends", "lines that end") +
                    " with a backslash in a statement that is ignored (first: " +
                    place(source_, first_taken_apart_) +
                    "): the next line is a statement, and was read as one.");
    return builder_.finish(Format::Obj, false);
  }

 private:
  void read_vertex() {
    const char* const where = scan_.last();
    geom::Vec3 p;
    for (double& x : p) {
      const std::string_view token = scan_.token_on_line();
      if (token.empty())
        fail(source_, where, "a vertex with fewer than three coordinates; the file is damaged");
      x = parse_coordinate(source_, token);
    }
    // A fourth number alone is a weight, by which some programs divide; more are colours.
    const std::string_view weight = scan_.token_on_line();
    std::size_t more = 0;
    for (auto token = weight; !token.empty(); token = scan_.token_on_line(), ++more)
      if (!to_double(token))
        fail(source_, token.data(),
             in_quotes(token) + " where a vertex goes on" +
                 (is_statement(token) ? ", after a backslash at the end of the line before" : "") +
                 "; the file is damaged");
    if (more == 1 && parse_coordinate(source_, weight) != 1)
      fail(source_, where,
           "a vertex with the weight " + in_quotes(weight) + "; export without weights");
    builder_.add_point(p, where);
  }

  template <std::size_t N>
  static bool is_in(const std::array<std::string_view, N>& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
  }

  static bool is_statement(std::string_view word) {
    return is_in(kIgnored, word) || is_in(kSurfaces, word) || is_in(kLines, word) ||
           is_in(kOthers, word);
  }

  /// Skips the rest of a statement that is ignored, further lines included.
  void skip_other() {
    const char* where = scan_.last();
    while (scan_.skip_to_next_line()) {
      const char* const next = scan_.position();
      const bool other = is_statement(scan_.token_on_line());
      scan_.seek(next);
      if (other) {
        if (++taken_apart_ == 1) first_taken_apart_ = where;
        return;
      }
      where = next;
    }
  }

  void read_other(std::string_view record) {
    if (is_in(kIgnored, record)) return;
    if (is_in(kLines, record)) {
      ++lines_;
    } else if (is_in(kSurfaces, record)) {
      fail(source_, record.data(),
           "a free-form surface (" + std::string(record) + "); export it as polygons");
    } else if (record == "call" || record == "csh") {
      fail(source_, record.data(),
           in_quotes(record) + " brings in other files or commands; put all into one file");
    } else {
      fail(source_, record.data(),
           "unknown statement " + in_quotes(record) +
               ", which may hold geometry; the file is damaged, or remove the line");
    }
  }

  void read_face() {
    const char* const where = scan_.last();
    corners_.clear();
    for (std::string_view token = scan_.token_on_line(); !token.empty();
         token = scan_.token_on_line())
      corners_.push_back(corner(token.substr(0, token.find('/'))));
    if (corners_.size() < 3)
      fail(source_, where, "a face with fewer than three corners; the file is damaged");
    builder_.add_face(corners_, where);
  }

  /// Negative indices count back from the latest vertex. Positive ones may refer to vertices that
  /// are yet to come; those are checked at the end.
  std::uint32_t corner(std::string_view token) {
    const std::int64_t index = parse_integer(source_, token, "a vertex index");
    const auto count = static_cast<std::int64_t>(builder_.point_count());
    if (index < 0 && index >= -count) return static_cast<std::uint32_t>(count + index);
    if (index <= 0 || index >= std::numeric_limits<std::uint32_t>::max())
      return builder_.corner(index, 1, token.data());
    const auto zero_based = static_cast<std::uint32_t>(index - 1);
    if (zero_based >= highest_) {
      highest_ = zero_based;
      highest_at_ = token.data();
    }
    return zero_based;
  }

  const Source& source_;
  Scanner scan_;
  MeshBuilder builder_;
  std::vector<std::uint32_t> corners_;
  std::uint32_t highest_ = 0;
  const char* highest_at_ = nullptr;
  std::size_t lines_ = 0;        ///< and points and curves
  std::size_t taken_apart_ = 0;  ///< lines that a backslash joins with a statement
  const char* first_taken_apart_ = nullptr;
};

}  // namespace

ReadResult read_obj(const Source& source) { return ObjReader(source).read(); }

std::vector<char> write_obj(const geom::Mesh& mesh, const WriteOptions& options) {
  Output out;
  out.reserve(mesh.vertices.size() * 48 + mesh.triangles.size() * 24);
  // A backslash at the line end would swallow the next line.
  if (!options.comment.empty()) out.text("# " + one_line(options.comment) + " \n");
  for (const geom::Vec3& p : mesh.vertices) {
    out.text("v");
    for (const double x : p) {
      out.text(" ");
      out.number(x);
    }
    out.text("\n");
  }
  for (const geom::Triangle& t : mesh.triangles) {
    out.text("f");
    for (const std::uint32_t corner : t) {
      out.text(" ");
      out.number(corner + 1);
    }
    out.text("\n");
  }
  return out.take();
}

}  // namespace kaboum::io

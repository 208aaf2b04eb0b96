// OFF, with the prefixes ST, C and N. One vertex or face per line: what follows the coordinates or
// the indices (normals, colours) is ignored. What follows the last face is an error.

#include "builder.h"
#include "bytes.h"
#include "formats.h"
#include "output.h"
#include "text.h"

namespace kaboum::io {
namespace {

class OffReader {
 public:
  explicit OffReader(const Source& source)
      : source_(source), scan_(source, {.comments = true}), builder_(source) {}

  ReadResult read() {
    const std::string_view keyword = scan_.token();
    if (keyword.empty()) fail(source_, "the file is empty; get it again");
    // Some files lack the keyword and begin with the counts.
    const bool has_keyword = keyword.find_first_not_of("+-0123456789") != std::string_view::npos;
    if (has_keyword) check_keyword(keyword);
    const std::size_t vertices =
        has_keyword ? count(scan_.need("the number of vertices"), 6) : count(keyword, 6);
    const std::size_t faces = count(scan_.need("the number of faces"), 2);
    scan_.skip_line();  // the number of edges, which may be missing
    read_vertices(vertices);
    read_faces(faces);
    if (const std::string_view more = scan_.token(); !more.empty())
      fail(source_, scan_.last(),
           in_quotes(more) + " after the " + std::to_string(vertices) + " vertices and " +
               std::to_string(faces) +
               " faces that the header states; correct the counts, or split the file into one per "
               "object");
    return builder_.finish(Format::Off, false);
  }

 private:
  void check_keyword(std::string_view keyword) {
    std::string_view prefix = keyword;
    if (prefix.ends_with("OFF")) {
      prefix.remove_suffix(3);
      if (prefix.starts_with("ST")) prefix.remove_prefix(2);
      if (prefix.starts_with("C")) prefix.remove_prefix(1);
      if (prefix.starts_with("N")) prefix.remove_prefix(1);
      if (prefix == "4" || prefix == "n" || prefix == "4n")
        fail(source_, scan_.last(),
             in_quotes(keyword) + " is not three-dimensional; convert the file to plain OFF");
    }
    if (!prefix.empty())
      fail(source_, scan_.last(),
           in_quotes(keyword) + " where 'OFF' is expected; the file is not an OFF file");
    const char* const after = scan_.position();
    if (std::string_view(after, scan_.bytes_left()).starts_with(" BINARY"))
      fail(source_, after, "binary OFF is not supported; convert the file to PLY or ASCII OFF");
  }

  /// A count of records that take at least `bytes_each`: more than fit into the file are refused
  /// before anything is reserved.
  std::size_t count(std::string_view token, std::size_t bytes_each) {
    const std::int64_t n = parse_integer(source_, token, "a count");
    if (n < 0 || static_cast<std::uint64_t>(n) > source_.bytes.size() / bytes_each + 1)
      fail(source_, token.data(),
           "the header states " + std::to_string(n) + " records, more than a file of " +
               std::to_string(source_.bytes.size()) + " bytes holds; it is truncated or damaged");
    return static_cast<std::size_t>(n);
  }

  void read_vertices(std::size_t count) {
    builder_.reserve_points(count);
    for (std::size_t i = 0; i < count; ++i) {
      geom::Vec3 p;
      for (double& x : p) x = scan_.coordinate();
      builder_.add_point(p, scan_.last());
      scan_.skip_line();
    }
  }

  void read_faces(std::size_t count) {
    builder_.reserve_triangles(count);
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t n = scan_.integer("a number of corners");
      const char* const where = scan_.last();
      if (n < 0 || static_cast<std::uint64_t>(n) > scan_.bytes_left())
        fail(source_, where,
             "a face with " + std::to_string(n) + " corners; the file is truncated or damaged");
      corners.clear();
      for (std::int64_t k = 0; k < n; ++k) {
        const std::int64_t index = scan_.integer("a vertex index");
        corners.push_back(builder_.corner(index, 0, scan_.last()));
      }
      builder_.add_face(corners, where);
      scan_.skip_line();
    }
  }

  const Source& source_;
  Scanner scan_;
  MeshBuilder builder_;
};

}  // namespace

ReadResult read_off(const Source& source) { return OffReader(source).read(); }

std::vector<char> write_off(const geom::Mesh& mesh, const WriteOptions& options) {
  Output out;
  out.reserve(mesh.vertices.size() * 48 + mesh.triangles.size() * 24);
  out.text("OFF\n");
  if (!options.comment.empty()) out.text("# " + one_line(options.comment) + "\n");
  out.number(mesh.vertices.size());
  out.text(" ");
  out.number(mesh.triangles.size());
  out.text(" 0\n");
  write_lines(out, mesh);
  return out.take();
}

}  // namespace kaboum::io

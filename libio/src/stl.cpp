// STL, ASCII and binary.

#include <Eigen/Geometry>

#include "builder.h"
#include "bytes.h"
#include "formats.h"
#include "output.h"
#include "text.h"

namespace kaboum::io {
namespace {

constexpr std::size_t kHeader = 80;
constexpr std::size_t kPreamble = kHeader + 4;
constexpr std::size_t kFacet = 50;

/// Bytes that a binary file with the stated number of facets has.
std::uint64_t stated_size(std::string_view bytes) {
  return kPreamble + kFacet * std::uint64_t{load_little<std::uint32_t>(bytes.data() + kHeader)};
}

/// Binary files may begin with "solid" as well: the size decides first, then what follows the name.
bool is_ascii(std::string_view bytes) {
  if (bytes.size() >= kPreamble && stated_size(bytes) == bytes.size()) return false;
  std::string_view text = without_byte_order_mark(bytes);
  while (!text.empty() && detail::char_class(text.front()) != detail::kOther) text.remove_prefix(1);
  if (!starts_with_word(text, "solid")) return false;
  return text.substr(0, 512).find('\0') == std::string_view::npos;
}

class AsciiReader {
 public:
  explicit AsciiReader(const Source& source)
      : source_(source), scan_(source, {}), builder_(source) {}

  ReadResult read() {
    bool in_solid = false;
    std::size_t solids = 0;
    for (std::string_view word = scan_.token(); !word.empty(); word = scan_.token()) {
      if (same_word(word, in_solid ? "endsolid" : "solid")) {
        scan_.skip_line();  // the name
        if (!in_solid) ++solids;
        in_solid = !in_solid;
      } else if (in_solid && same_word(word, "facet")) {
        read_facet();
      } else {
        fail(source_, scan_.last(),
             in_quotes(word) + " where " + (in_solid ? "'facet' or 'endsolid'" : "'solid'") +
                 " is expected; the file is damaged or not an ASCII STL file");
      }
    }
    if (in_solid)
      fail(source_, source_.end(),
           "the file ends before 'endsolid'; it is truncated, get it again");
    if (solids > 1)
      builder_.note("The file has " + std::to_string(solids) + " solids; all were read.");
    const std::size_t stored = stored_;
    builder_.adopt_welded_points(std::move(welder_.points()), stored);
    return builder_.finish(Format::Stl, false);
  }

 private:
  void expect(std::string_view word) {
    const std::string_view found = scan_.need(word);
    if (!same_word(found, word))
      fail(source_, scan_.last(),
           in_quotes(found) + " where '" + std::string(word) +
               "' is expected; the file is damaged or not an ASCII STL file");
  }

  void read_facet() {
    const char* const where = scan_.last();
    // The normal is not used; some programs write "nan" here.
    expect("normal");
    for (int i = 0; i < 3; ++i) scan_.need("a facet normal");
    expect("outer");
    expect("loop");
    corners_.clear();
    for (;;) {
      const std::string_view word = scan_.need("'vertex' or 'endloop'");
      if (same_word(word, "endloop")) break;
      if (!same_word(word, "vertex"))
        fail(source_, scan_.last(),
             in_quotes(word) + " where 'vertex' or 'endloop' is expected; the file is damaged");
      geom::Vec3 p;
      for (double& x : p) x = scan_.coordinate();
      corners_.push_back(welder_.number_of(p));
      ++stored_;
    }
    expect("endfacet");
    builder_.add_face(corners_, where);
  }

  const Source& source_;
  Scanner scan_;
  MeshBuilder builder_;
  Welder welder_;
  std::vector<std::uint32_t> corners_;
  std::size_t stored_ = 0;
};

ReadResult read_binary(const Source& source) {
  if (source.bytes.size() < kPreamble)
    fail(source, "the file has " + counted(source.bytes.size(), "byte", "bytes") +
                     ", fewer than the 84 of the smallest binary STL file, and does not begin with "
                     "'solid'; it is truncated or not an STL file");
  const std::uint64_t size = stated_size(source.bytes);
  const std::uint64_t facets = (size - kPreamble) / kFacet;
  if (size > source.bytes.size())
    fail(source, source.begin() + kHeader,
         "the header states " + counted(facets, "triangle", "triangles") + ", which need " +
             std::to_string(size) + " bytes, but the file has " +
             std::to_string(source.bytes.size()) + "; it is truncated or not an STL file");
  MeshBuilder builder(source);
  const std::string_view rest = source.bytes.substr(static_cast<std::size_t>(size));
  if (rest.size() >= kFacet &&
      rest.find_first_not_of(std::string_view("\0 \t\r\n", 5)) != rest.npos)
    fail(source, rest.data(),
         "the file goes on for " + std::to_string(rest.size()) + " bytes after the " +
             counted(facets, "triangle", "triangles") +
             " that its header states; correct the number, or split the file into one per solid");
  if (!rest.empty())
    builder.note(counted(rest.size(), "byte", "bytes") + " after the last triangle were ignored.");
  builder.reserve_triangles(facets);
  Welder welder;
  const char* at = source.begin() + kPreamble;
  for (std::uint64_t i = 0; i < facets; ++i, at += kFacet) {
    geom::Triangle t;
    for (int k = 0; k < 3; ++k) {
      const char* const from = at + 12 * (k + 1);
      const geom::Vec3 p(load_little<float>(from), load_little<float>(from + 4),
                         load_little<float>(from + 8));
      if (!p.allFinite())
        fail(source, from,
             "triangle " + std::to_string(i) +
                 " has a coordinate that is not finite; remove or repair this triangle");
      t[k] = welder.number_of(p);
    }
    builder.add_triangle(t);
  }
  builder.adopt_welded_points(std::move(welder.points()), 3 * facets);
  return builder.finish(Format::Stl, true);
}

}  // namespace

ReadResult read_stl(Source source) {
  source.text = is_ascii(source.bytes);
  return source.text ? AsciiReader(source).read() : read_binary(source);
}

std::vector<char> write_stl_binary(const geom::Mesh& mesh, const WriteOptions& options) {
  Output out;
  out.reserve(kPreamble + kFacet * mesh.triangles.size());
  // Must not begin with "solid": that is how ASCII files are known.
  std::string header = "KABouM binary STL";
  if (!options.comment.empty()) header += ": " + one_line(options.comment);
  header.resize(kHeader, ' ');
  out.text(header);
  out.little(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const geom::Triangle& t : mesh.triangles) {
    for (const float x : facet_normal(mesh, t)) out.little(x);
    for (const std::uint32_t corner : t)
      for (const double x : mesh.vertices[corner]) out.little(static_cast<float>(x));
    out.little(std::uint16_t{0});
  }
  return out.take();
}

std::vector<char> write_stl_ascii(const geom::Mesh& mesh, const WriteOptions& options) {
  Output out;
  out.reserve(mesh.triangles.size() * 256);
  const std::string name = options.comment.empty() ? "kaboum" : one_line(options.comment);
  out.text("solid " + name + "\n");
  for (const geom::Triangle& t : mesh.triangles) {
    out.text("facet normal");
    for (const float x : facet_normal(mesh, t)) {
      out.text(" ");
      out.number(x);
    }
    out.text("\n outer loop\n");
    for (const std::uint32_t corner : t) {
      out.text("  vertex");
      for (const double x : mesh.vertices[corner]) {
        out.text(" ");
        out.number(x);
      }
      out.text("\n");
    }
    out.text(" endloop\nendfacet\n");
  }
  out.text("endsolid " + name + "\n");
  return out.take();
}

}  // namespace kaboum::io

// Enclosing meshes of triangles and of files: prepared or wrapped, simplified, certified, kept.

#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/base/sha256.h>
#include <kaboum/certify/enclosure.h>
#include <kaboum/certify/large_epsilon.h>
#include <kaboum/certify/mesh_file.h>
#include <kaboum/verify/subject.h>

#include <algorithm>
#include <cmath>

#include "cache_words.h"
#include "enclosure_record.h"
#include "given_solid.h"
#include "issuer.h"
#include "known_file.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;

// An entry's content is the certificate in one line, and the mesh's bytes.
constexpr std::string_view kEnclosureEntry = "KABOUM-MESH 2";

constexpr const char* kSpareNote =
    "WARNING: float32 is too coarse for the mesh round it, which is written with the digits of "
    "doubles, in another format than the others; it encloses as long as its reader does not round "
    "to "
    "float32";

constexpr double kShareOfWrap = 0.6;  ///< of epsilon, for a wrap

void require_one_outer(const MeshRequest& request) {
  if (request.direction != bmesh::Direction::Outer)
    throw Error(ErrorCode::InvalidArgument, "an enclosing mesh is an outer one");
  if (request.vertices.size() > 1 || request.record_steps)
    throw Error(ErrorCode::InvalidArgument, "one enclosing mesh, without its steps, is made");
}

/// The solid that is enclosed. What a wrap takes of epsilon is not there for simplification.
GivenSolid solid_of(const geom::Mesh& mesh, const EnclosureRequest& request, MeshRequest& rest,
                    const MeshHooks& hooks, const std::string& because) {
  return give_solid(
      mesh, prepare_mesh, request.preparation, request.wrap,
      [&](const geom::Mesh& triangles) {
        std::optional<double> epsilon;
        if (rest.epsilon) epsilon = rest.epsilon->of(geom::bounding_box(mesh).diagonal());
        WrapRequest wrap = *request.wrap;
        if (epsilon) wrap.farthest = kShareOfWrap * (*epsilon - wrap.clearance);
        if (wrap.farthest && !(*wrap.farthest > 0)) refuse_deviation(wrap.clearance);
        wrap.float32 = rest.numbers != MeshRequest::Numbers::Double;
        wrap.may_be_double = rest.may_be_double();
        wrap.input_triangles = mesh.triangles.size();
        wrap.progress = hooks.progress;
        CertifiedWrap made = certify_wrap(triangles, wrap);
        const WrapCertificate& c = made.certificate();
        if (epsilon) rest.epsilon = Length{*epsilon - c.clearance - c.farthest_upper};
        return made;
      },
      because);
}

/// Whether every triangle is in the solid of a closed mesh.
TrianglesInside look_at(const geom::Mesh& triangles, const geom::Mesh& result) {
  verify::InclusionOptions options;
  options.surface_only = true;
  options.max_work = verify::usual_work(triangles.triangles.size() + result.triangles.size());
  const verify::Inclusion found = verify::verify_inclusion(triangles, result, options);
  TrianglesInside out{
      found.surface.answer, found.surface.reason, found.surface.inner_triangles.size(), {}};
  if (out.answer != verify::Answer::Refuted || found.left_out > 0 || found.limited) return out;
  verify::BracketEffort effort;
  effort.max_work = options.max_work.value();
  const double upper =
      verify::bracket_distance(triangles, found.surface.inner_triangles, result, true, effort)
          .upper;
  if (std::isfinite(upper)) out.farther = upper;
  return out;
}

std::string in_words(const TrianglesInside& inside) {
  if (inside.answer != verify::Answer::Refuted)
    return "whether every triangle would be inside is not decided";
  return std::to_string(inside.outside) + (inside.outside == 1 ? " triangle" : " triangles") +
         " would stick out" + (inside.farther ? ", by up to " + number_up(*inside.farther) : "");
}

/// What the result depends on.
/// @param mesh_hash  of the mesh and the file, whose quads count
std::string key_of_enclosure(const std::string& mesh_hash, const EnclosureRequest& request) {
  return kaboum::sha256(
      std::string(kEnclosureEntry) + '\n' + mesh_hash + '\n' + request.parameters() + '\n' +
      std::to_string(static_cast<int>(request.mesh.format)) + '\n' +
      (request.spare_format ? std::to_string(static_cast<int>(*request.spare_format)) + '\n'
                            : std::string()) +
      request.mesh.comment + '\n' + KABOUM_VERSION + '\n' + std::string(cache_words::kEnclosures) +
      '\n' + std::string(cache_words::kDecisions));
}

io::Format format_of(const EnclosureRequest& request, const EnclosureCertificate& made) {
  return made.in_spare_format && request.spare_format ? *request.spare_format : request.mesh.format;
}

std::optional<CertifiedEnclosure> find_enclosure(const CacheFolder& cache, const std::string& key,
                                                 const EnclosureRequest& request) {
  std::string flaw;
  const auto content = cache.find(kEnclosureEntry, key, flaw);
  if (!content) return std::nullopt;
  const std::size_t end = content->find('\n');
  if (end == std::string::npos) return std::nullopt;
  try {
    EnclosureCertificate certificate = read_enclosure(std::string_view(*content).substr(0, end));
    std::vector<char> bytes(content->begin() + static_cast<std::ptrdiff_t>(end) + 1,
                            content->end());
    geom::Mesh mesh =
        io::parse_mesh(bytes, format_of(request, certificate), "the cache's entry").mesh;
    if (mesh.vertices.size() != certificate.vertices ||
        mesh.triangles.size() != certificate.triangles)
      return std::nullopt;
    return Issuer::issue(std::move(mesh), std::move(certificate), std::move(bytes));
  } catch (const Error&) {
    return std::nullopt;
  }
}

void store_enclosure(const CacheFolder& cache, const std::string& key,
                     const CertifiedEnclosure& made) {
  std::string content = write_enclosure(made.certificate()) + "\n";
  content.append(made.bytes().begin(), made.bytes().end());
  cache.store(kEnclosureEntry, key, content);
}

/// @param because  a wrap is needed for this reason; empty: as far as is known it is not
std::optional<CertifiedEnclosure> certify(const geom::Mesh& mesh, const EnclosureRequest& request,
                                          const MeshHooks& hooks, const std::string& because) {
  EnclosureCertificate made;
  MeshRequest rest = request.mesh;
  rest.measure = true;
  const GivenSolid given = solid_of(mesh, request, rest, hooks, because);
  const geom::Prepared& solid = given.prepared;
  if (given.wrap) made.wrap = given.wrap->certificate();
  if (!solid.solid.closed())
    throw Error(ErrorCode::InvalidInput,
                "the mesh is open, so it has no solid that a mesh could enclose; have its holes "
                "filled");
  std::optional<CertifiedMesh> result = certify_mesh(solid, rest, hooks);
  if (!result && request.spare_format) {
    made.in_spare_format = true;
    rest.format = *request.spare_format;
    result = certify_mesh(solid, rest, hooks);
    made.notes.emplace_back(kSpareNote);
  }
  if (!result) return std::nullopt;
  const MeshCertificate& c = result->certificate();
  made.vertices_in = c.statistics.vertices_in;
  made.diagonal = geom::bounding_box(solid.solid.mesh()).diagonal();
  made.epsilon = c.epsilon;
  made.distance_upper = c.hausdorff_upper();
  if (made.wrap)
    made.distance_upper =
        (made.distance_upper + made.wrap->farthest_upper + made.wrap->clearance) * (1 + 0x1p-50);
  made.stop = c.stop;
  made.reached = c.reached();
  made.out_of_work = c.out_of_work;
  made.subject = c.subject;
  made.subject.wrapped = made.wrap.has_value();
  made.claims = certificate_of(*result).claims;
  if (!given.why.empty()) made.notes.push_back(why_wrapped(given.why));
  if (made.wrap) made.notes.push_back(in_words(*made.wrap));
  made.notes.insert(made.notes.end(), solid.report.notes.begin(), solid.report.notes.end());
  // As the bytes are read: who finds it in the cache gets the same.
  std::vector<char> bytes = result->bytes();
  geom::Mesh back = io::parse_mesh(bytes, rest.format, "the result").mesh;
  made.vertices = back.vertices.size();
  made.triangles = back.triangles.size();
  if (hooks.progress) hooks.progress("verifying");
  made.inside = look_at(given.wrap ? mesh : verify::held_triangles(mesh, solid), back);
  if (!given.wrap && made.inside.answer == verify::Answer::Verified)
    if (std::string why = undecided_solid(mesh, solid, request.preparation, back); !why.empty())
      made.inside = {verify::Answer::Undecided, std::move(why), 0, {}};
  return Issuer::issue(std::move(back), std::move(made), std::move(bytes));
}

}  // namespace

std::optional<CertifiedEnclosure> certify_enclosure(const geom::Mesh& mesh,
                                                    const EnclosureRequest& request,
                                                    const MeshHooks& hooks) {
  require_one_outer(request.mesh);
  std::optional<CertifiedEnclosure> made = certify(mesh, request, hooks, {});
  const bool may_wrap = request.wrap && request.wrap->where_needed;
  if (!made || !may_wrap || made->certificate().wrap ||
      made->certificate().inside.answer == verify::Answer::Verified)
    return made;
  try {
    if (auto wrapped = certify(mesh, request, hooks, in_words(made->certificate().inside)))
      return wrapped;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::InvalidInput && error.code() != ErrorCode::LimitReached) throw;
  }
  return made;
}

namespace {

EnclosedFile with_warning(EnclosedFile file, const std::optional<Length>& epsilon) {
  const EnclosureCertificate& c = file.enclosure.certificate();
  if (std::string text = warning_of(epsilon, c.wrap ? c.wrap->diagonal : c.diagonal); !text.empty())
    file.read_notes.push_back(std::move(text));
  return file;
}

}  // namespace

EnclosedFile enclose_file(const fs::path& file, std::optional<io::Format> format,
                          const EnclosureRequest& asked, const CacheFolder* cache,
                          const MeshHooks& hooks) {
  EnclosureRequest request = asked;
  if (cache != nullptr && file != "-") {  // CAD files are never known
    const auto known = find_known(*cache, file, format, 1);
    auto found =
        known ? find_enclosure(*cache, key_of_enclosure(known->mesh_hash + known->sha256, request),
                               request)
              : std::nullopt;
    if (found)
      return with_warning({known->sha256, known->notes, {}, std::move(*found), true},
                          asked.mesh.epsilon);
  }
  std::vector<char> bytes;
  io::ReadResult read = io::read_mesh(file, format, &bytes);
  const std::string mesh_hash = SetCache::hash_of(read.mesh), sha256 = kaboum::sha256(bytes);
  hold_exact_faces(read, request.hold_exact_faces, request.wrap);
  if (cache != nullptr && file != "-" && !io::is_cad(read.format))
    store_known(*cache, file, format, 1, bytes.size(), sha256, mesh_hash, read);
  request.preparation.quads = read.bent_quads;
  request.preparation.diagonal = geom::PrepareOptions::Diagonal::Outward;
  EnclosedFile out{sha256, std::move(read.notes), std::move(read.other_files), {}, false};
  const std::string key = key_of_enclosure(mesh_hash + sha256, request);
  if (cache != nullptr) {
    if (auto found = find_enclosure(*cache, key, request)) {
      out.enclosure = std::move(*found);
      out.cached = true;
      return with_warning(std::move(out), asked.mesh.epsilon);
    }
  }
  auto made = [&] {
    try {
      return certify_enclosure(read.mesh, request, hooks);
    } catch (const Error& error) {
      throw Error(error.code(), file.string() + ": " + error.what());
    }
  }();
  if (!made)
    throw TooCoarse(file.string(), read.mesh, request.mesh.epsilon, kMeshSpacing,
                    "choose a format that holds doubles, as obj; or ");
  if (cache != nullptr) store_enclosure(*cache, key, *made);
  out.enclosure = std::move(*made);
  return with_warning(std::move(out), asked.mesh.epsilon);
}

}  // namespace kaboum::certify

// Certified bounding meshes: what is returned is what its bytes hold, and holds by the verifier; no
// claim is made of candidates that do not enclose, whatever they come from; a call in process gives
// the bytes of the program.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/certify/mesh.h>
#include <kaboum/verify/loose_triangles.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <vector>

#include "mesh_certifier.h"
#include "support/families.h"
#include "support/shapes.h"
#include "support/temporary_folder.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;
using bmesh::Direction;
using Kind = Claim::Kind;
using verify::Answer;

geom::Mesh torus() { return test::torus(1, 0.3, 24, 12); }

MeshRequest fast(std::size_t vertices, Direction direction = Direction::Outer) {
  MeshRequest request;
  request.direction = direction;
  request.vertices = {vertices};
  request.effort = bmesh::Effort::Fast;
  return request;
}

/// A prism over a bow tie: the smaller one of its two halves is inside out.
geom::Mesh bow_tie() {
  geom::Mesh mesh;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : {std::pair{-1, 1}, {8, -4}, {8, 4}, {-1, -1}})
      mesh.vertices.emplace_back(x, y, z);
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    mesh.triangles.push_back({i, j, 4 + j});
    mesh.triangles.push_back({i, 4 + j, 4 + i});
  }
  return mesh;
}

bool holds(const geom::Mesh& outer, const geom::Mesh& inner) {
  return verify::verify_inclusion(inner, outer).solid.answer == Answer::Verified;
}

/// Corner by corner: formats differ in the order of vertices.
std::vector<geom::Vec3> corners(const geom::Mesh& mesh) {
  std::vector<geom::Vec3> all;
  for (const geom::Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) all.push_back(mesh.vertices[v]);
  return all;
}

std::set<Kind> kinds(const CertifiedMesh& made, Basis basis, Answer answer) {
  std::set<Kind> found;
  for (const Claim& claim : certificate_of(made).claims)
    if (claim.basis == basis && claim.answer == answer) found.insert(claim.kind);
  return found;
}

/// The message of the Internal error that `work` throws, else "".
template <class Work>
std::string internal_error(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Internal) return error.what();
  }
  return "";
}

TEST(CertifyMesh, IsWhatItsBytesHold) {
  for (const Direction direction : {Direction::Outer, Direction::Inner})
    for (const io::Format format : {io::Format::Stl, io::Format::Ply, io::Format::Obj}) {
      const geom::Prepared original = prepare_mesh(torus());
      MeshRequest request = fast(100, direction);
      request.format = format;
      const auto made = certify_mesh(original, request);
      ASSERT_TRUE(made);
      const geom::Mesh back = io::parse_mesh(made->bytes(), format, "the bytes").mesh;
      EXPECT_EQ(corners(back), corners(made->artefact()));
      const MeshCertificate& c = made->certificate();
      EXPECT_EQ(c.vertices, 100U);
      EXPECT_TRUE(c.reached());
      EXPECT_TRUE(direction == Direction::Outer ? holds(back, original.solid.mesh())
                                                : holds(original.solid.mesh(), back));
      EXPECT_EQ(
          kinds(*made, Basis::Bytes, Answer::Verified),
          (std::set{Kind::Solid, Kind::Surface, Kind::OriginalToResult, Kind::ResultToOriginal}));
      EXPECT_GT(c.original_to_result->max_lower, 0);
      EXPECT_LE(c.original_to_result->max_lower, c.original_to_result->max_upper);
      EXPECT_LT(c.hausdorff_upper(), 0.3);
    }
}

TEST(CertifyMesh, KeepsEpsilonAsAShareOfTheDiagonal) {
  MeshRequest request = fast(4);
  request.vertices.clear();
  request.epsilon = kaboum::Length{2, true};
  const geom::Prepared original = prepare_mesh(torus());
  const auto made = certify_mesh(original, request);
  ASSERT_TRUE(made);
  const double epsilon = 0.02 * geom::bounding_box(original.solid.mesh()).diagonal();
  EXPECT_EQ(made->certificate().epsilon, epsilon);
  EXPECT_LE(made->certificate().hausdorff_upper(), epsilon);
  EXPECT_EQ(made->certificate().stop, bmesh::Stop::ErrorBound);
  EXPECT_EQ(made->certificate().decided->distance_bound, epsilon);
}

TEST(CertifyMeshes, SeriesAreNested) {
  MeshRequest request = fast(150);
  request.vertices = {150, 100, 60};
  request.record_steps = true;
  const MeshSeries series = certify_meshes(prepare_mesh(torus()), request);
  ASSERT_EQ(series.meshes.size(), 3U);
  EXPECT_FALSE(series.steps.empty());
  EXPECT_LE(series.meshes.back().certificate().steps, series.steps.size());
  for (std::size_t i = 0; i < 3; ++i) {
    const MeshCertificate& c = series.meshes[i].certificate();
    EXPECT_EQ(c.requested, request.vertices[i]);
    EXPECT_EQ(c.finer, i);
    EXPECT_EQ(kinds(series.meshes[i], Basis::Bytes, Answer::Verified).contains(Kind::Nested),
              i > 0);
    if (i > 0) {
      EXPECT_TRUE(holds(series.meshes[i].artefact(), series.meshes[i - 1].artefact()));
    }
  }
}

TEST(CertifyMeshes, WhatIsNotReachedStandsForAllAfterIt) {
  // Two tetrahedra have eight vertices and cannot have fewer.
  const geom::Mesh one = test::convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  MeshRequest request = fast(7);
  request.vertices = {7, 6, 5};
  const MeshSeries series =
      certify_meshes(prepare_mesh(test::merged({one, test::translated(one, {5, 0, 0})})), request);
  ASSERT_EQ(series.meshes.size(), 3U);
  for (const CertifiedMesh& made : series.meshes) {
    EXPECT_FALSE(made.certificate().reached());
    EXPECT_EQ(made.certificate().stop, bmesh::Stop::Exhausted);
    EXPECT_EQ(made.bytes(), series.meshes.front().bytes());
  }
  EXPECT_EQ(series.meshes.back().certificate().requested, 5U);
}

TEST(CertifyMesh, GivesTheBytesOfTheProgram) {
  const test::TemporaryFolder temporary;
  const fs::path folder = temporary.path(), in = folder / "in.off", out = folder / "out.ply";
  io::write_file(in, io::serialise_mesh(torus(), io::Format::Off));
  for (const bool inner : {false, true}) {
    const std::string command = std::string(KABOUM_BMESH_DECIMATE) + " " + in.string() + " -o " +
                                out.string() + " --vertices 90 --epsilon 20% --quiet" +
                                (inner ? " --direction inner" : "");
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    MeshRequest request;
    request.direction = inner ? Direction::Inner : Direction::Outer;
    request.vertices = {90};
    request.epsilon = kaboum::Length{20, true};
    request.comment = "bmesh-decimate " KABOUM_VERSION;
    for (const bool decide : {false, true}) {
      request.decide = request.measure = decide;
      const auto made = certify_mesh(prepare_mesh(io::read_mesh(in).mesh), request);
      ASSERT_TRUE(made);
      EXPECT_EQ(made->bytes(), io::read_file(out)) << inner << decide;
    }
  }
}

/// Candidates from anywhere, as if decimation had made them.
std::vector<CertifiedMesh> certify_as_made(const geom::Prepared& original,
                                           const MeshRequest& request,
                                           const std::vector<geom::Mesh>& meshes) {
  const MeshPlan plan = plan_mesh(original, request);
  std::vector<bmesh::DecimateResult> candidates;
  for (const geom::Mesh& mesh : meshes) {
    bmesh::DecimateResult& candidate = candidates.emplace_back();
    candidate.mesh = test::to_float(mesh);
    candidate.stop = bmesh::Stop::VertexTarget;
  }
  const MeshHooks none;
  return MeshCertifier(original, request, plan, none).certify(std::move(candidates));
}

TEST(MeshCertifier, MakesNoClaimOfWhatDoesNotEnclose) {
  const geom::Prepared original = prepare_mesh(torus());
  const auto tube = [](double by) {  // thicker or thinner, at the same angles
    return test::torus(1, 0.3 * by, 24, 12);
  };
  for (const Direction direction : {Direction::Outer, Direction::Inner}) {
    const bool outer = direction == Direction::Outer;
    const MeshRequest request = fast(100, direction);
    const auto certify = [&](const geom::Mesh& mesh) {
      return certify_as_made(original, request, {mesh});
    };
    const geom::Mesh right = tube(outer ? 1.05 : 0.95);
    const auto made = certify(right);
    ASSERT_EQ(made.size(), 1U);
    EXPECT_EQ(kinds(made[0], Basis::Bytes, Answer::Verified).count(Kind::Solid), 1U);
    const std::string refused = "refutes that the result is bounding";
    geom::Mesh dented = right;  // at one vertex, outermost
    dented.vertices[96] *= outer ? 0.9 : 1.1;
    for (const geom::Mesh& wrong :
         {tube(outer ? 0.95 : 1.05), dented, test::translated(right, {0.1, 0, 0})})
      EXPECT_NE(internal_error([&] { certify(wrong); }).find(refused), std::string::npos);
  }
}

TEST(MeshCertifier, MakesNoClaimOfSeriesThatAreNotNested) {
  MeshRequest request = fast(100);
  request.vertices = {100, 50};
  const geom::Prepared original = prepare_mesh(torus());
  const geom::Mesh near = test::torus(1, 0.32, 24, 12), far = test::torus(1, 0.34, 24, 12);
  EXPECT_EQ(certify_as_made(original, request, {near, far})[1].certificate().decided->nested,
            Answer::Verified);
  EXPECT_NE(internal_error([&] { certify_as_made(original, request, {far, near}); }), "");
}

TEST(MeshCertifier, MakesNoClaimOfWhatIsBeyondEpsilon) {
  MeshRequest request = fast(100);
  request.epsilon = kaboum::Length{0.02};
  const geom::Prepared original = prepare_mesh(torus());
  EXPECT_EQ(certify_as_made(original, request, {test::torus(1, 0.31, 24, 12)}).size(), 1U);
  EXPECT_NE(internal_error([&] {
              certify_as_made(original, request, {test::torus(1, 0.33, 24, 12)});
            }).find("exceeds the carried bound"),
            std::string::npos);
}

TEST(CertifyMesh, CertificatesSayWhatTheyAreAbout) {
  geom::Mesh sheet;
  sheet.vertices = {{3, 0, 0}, {4, 0, 0}, {4, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
  const auto about = [](const geom::Mesh& mesh) {
    const auto made = certify_mesh(
        prepare_mesh(mesh, {.drop_sheets = true, .holes = geom::Holes::Fill}), fast(100));
    return made ? in_words(made->certificate().subject) : "";
  };
  EXPECT_EQ(about(torus()), "the input");
  EXPECT_EQ(about(test::merged({torus(), sheet})),
            "the input: without 2 triangles of sheets, of which nothing is claimed");
}

TEST(CertifyMesh, WhatFloat32CannotHoldIsDoubleOrNotMade) {
  const geom::Prepared far = prepare_mesh(test::translated(torus(), {1e9, 0, 0}));
  MeshRequest request = fast(100);
  const MeshSeries made = certify_meshes(far, request);
  ASSERT_EQ(made.meshes.size(), 1U);
  EXPECT_TRUE(made.meshes[0].certificate().double_precision);
  ASSERT_TRUE(made.shortage);
  EXPECT_EQ(made.shortage->spacing, 64);  // of float32 numbers about 1e9
  EXPECT_LT(made.shortage->limit, 1e-5);
  request.format = io::Format::Stl;
  EXPECT_FALSE(certify_mesh(far, request));
  request.format = io::Format::Ply;
  request.numbers = MeshRequest::Numbers::Float;
  EXPECT_FALSE(certify_mesh(far, request));
}

TEST(CertifyMesh, VerticesWithoutAPlaceAreCounted) {
  // The border of an open mesh stays where it is: at thirds, which float32 has not.
  const geom::Prepared open = geom::prepare(
      test::scaled(test::grid(8, [](double x, double y) { return x * y; }), {1. / 3, 1, 1}));
  MeshRequest request = fast(60);
  const MeshSeries made = certify_meshes(open, request);
  ASSERT_TRUE(made.shortage);
  EXPECT_GT(made.shortage->vertices, 0U);
  ASSERT_EQ(made.meshes.size(), 1U);
  EXPECT_TRUE(made.meshes[0].certificate().double_precision);
  request.format = io::Format::Stl;
  EXPECT_TRUE(certify_meshes(open, request).meshes.empty());
}

TEST(CertifyMesh, OpenMeshesEncloseNothing) {
  const geom::Prepared open =
      geom::prepare(test::without(torus(), [](const geom::Vec3& p) { return p.x() > 1.2; }));
  ASSERT_FALSE(open.solid.closed());
  const auto made = certify_mesh(open, fast(150));
  ASSERT_TRUE(made);
  EXPECT_FALSE(made->certificate().closed);
  EXPECT_FALSE(made->certificate().surface);
  EXPECT_EQ(kinds(*made, Basis::Bytes, Answer::Verified),
            (std::set{Kind::Winding, Kind::OriginalToResult, Kind::ResultToOriginal}));
}

TEST(CertifyMesh, WithoutDecidingClaimsSayWhatTheyRestOn) {
  MeshRequest request = fast(100);
  request.decide = false;
  const auto outer = certify_mesh(prepare_mesh(torus()), request);
  ASSERT_TRUE(outer);
  EXPECT_EQ(kinds(*outer, Basis::Steps, Answer::Verified), (std::set{Kind::Solid}));
  EXPECT_EQ(kinds(*outer, Basis::Meshes, Answer::Verified), (std::set{Kind::Surface}));
  EXPECT_EQ(outer->certificate().surface->looked_at, 0U);  // all bound the solid
  EXPECT_EQ(kinds(*outer, Basis::Measured, Answer::Verified),
            (std::set{Kind::OriginalToResult, Kind::ResultToOriginal}));
  request.measure = false;
  EXPECT_FALSE(certify_mesh(prepare_mesh(torus()), request)->certificate().original_to_result);
  request.direction = Direction::Any;
  EXPECT_TRUE(certificate_of(*certify_mesh(prepare_mesh(torus()), request)).claims.empty());
}

TEST(CertifyMesh, TrianglesThatBoundNoSolidAreFoundToStickOut) {
  const geom::Prepared original = prepare_mesh(bow_tie());
  ASSERT_EQ(original.report.reversed_triangles, 0U);
  for (const bool decide : {false, true}) {
    MeshRequest request = fast(8);
    request.decide = decide;
    const auto made = certify_mesh(original, request);
    ASSERT_TRUE(made);
    EXPECT_EQ(kinds(*made, decide ? Basis::Bytes : Basis::Meshes, Answer::Refuted),
              (std::set{Kind::Surface}));
    EXPECT_GT(made->certificate().surface->sticks_out.lower, 0.1);
    EXPECT_LT(made->certificate().surface->sticks_out.triangle,
              original.solid.mesh().triangles.size());
    EXPECT_EQ(made->certificate().surface_answer(), Answer::Refuted);
  }
}

TEST(CertifyMesh, SurfacesBehindEachOtherHideNoFold) {
  // Four hundred boxes within each other, and a fold among their triangles.
  geom::Mesh mesh;
  for (int i = 1; i <= 400; ++i)
    mesh = test::merged({mesh, test::translated(test::box({2. * i, 2. * i, 2. * i}, 1),
                                                {-1. * i, -1. * i, -1. * i})});
  const geom::Mesh fold = test::translated(bow_tie(), {500, 0, 0});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), fold.vertices.begin(), fold.vertices.end());
  std::size_t at = 15;
  for (const auto& [a, b, c] : fold.triangles) {
    mesh.triangles.insert(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(at),
                          {a + first, b + first, c + first});
    at += 16;
  }
  MeshRequest request = fast(mesh.vertices.size());
  request.decide = request.measure = false;
  const auto made = certify_mesh(prepare_mesh(mesh), request);
  ASSERT_TRUE(made);
  EXPECT_LE(made->certificate().surface->looked_at, fold.triangles.size());
  EXPECT_EQ(kinds(*made, Basis::Meshes, Answer::Refuted), (std::set{Kind::Surface}));
}

TEST(CertifyMesh, RefusesWhatEnclosesNothing) {
  const geom::Mesh flat = test::grid(4, [](double, double) { return 0.0; });
  EXPECT_THROW(prepare_mesh(flat), Error);
  const geom::Prepared filled = geom::prepare(flat, {.holes = geom::Holes::Fill});
  EXPECT_THROW(certify_mesh(filled, fast(8)), Error);
}

TEST(CertifyMesh, RefusesRequestsThatContradictThemselves) {
  const geom::Prepared original = prepare_mesh(torus());
  const auto refuses = [&](const std::function<void(MeshRequest&)>& change) {
    MeshRequest request = fast(100);
    change(request);
    try {
      certify_mesh(original, request);
    } catch (const Error& error) {
      return error.code() == ErrorCode::InvalidArgument;
    }
    return false;
  };
  EXPECT_FALSE(refuses([](MeshRequest&) {}));
  EXPECT_TRUE(refuses([](MeshRequest& r) { r.vertices.clear(); }));
  EXPECT_TRUE(refuses([](MeshRequest& r) { r.vertices = {100, 50}; }));  // one result
  EXPECT_TRUE(refuses([](MeshRequest& r) { r.ratio = 1.5; }));
  EXPECT_TRUE(refuses([](MeshRequest& r) { r.direction = Direction::Any; }));
  EXPECT_TRUE(refuses([](MeshRequest& r) {
    r.numbers = MeshRequest::Numbers::Double;
    r.format = io::Format::Stl;
  }));
}

/// A sphere of which one vertex is far beyond the other side: the tip that comes out is inside out.
geom::Mesh pierced_sphere() {
  geom::Mesh mesh = test::icosphere(2);
  mesh.vertices[40] *= -8;
  return mesh;
}

// Where no triangle is loose no place inside out is looked for; what is said is the same.
TEST(PrepareMesh, SaysWhatLookingBesideTrianglesSays) {
  std::vector<test::Family> families = test::closed_families();
  families.push_back({"a pierced sphere", pierced_sphere(), true, true, false});
  int spared = 0, looked = 0, hollow = 0;
  for (const test::Family& family : families) {
    if (!family.solid) continue;
    SCOPED_TRACE(family.name);
    const geom::PrepareOptions options{.drop_sheets = true};
    const geom::Prepared exact = prepare_mesh(family.mesh, options),
                         beside = geom::prepare(family.mesh, options);
    EXPECT_EQ(exact.report.notes, beside.report.notes);
    EXPECT_EQ(exact.report.hollow, beside.report.hollow);
    EXPECT_EQ(exact.solid.mesh().triangles, beside.solid.mesh().triangles);
    EXPECT_FALSE(beside.report.loose);
    if (!exact.report.loose) continue;  // of several parts
    (exact.report.loose->empty() ? spared : looked) += 1;
    hollow += exact.report.hollow ? 1 : 0;
    EXPECT_EQ(*exact.report.loose, verify::find_loose_triangles(exact.solid.mesh()));
  }
  EXPECT_GT(spared, 5);
  EXPECT_GT(looked, 0);
  EXPECT_GT(hollow, 0);
}

TEST(CertifyMesh, ProgressMayCancel) {
  struct Cancelled {};
  MeshHooks hooks;
  hooks.progress = [](const std::string&) { throw Cancelled(); };
  EXPECT_THROW(certify_mesh(prepare_mesh(torus()), fast(100), hooks), Cancelled);
}

}  // namespace
}  // namespace kaboum::certify

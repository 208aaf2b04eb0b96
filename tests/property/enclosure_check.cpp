// Decimates meshes outwards and inwards and attacks the claim: the log is replayed by the separate
// checker, and sample points, half of them very close to a surface, must not change sides.
//
//   enclosure_check [--families] [--corpus] [--own DIR] [--samples N] [--ratios 0.2,0.1,0.05]
//                   [--largest VERTICES] [--largest-measured VERTICES] [--all-costs] [FILE...]
// --largest leaves out larger meshes of --corpus and FILE, --largest-measured larger ones with the
// cost distance, whose steps are replayed slowly.
//
// Exit status 0 if no violation was found, 1 otherwise.
#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/winding.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/replay.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cstdlib>
#include <iostream>
#include <random>
#include <sstream>

#include "support/corpus.h"
#include "support/families.h"
#include "support/mesh_files.h"

namespace {

using namespace kaboum;  // NOLINT: a test program
using bmesh::Direction;
using geom::Mesh;
using geom::Vec3;
using test::mesh_files;

struct Settings {
  std::size_t samples = 100000;
  std::size_t largest = ~std::size_t{0};
  std::size_t largest_measured = ~std::size_t{0};  ///< with Cost::Distance
  std::vector<double> ratios{0.2, 0.1, 0.05};
  std::vector<bmesh::Cost> costs{bmesh::Cost::Planes, bmesh::Cost::Distance};
};

/// Half of the points within 1e-6 of the diagonal of either surface, half anywhere around.
std::vector<Vec3> sample_points(const Mesh& a, const Mesh& b, std::size_t n) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  geom::Box3 box = geom::bounding_box(a);
  const double diagonal = box.diagonal();
  std::vector<Vec3> points;
  points.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 r(unit(random), unit(random), unit(random));
    const Mesh& mesh = i % 4 == 0 ? a : b;
    if (i % 2 == 1 || mesh.triangles.empty()) {
      points.emplace_back(box.min - 0.05 * (box.max - box.min) +
                          1.1 * r.cwiseProduct(box.max - box.min));
      continue;
    }
    const auto& t = mesh.triangles[random() % mesh.triangles.size()];
    double u = r.x(), v = r.y();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    if (i % 8 == 0) u = v = 0;  // at vertices
    const Vec3 &p = mesh.vertices[t[0]], &q = mesh.vertices[t[1]], &s = mesh.vertices[t[2]];
    const Vec3 jitter = Vec3(unit(random), unit(random), unit(random)) - Vec3::Constant(0.5);
    points.push_back(p + u * (q - p) + v * (s - p) +
                     std::pow(10.0, -6 - 4 * r.z()) * diagonal * jitter);
  }
  return points;
}

/// Points of `inside`'s solid that are not in `outside`'s.
std::size_t violations(const Mesh& inside, const Mesh& outside, const std::vector<Vec3>& points,
                       std::size_t* solid_points) {
  const geom::WindingNumber a(inside), b(outside);
  std::atomic<std::size_t> bad{0}, solid{0};
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 512), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const auto wa = a(points[i]);
      if (!wa || *wa < 1) continue;
      ++solid;
      const auto wb = b(points[i]);
      if (wb && *wb < 1) ++bad;
    }
  });
  *solid_points = solid;
  return bad;
}

class Check {
 public:
  explicit Check(Settings settings) : s_(std::move(settings)) {}

  /// Meshes with more than `largest` vertices are left out.
  void mesh(const std::string& name, const Mesh& input, std::size_t largest = ~std::size_t{0}) {
    geom::Prepared p;
    try {
      p = geom::prepare(input);
    } catch (const Error& e) {
      std::cout << name << ": refused: " << e.what() << '\n';
      ++refused_;
      return;
    }
    if (!p.solid.closed() || p.solid.mesh().vertices.size() > largest) return;
    ++meshes_;
    for (const bmesh::Cost cost : s_.costs) {
      // Steps against the original are replayed slowly.
      if (cost == bmesh::Cost::Distance && p.solid.mesh().vertices.size() > s_.largest_measured)
        continue;
      for (const Direction d : {Direction::Outer, Direction::Inner})
        for (const double ratio : s_.ratios) run(name, input, p, d, ratio, cost);
    }
  }

  void file(const std::string& path, std::size_t largest) {
    try {
      mesh(path, io::read_mesh(path).mesh, largest);
    } catch (const Error& e) {
      std::cout << path << ": not read: " << e.what() << '\n';
    }
  }

  int conclude() const {
    std::cout << meshes_ << " meshes, " << runs_ << " runs, " << contractions_
              << " contractions replayed with " << predicates_ << " exact tests, " << points_
              << " points sampled, " << solid_points_ << " of them in the inner solid; " << refused_
              << " meshes refused; " << failures_ << " failures\n";
    return failures_ == 0 && runs_ > 0 ? 0 : 1;
  }

 private:
  void run(const std::string& name, const Mesh& input, const geom::Prepared& p, Direction d,
           double ratio, bmesh::Cost cost) {
    bmesh::Log log;
    log.direction = d;
    bmesh::record_preparation(p.report, input.triangles.size(), log);
    bmesh::DecimateOptions o;
    o.direction = d;
    o.cost = cost;
    if (cost == bmesh::Cost::Distance) o.effort = bmesh::Effort::Normal;
    o.vertices = std::max<std::size_t>(
        4, static_cast<std::size_t>(ratio * static_cast<double>(p.solid.mesh().vertices.size())));
    o.record_steps = true;
    const auto r = bmesh::decimate(p.solid, o);
    log.steps = r.steps;
    const auto checked = verify::replay(input, log, r.mesh);
    const auto points = sample_points(p.solid.mesh(), r.mesh, s_.samples);
    std::size_t solid = 0;
    std::size_t bad = d == Direction::Outer ? violations(p.solid.mesh(), r.mesh, points, &solid)
                                            : violations(r.mesh, p.solid.mesh(), points, &solid);
    // Preparation may not have taken anything from the input's own solid, where it has one; nor
    // added to it, unless it turned something.
    if (const Mesh raw = geom::weld(input); geom::analyse(raw).closed()) {
      std::size_t ignored = 0;
      if (d == Direction::Outer) bad += violations(raw, r.mesh, points, &ignored);
      if (d == Direction::Inner && p.report.reversed_triangles == 0)
        bad += violations(r.mesh, raw, points, &ignored);
    }
    ++runs_;
    contractions_ += checked.steps;
    predicates_ += checked.predicates;
    points_ += points.size();
    solid_points_ += solid;
    if (checked.verified && bad == 0) return;
    ++failures_;
    std::cout << name << (d == Direction::Outer ? " outer " : " inner ") << ratio << ": "
              << (checked.verified ? "replay verified" : checked.violation) << ", " << bad
              << " points outside\n";
  }

  Settings s_;
  std::size_t meshes_ = 0, runs_ = 0, refused_ = 0, failures_ = 0, points_ = 0, solid_points_ = 0,
              contractions_ = 0;
  std::uint64_t predicates_ = 0;
};

}  // namespace

int main(int argc, char** argv) try {
  Settings settings;
  bool families = false;
  std::vector<std::string> files, own;
  const std::vector<std::string> args(argv + 1, argv + argc);
  for (std::size_t i = 0; i < args.size(); ++i) {
    const auto value = [&] { return args.at(++i); };
    if (args[i] == "--families") {
      families = true;
    } else if (args[i] == "--all-costs") {
      settings.costs = {bmesh::Cost::Distance, bmesh::Cost::Planes, bmesh::Cost::PlanesAdapted,
                        bmesh::Cost::PlanesDiagonal, bmesh::Cost::Triangles};
    } else if (args[i] == "--corpus") {
      for (std::string& f : mesh_files(test::corpus())) files.push_back(std::move(f));
    } else if (args[i] == "--own") {
      for (std::string& f : mesh_files(value())) own.push_back(std::move(f));
    } else if (args[i] == "--samples") {
      settings.samples = std::stoul(value());
    } else if (args[i] == "--largest") {
      settings.largest = std::stoul(value());
    } else if (args[i] == "--largest-measured") {
      settings.largest_measured = std::stoul(value());
    } else if (args[i] == "--ratios") {
      settings.ratios.clear();
      std::istringstream list(value());
      for (std::string r; std::getline(list, r, ',');) settings.ratios.push_back(std::stod(r));
    } else {
      files.push_back(args[i]);
    }
  }
  Check check(settings);
  if (families)
    for (const auto& list : {test::closed_families(), test::bad_families()})
      for (const auto& f : list) check.mesh(f.name, f.mesh);
  for (const std::string& f : own) check.file(f, ~std::size_t{0});
  for (const std::string& f : files) check.file(f, settings.largest);
  return check.conclude();
} catch (const std::exception& e) {
  std::cerr << "enclosure_check: " << e.what() << '\n';
  return 2;
}

// Attacks claims of enclosure for longer than the everyday tests do.
//
//   verify_attack [--pairs N] [--first SEED] [--bent] [--open] [--families]
//                 [--corpus] [--own DIR] [--largest TRIANGLES] [--ratios 0.5,0.2,0.05]
//                 [--oracle TRIANGLES] [--mutants N] [FILE...]
//
// --pairs: N random lattice pairs (--bent, --open: of those kinds), both ways round and permuted,
// against the exact oracle. Pairs that disagree are kept in the folder $KABOUM_KEEP.
// --families, --corpus and files: closed meshes decimated outwards and inwards; a line per result
// with the verdict of both claims; with --oracle also the oracle's, for pairs of no more triangles.
// --mutants: each of these pairs spoilt in one place, N mutants a pair and kind, against the oracle
// (pairs of no more triangles than --oracle; results in double precision).
//
// Exit status 0 if nothing disagrees and all solid claims of bounding meshes are verified.
#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/inclusion.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "judge.h"
#include "pairs.h"
#include "support/arrangement_oracle.h"
#include "support/corpus.h"
#include "support/families.h"
#include "support/mesh_files.h"

namespace {

using namespace kaboum;        // NOLINT: a test program
using namespace kaboum::test;  // NOLINT: a test program
using bmesh::Direction;
using geom::Mesh;
using verify::Answer;

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Settings {
  std::size_t largest = ~std::size_t{0}, oracle = 0;
  int mutants = 0;
  std::vector<double> ratios{0.5, 0.2, 0.05};
};

class Attack {
 public:
  explicit Attack(Settings settings) : s_(std::move(settings)) {}

  void pairs(const char* kind, MeshPair (*make)(std::uint64_t), std::uint64_t first,
             std::size_t count) {
    Tally tally;
    const double start = seconds();
    for (std::uint64_t seed = first; seed < first + count; ++seed) tally.judge(make(seed), seed);
    std::cout << kind << " pairs: " << tally.pairs() << ", each twice; solid claim true "
              << tally.solid_true() << ", false " << tally.solid_false() << "; surface claim true "
              << tally.surface_true() << ", false " << tally.surface_false()
              << "; open with one border: true " << tally.difference_true() << ", false "
              << tally.difference_false() << "; witnesses exact " << tally.exact_witnesses()
              << ", beside " << tally.inexact_witnesses() << "; "
              << static_cast<int>(seconds() - start) << " s\n"
              << tally.faults() << std::flush;
    if (!tally.faults().empty()) ++failures_;
  }

  void file(const std::string& path) {
    try {
      mesh(path.substr(path.find_last_of('/') + 1), io::read_mesh(path).mesh);
    } catch (const Error& e) {
      std::cout << path << ": not read: " << e.what() << '\n';
    }
  }

  void mesh(const std::string& title, const Mesh& input) {
    geom::Prepared p;
    try {
      p = geom::prepare(input);
    } catch (const Error& e) {
      std::cout << title << ": refused: " << e.what() << '\n';
      return;
    }
    if (p.solid.mesh().triangles.size() > s_.largest) return;
    for (const Direction d : {Direction::Outer, Direction::Inner}) {
      for (const double ratio : s_.ratios) bounding(title, p, d, ratio);
    }
  }

  int conclude() const {
    for (const auto& [what, count] : {std::pair{"solid", solid_}, {"surface", surface_}}) {
      std::cout << what << " claims of bounding meshes: " << count[0] << " verified, " << count[1]
                << " refuted, " << count[2] << " undecided, " << count[3] << " undefined\n";
    }
    if (s_.mutants != 0) {
      std::cout << mutants_.pairs() << " mutants: solid claim true " << mutants_.solid_true()
                << ", false " << mutants_.solid_false() << "; disagreements with the oracle:\n"
                << mutants_.faults();
    }
    std::cout << failures_ << " failures\n";
    return failures_ == 0 && mutants_.faults().empty() ? 0 : 1;
  }

 private:
  using Counts = std::array<int, 4>;

  void bounding(const std::string& title, const geom::Prepared& p, Direction d, double ratio) {
    bmesh::DecimateOptions o;
    o.direction = d;
    if (s_.mutants != 0) o.precision = bmesh::Precision::Double;
    o.vertices = std::max<std::size_t>(
        4, static_cast<std::size_t>(ratio * static_cast<double>(p.solid.mesh().vertices.size())));
    const Mesh result = bmesh::decimate(p.solid, o).mesh;
    const bool out = d == Direction::Outer;
    const Mesh &inner = out ? p.solid.mesh() : result, &outer = out ? result : p.solid.mesh();
    const double start = seconds();
    const verify::Inclusion claim = verify::verify_inclusion(inner, outer);
    std::cout << title << (out ? " outer " : " inner ") << ratio << ": "
              << p.solid.mesh().triangles.size() << " -> " << result.triangles.size()
              << (p.solid.closed() ? "" : ", open") << ": solid " << text(claim.solid)
              << "; surface " << text(claim.surface) << "; " << std::setprecision(3)
              << seconds() - start << " s";
    ++solid_[index(claim.solid.answer)];
    ++surface_[index(claim.surface.answer)];
    bool good = claim.solid.answer == Answer::Verified;
    if (inner.triangles.size() + outer.triangles.size() <= s_.oracle) {
      const ArrangementVerdict truth = arrangement_verdict(inner, outer);
      const std::optional<bool> solid = p.solid.closed() ? truth.solid : truth.difference;
      const bool agree = agrees(claim.solid, solid) && agrees(claim.surface, truth.surface);
      std::cout << "; the oracle " << (agree ? "agrees" : "DISAGREES") << " (" << truth.cells
                << " cells)";
      good = good && agree;
    }
    std::cout << (good ? "\n" : "  <--\n") << std::flush;
    if (s_.mutants != 0 && inner.triangles.size() + outer.triangles.size() <= s_.oracle) {
      for (const MeshPair& mutant : mutants({title, inner, outer}, ++seed_, s_.mutants)) {
        mutants_.judge_one(mutant, seed_);
      }
    }
    failures_ += good ? 0 : 1;
  }

  static bool agrees(const verify::Claim& claim, const std::optional<bool>& truth) {
    if (!truth) return claim.answer == Answer::Undefined;
    return claim.answer == (*truth ? Answer::Verified : Answer::Refuted);
  }

  static int index(Answer a) {
    return a == Answer::Verified ? 0 : a == Answer::Refuted ? 1 : a == Answer::Undecided ? 2 : 3;
  }

  static std::string text(const verify::Claim& claim) {
    std::ostringstream text;
    text << name_of(claim.answer);
    if (claim.witness) {
      text << " (" << claim.inner_triangles.size() << " + " << claim.outer_triangles.size()
           << " triangles, " << std::setprecision(3) << claim.witness->depth << " deep"
           << (claim.witness->exact ? ")" : ", beside)");
    }
    return text.str();
  }

  Settings s_;
  Counts solid_{}, surface_{};
  Tally mutants_;
  std::uint64_t seed_ = 0;
  int failures_ = 0;
};

}  // namespace

int main(int argc, char** argv) try {
  Settings settings;
  bool families = false, bent = false, open = false;
  std::size_t pairs = 0;
  std::uint64_t first = 1'000'000;
  std::vector<std::string> files;
  const std::vector<std::string> args(argv + 1, argv + argc);
  for (std::size_t i = 0; i < args.size(); ++i) {
    const auto value = [&] { return args.at(++i); };
    if (args[i] == "--pairs") {
      pairs = std::stoul(value());
    } else if (args[i] == "--first") {
      first = std::stoul(value());
    } else if (args[i] == "--bent") {
      bent = true;
    } else if (args[i] == "--open") {
      open = true;
    } else if (args[i] == "--families") {
      families = true;
    } else if (args[i] == "--corpus") {
      for (std::string& f : mesh_files(corpus())) files.push_back(std::move(f));
    } else if (args[i] == "--own") {
      for (std::string& f : mesh_files(value())) files.push_back(std::move(f));
    } else if (args[i] == "--largest") {
      settings.largest = std::stoul(value());
    } else if (args[i] == "--oracle") {
      settings.oracle = std::stoul(value());
    } else if (args[i] == "--mutants") {
      settings.mutants = std::stoi(value());
    } else if (args[i] == "--ratios") {
      settings.ratios.clear();
      std::istringstream list(value());
      for (std::string r; std::getline(list, r, ',');) settings.ratios.push_back(std::stod(r));
    } else if (args[i].starts_with("--")) {
      throw std::runtime_error("unknown option " + args[i]);
    } else {
      files.push_back(args[i]);
    }
  }
  Attack attack(settings);
  if (pairs != 0) {
    if (bent) {
      attack.pairs("bent", bent_pair, first, pairs);
    } else if (open) {
      attack.pairs("open", open_pair, first, pairs);
    } else {
      attack.pairs("lattice", lattice_pair, first, pairs);
    }
  }
  if (families) {
    for (const auto& f : closed_families()) attack.mesh(f.name, f.mesh);
  }
  for (const std::string& f : files) attack.file(f);
  return attack.conclude();
} catch (const std::exception& e) {
  std::cerr << "verify_attack: " << e.what() << '\n';
  return 2;
}

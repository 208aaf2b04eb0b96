// A segmentation of a mesh by a method that bcd-decompose is compared with:
//
//   segmentation-benchmark clusters|voxels MESH -o FILE.obj --max-bodies N
//     [--max-vertices-per-body 64] [--effort fast|normal|best] [--report FILE.json]
//
// As for bcd-decompose --drop-sheets, what is written is read back, and that it covers the solid
// and every triangle is decided exactly; nothing is written where it does not. The report has
// method, bodies, vertices and reach: the certified bracket of the farthest point's distance.
// Exit codes: 0 done; 1 more bodies than asked for; 2 usage; 3 bad input; 6 no cover was found.
#include <kaboum/base/error.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/cover.h>

#include <iostream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "compared_methods.h"

namespace {

using namespace kaboum;  // NOLINT: a program

const std::map<std::string, bcd::ComparedMethod> kMethods{
    {"clusters", bcd::ComparedMethod::Clusters}, {"voxels", bcd::ComparedMethod::Voxels}};
const std::map<std::string, bcd::Effort> kEfforts{
    {"fast", bcd::Effort::Fast}, {"normal", bcd::Effort::Normal}, {"best", bcd::Effort::Best}};

struct Request {
  std::string method, mesh, out, report;
  bcd::CoverOptions options;
};

/// @throws std::exception on anything but what is described above
Request read_arguments(const std::vector<std::string>& args) {
  Request r;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < args.size(); ++i) {
    const auto value = [&] { return args.at(++i); };
    if (args[i] == "-o") {
      r.out = value();
    } else if (args[i] == "--max-bodies") {
      r.options.max_bodies = std::stoul(value());
    } else if (args[i] == "--max-vertices-per-body") {
      r.options.max_vertices = std::stoul(value());
    } else if (args[i] == "--effort") {
      r.options.effort = kEfforts.at(value());
    } else if (args[i] == "--report") {
      r.report = value();
    } else {
      names.push_back(args[i]);
    }
  }
  if (names.size() != 2 || !kMethods.contains(names[0]) || r.out.empty() || !r.options.max_bodies)
    throw std::invalid_argument(
        "clusters|voxels MESH -o FILE.obj --max-bodies N are needed, see main.cpp");
  r.method = names[0];
  r.mesh = names[1];
  return r;
}

/// True if a set covers the closed mesh, decided exactly.
bool covers(const geom::ConvexSet& set, const geom::Mesh& closed) {
  verify::InclusionOptions options;
  options.max_work = std::numeric_limits<double>::infinity();  // it has to be decided
  const verify::Cover cover = verify::verify_cover(closed, set, options);
  return cover.convexity.convex.answer == verify::Answer::Verified &&
         cover.inclusion.solid.answer == verify::Answer::Verified &&
         cover.inclusion.surface.answer == verify::Answer::Verified;
}

int run(const Request& r) {
  geom::PrepareOptions how;
  how.drop_sheets = true;
  const geom::Prepared input = geom::prepare(io::read_mesh(r.mesh).mesh, how);
  bcd::CoverCandidate found = bcd::find_cover_by(kMethods.at(r.method), input.solid, r.options);
  if (found.stop == bcd::Stop::TooCoarse)
    throw Error(ErrorCode::InvalidInput, r.mesh + ": float32 is too coarse here");
  geom::ConvexSet made;
  made.bodies = std::move(found.bodies);
  const std::vector<char> bytes = io::serialise_convex_set(made, io::SetFormat::Obj);
  const geom::ConvexSet set = io::parse_convex_set(bytes, io::Format::Obj, "the result");
  if (!covers(set, geom::close_holes(input.solid).mesh()))
    throw Error(ErrorCode::Internal, r.mesh + ": the bodies do not pass the exact check");
  io::write_file(r.out, bytes);
  const nlohmann::ordered_json report{
      {"method", r.method},
      {"bodies", set.bodies.size()},
      {"vertices", found.statistics.vertices},
      {"reach", {{"lower", found.excess_lower}, {"upper", found.excess_upper}}}};
  const std::string text = report.dump(2) + '\n';
  if (!r.report.empty()) io::write_file(r.report, text);
  std::cout << text;
  return found.stop == bcd::Stop::Done ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  try {
    request = read_arguments({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    std::cerr << "segmentation-benchmark: " << e.what() << '\n';
    return 2;
  }
  try {
    return run(request);
  } catch (const Error& e) {
    std::cerr << "segmentation-benchmark: " << e.what() << '\n';
    return e.code() == ErrorCode::InvalidInput      ? 3
           : e.code() == ErrorCode::InvalidArgument ? 2
           : e.code() == ErrorCode::OutputFailed    ? 4
                                                    : 6;
  } catch (const std::exception& e) {
    std::cerr << "segmentation-benchmark: " << e.what() << '\n';
    return 6;
  }
}

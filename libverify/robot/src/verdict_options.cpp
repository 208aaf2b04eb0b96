// The options of verdicts on robots and on motions: their tables.

#include <kaboum/robot/shape_options.h>
#include <kaboum/verify/robot_options.h>

namespace kaboum::verify {
namespace {

std::vector<Option<RobotVerdictOptions>> robot_table() {
  using R = RobotVerdictOptions;
  static constexpr std::array<std::pair<const char*, Solid>, 2> kSolids{
      {{"auto", Solid::Prepared}, {"wrap", Solid::Enclosed}}};
  std::vector<Option<R>> out{
      choice<R>(
          claims_option(), [](auto& r) -> auto& { return r.claims; }, kClaims),
      option<R>(
          {.name = "epsilon",
           .text = "Also decide that no body is farther than this from the meshes it holds: a "
                   "length in metres or its own unit, as in 5mm, or a percentage of each mesh's "
                   "diagonal"},
          [](auto& r) -> auto& { return r.epsilon; }),
      choice<R>(
          {.name = "prepare",
           .text = "Judge the solid of each mesh as decimation and decomposition prepare it "
                   "(" +
                   preparation_words() +
                   "), which is what their claims are about, and every triangle of the file "
                   "besides. Where preparing refuses a mesh: its triangles alone, with all "
                   "that its closed parts wind round. wrap: that of all meshes, as results "
                   "of wrapping promise",
           .implied = "auto"},
          [](auto& r) -> auto& { return r.solid; }, kSolids),
      option<R>(
          drop_sheets_option(), [](auto& r) -> auto& { return r.drop_sheets; }),
      option<R>(
          exact_points_option(), [](auto& r) -> auto& { return r.exact_points; }),
      option<R>(
          max_contacts_option(), [](auto& r) -> auto& { return r.max_contacts; }),
      option<R>(
          max_work_option(), [](auto& r) -> auto& { return r.max_work; })};
  for (auto& one : options_of_part<R>(
           robot::held_shape_options(), [](auto& r) -> auto& { return r.shapes; }))
    out.push_back(std::move(one));
  return out;
}

std::vector<Option<MotionVerdictOptions>> motion_table() {
  using R = MotionVerdictOptions;
  static constexpr std::array<std::pair<const char*, Claims>, 2> kOfMotions{
      {{"all", Claims::All}, {"surface", Claims::Surface}}};
  std::vector<Option<R>> out{
      choice<R>(
          claims_option(), [](auto& r) -> auto& { return r.claims; }, kOfMotions),
      choice<R>(
          {.name = "prepare",
           .text = "Judge the links' meshes as decomposition prepares them (" +
                   preparation_words() + "); one that preparing refuses, as it is",
           .implied = "auto"},
          [](auto& r) -> auto& { return r.shapes.prepare; }, kPrepared),
      option<R>(
          drop_sheets_option(), [](auto& r) -> auto& { return r.shapes.drop_sheets; }),
      option<R>(
          exact_points_option(), [](auto& r) -> auto& { return r.shapes.exact_points; }),
      option<R>(
          {.name = "gap",
           .text = "Parts that move and measure less are not divided further; where they are "
                   "not known to be inside, the answer is undecided",
           .absolute = true,
           .otherwise = "margin / 10^6"},
          [](auto& r) -> auto& { return r.gap; }),
      option<R>(
          {.name = "max-cells",
           .text = "Give up, undecided, beyond this many parts of a triangle per segment of "
                   "the path",
           .low = 1,
           .high = 1'000'000'000},
          [](auto& r) -> auto& { return r.max_cells; }),
      option<R>(
          robot::base_pose_option(), [](auto& r) -> auto& { return r.base_pose; })};
  for (auto& one : options_of_part<R>(
           options_named(robot::path_options(), {"joint", "degrees"}),
           [](auto& r) -> auto& { return r.reading; }))
    out.push_back(std::move(one));
  for (auto& one : options_of_part<R>(
           robot::shape_options(), [](auto& r) -> auto& { return r.shapes.choice; }))
    out.push_back(std::move(one));
  return out;
}

}  // namespace

const std::vector<Option<RobotVerdictOptions>>& robot_verdict_options() {
  static const std::vector<Option<RobotVerdictOptions>> options = robot_table();
  return options;
}

const std::vector<Option<MotionVerdictOptions>>& motion_verdict_options() {
  static const std::vector<Option<MotionVerdictOptions>> options = motion_table();
  return options;
}

std::string contradiction(const RobotVerdictOptions& o) {
  return o.drop_sheets && o.solid == Solid::AsFile ? "{drop-sheets} needs {prepare}" : "";
}

std::string contradiction(const MotionVerdictOptions& o) {
  return o.shapes.drop_sheets && !o.shapes.prepare ? "{drop-sheets} needs {prepare}" : "";
}

RobotQuestion question_of(const robot::Robot& original, const robot::Robot& result,
                          std::function<const MeshFile&(const robot::Geometry&, bool)> file_of,
                          const RobotVerdictOptions& options) {
  RobotQuestion out{original, result, std::move(file_of)};
  out.links = options.shapes.links;
  out.visual = options.shapes.visual;
  out.claims = options.claims;
  out.solid = options.solid;
  out.drop_sheets = options.drop_sheets;
  out.epsilon = options.epsilon;
  out.limits.max_contacts = options.max_contacts;
  out.limits.max_work = options.max_work;
  return out;
}

}  // namespace kaboum::verify

// Constraint sampling in the two scenes of Fig. 5.4: how many draws end within the limits, in which
// time, and how the samples are spread: sampling-benchmark [SAMPLES [FIGURE.svg [TABLE.csv]]].
#include <kaboum/kinematics/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>

#include "arms.h"

namespace {

using namespace kaboum::test;

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kBins = 36;

double seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Scene {
  std::string name, axis;
  ConstraintProblem problem;
  double lower, upper;  ///< of what is binned
  std::function<double(const Transform& tool)> where;
};

/// The RV-6SL on the floor, its tool 0.1 from the flange.
PlacedArm robot() {
  PlacedArm placed;
  DhArm dh = rv_6sl(true);
  dh.tool.translation = {0, 0, 0.1};
  placed.arm = arm_of(dh);
  const std::array<std::pair<double, double>, 6> limits{
      {{-170, 170}, {-92, 135}, {-129, 166}, {-160, 160}, {-120, 120}, {-360, 360}}};
  for (std::size_t i = 0; i < 6; ++i) {
    placed.arm.axes[i].lower = limits.at(i).first * kPi / 180;
    placed.arm.axes[i].upper = limits.at(i).second * kPi / 180;
  }
  return placed;
}

/// (a): Parallel(tool's plane, table), Distance(tool's centre, table) = the object's height.
Scene place_on_table() {
  const FrameId tool{FrameId::Kind::Tool, 0}, world;
  Scene scene{"place on a table", "y on the table [m]", {{robot()}, {}, {}}, -0.9, 0.9, {}};
  const Plane table{{0, 0, 0}, {0, 0, 1}};
  scene.problem.constraints = {
      {Relation::Parallel, {tool, Plane{{0, 0, 0}, {0, 0, 1}}}, {world, table}},
      {Relation::Distance, {tool, Point{}}, {world, table}, 0.1}};
  scene.where = [](const Transform& t) { return t.translation.y(); };
  return scene;
}

/// (b): Parallel(tool's z, axis), Distance(tool's centre, axis) = radius, Coincident(tool's x,
/// top).
Scene rim_of_cylinder() {
  const FrameId tool{FrameId::Kind::Tool, 0}, world;
  Scene scene{"rim of a cylinder", "grasp angle [rad]", {{robot()}, {}, {}}, -kPi, kPi, {}};
  const Vec3 centre(0.5, 0, 0.2);
  scene.problem.constraints = {
      {Relation::Parallel, {tool, Line{}}, {world, Line{centre, {0, 0, 1}}}},
      {Relation::Distance, {tool, Point{}}, {world, Line{centre, {0, 0, 1}}}, 0.05},
      {Relation::Coincident,
       {tool, Line{{0, 0, 0}, {1, 0, 0}}},
       {world, Plane{centre, {0, 0, 1}}}}};
  scene.where = [centre](const Transform& t) {
    return std::atan2(t.translation.y() - centre.y(), t.translation.x() - centre.x());
  };
  return scene;
}

using Histogram = std::array<std::size_t, kBins>;

/// A line on stdout and one for the table.
Histogram run(const Scene& scene, const char* method, const SampleOptions& options, int samples,
              std::string& table) {
  ConstraintSampler sampler(scene.problem, options);
  const Arm& arm = scene.problem.robots[0].arm;
  Histogram bins{};
  std::size_t good = 0;
  double worst = 0;
  const double start = seconds();
  std::vector<Sample> all;
  for (int i = 0; i < samples; ++i)
    if (auto s = sampler.next()) all.push_back(std::move(*s));
  const double time = seconds() - start;
  for (const Sample& s : all) {
    good += within_limits(arm, s.at.joints[0]);
    worst = std::max(worst, s.error);
    const double x = scene.where(kaboum::kinematics::forward(arm, s.at.joints[0]));
    const double share = (x - scene.lower) / (scene.upper - scene.lower);
    if (share >= 0 && share < 1) ++bins.at(static_cast<std::size_t>(share * kBins));
  }
  const auto& t = sampler.tally();
  const auto draws = static_cast<double>(t.draws);
  std::printf(
      "%-18s %-40s %6.2f %% of calls within limits, %6.2f draws per call; of draws %5.1f %% "
      "projected, %5.1f %% reached; %7.1f us per call, worst cost %.1e, empty bins %ld, %.1f poses "
      "solved per call\n",
      scene.name.c_str(), method, 100.0 * static_cast<double>(good) / samples, draws / samples,
      100.0 * static_cast<double>(t.projected) / draws,
      100.0 * static_cast<double>(t.reached) / draws, 1e6 * time / samples, worst,
      std::count(bins.begin(), bins.end(), 0U), static_cast<double>(t.solved) / samples);
  char line[160];
  std::snprintf(line, sizeof line, "%s,%s,%.2f,%.2f,%.1f\n", scene.name.c_str(), method,
                100.0 * static_cast<double>(good) / samples, draws / samples, 1e6 * time / samples);
  table += line;
  return bins;
}

/// Bars of two methods beside each other, one panel per scene.
class Figure {
 public:
  void add(const Scene& scene, const Histogram& projected, const Histogram& closed) {
    const double top = 40 + 240 * panel_++;
    const auto total = [](const Histogram& h) {
      double sum = 0;
      for (const std::size_t n : h) sum += static_cast<double>(n);
      return std::max(sum, 1.0);
    };
    double most = 0;
    for (std::size_t i = 0; i < kBins; ++i)
      most = std::max({most, static_cast<double>(projected.at(i)) / total(projected),
                       static_cast<double>(closed.at(i)) / total(closed)});
    const auto text = [&](double x, double y, const char* anchor, const std::string& what) {
      body_ += "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor +
               "\">" + what + "</text>\n";
    };
    text(40, top - 8, "start", scene.name);
    for (std::size_t i = 0; i < kBins; ++i) {
      const double x = 40 + 16 * static_cast<double>(i);
      bar(x + 1, top + 180, 180 * static_cast<double>(projected.at(i)) / total(projected) / most,
          "#c8803c");
      bar(x + 8, top + 180, 180 * static_cast<double>(closed.at(i)) / total(closed) / most,
          "#3c6ec8");
    }
    text(40, top + 196, "start", number(scene.lower));
    text(40 + 16.0 * kBins, top + 196, "end", number(scene.upper));
    text(40 + 8.0 * kBins, top + 196, "middle", scene.axis);
  }
  void write(const char* name) const {
    std::ofstream(name) << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"660\" height=\""
                        << 40 + 240 * panel_
                        << "\" font-family=\"sans-serif\" font-size=\"12\">\n"
                           "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
                           "<text x=\"616\" y=\"16\" text-anchor=\"end\"><tspan fill=\"#c8803c\">"
                           "Algorithm 3 (joints)</tspan>  <tspan fill=\"#3c6ec8\">closed form"
                           "</tspan></text>\n"
                        << body_ << "</svg>\n";
  }

 private:
  static std::string number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", x);
    return text;
  }
  void bar(double x, double bottom, double height, const char* colour) {
    body_ += "<rect x=\"" + number(x) + "\" y=\"" + number(bottom - height) +
             "\" width=\"7\" height=\"" + number(height) + "\" fill=\"" + colour + "\"/>\n";
  }
  int panel_ = 0;
  std::string body_;
};

}  // namespace

int main(int argc, char** argv) {
  const int samples = argc > 1 ? std::atoi(argv[1]) : 20000;
  Figure figure;
  std::string table = "scene,method,within_percent,draws,microseconds\n";
  for (const Scene& scene : {place_on_table(), rim_of_cylinder()}) {
    SampleOptions options;
    options.closed_form = false;
    options.limits = false;
    options.draws = 1;
    run(scene, "Algorithm 3: one draw", options, samples, table);
    options.limits = true;
    run(scene, "with limits: one draw", options, samples, table);
    options.draws = 100;
    const Histogram projected = run(scene, "with limits: up to 100 draws", options, samples, table);
    options.closed_form = true;
    options.draws = 1;
    options.motions = 0;
    run(scene, "closed form without free motions: one draw", options, samples, table);
    options.motions = SampleOptions().motions;
    run(scene, "closed form: one draw", options, samples, table);
    options.draws = 100;
    const Histogram closed = run(scene, "closed form: up to 100 draws", options, samples, table);
    figure.add(scene, projected, closed);
  }
  if (argc > 2) figure.write(argv[2]);
  if (argc > 3) std::ofstream(argv[3]) << table;
}

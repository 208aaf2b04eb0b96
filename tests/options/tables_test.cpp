// The tables of options of all libraries: names, texts, defaults, ranges, records.

#include <gtest/gtest.h>
#include <kaboum/base/length_unit.h>
#include <kaboum/certify/mesh_options.h>
#include <kaboum/certify/set_options.h>
#include <kaboum/certify/sweep_options.h>
#include <kaboum/distance/compare_options.h>
#include <kaboum/engines/engine_options.h>
#include <kaboum/execution/task_options.h>
#include <kaboum/kinematics/inverse_options.h>
#include <kaboum/motion/keep_options.h>
#include <kaboum/motion/path_options.h>
#include <kaboum/motion/trajectory_options.h>
#include <kaboum/pairs/decide_options.h>
#include <kaboum/picture/panels.h>
#include <kaboum/plan/solve_options.h>
#include <kaboum/robot/path_options.h>
#include <kaboum/robot/shape_options.h>
#include <kaboum/scene/derived_features.h>
#include <kaboum/scene/scene_options.h>
#include <kaboum/verify/robot_options.h>
#include <kaboum/world/check_options.h>
#include <kaboum/world/margins.h>

#include <cmath>
#include <set>

#include "support/other_option_value.h"

namespace kaboum {
namespace {

using Kind = OptionDescription::Kind;

template <class Request>
void check_names_and_texts(const std::vector<Option<Request>>& table) {
  std::set<std::string> names;
  for (const Option<Request>& o : table) {
    EXPECT_TRUE(names.insert(o.name).second) << o.name << " is there twice";
    EXPECT_EQ(o.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-"), std::string::npos) << o.name;
    EXPECT_TRUE(!o.text.empty() && !o.text.ends_with('.')) << o.name << ": " << o.text;
  }
  for (const Option<Request>& o : table)
    meaning(o.text + o.otherwise, [&](const std::string& name) {
      EXPECT_TRUE(names.contains(name)) << o.name << " speaks of " << name;
      return name;
    });
}

template <class Request>
void check_ranges(const Option<Request>& o) {
  const auto standard = default_of(o);
  if (standard && !standard->empty()) {
    EXPECT_EQ(flaw_of(o, *standard), "") << o.name;
  }
  if (o.kind != Kind::Count && o.kind != Kind::Number) return;
  const auto text = [&](double value) {
    return o.kind == Kind::Count ? std::to_string(static_cast<long long>(value))
                                 : option_text::of(value);
  };
  const auto soundly = [&](double value) { return flaw_of(o, text(value)).empty(); };
  if (std::isfinite(o.low)) {
    EXPECT_EQ(soundly(o.low), !o.between) << o.name;
    EXPECT_FALSE(soundly(o.low - 1)) << o.name;
  }
  if (std::isfinite(o.high)) {
    EXPECT_EQ(soundly(o.high), !o.between) << o.name;
    EXPECT_FALSE(soundly(2 * o.high + 1)) << o.name;
  }
}

/// All lengths take units; what they are shares of, or that they are none, is said.
template <class Request>
void check_lengths(const Option<Request>& o) {
  const bool lengths = o.kind == Kind::Length || (o.kind == Kind::Settings && o.absolute);
  EXPECT_EQ(unit_words(o).empty(), !(lengths && o.absolute)) << o.name;
  if (!lengths) return;
  const std::string name = o.kind == Kind::Settings ? "another=" : "";
  for (const char* wrong : {"5 mm", "5mn", "mm"}) EXPECT_NE(flaw_of(o, name + wrong), "") << o.name;
  for (const std::string_view unit : kLengthUnits)
    EXPECT_EQ(flaw_of(o, name + "5" + std::string(unit)), "") << o.name;
  const std::string share = flaw_of(o, name + "1%");
  EXPECT_EQ(share.empty(), !o.absolute) << o.name;
  EXPECT_EQ(share.find("no diagonal") != std::string::npos, o.absolute) << o.name;
  Request stated;
  o.assign(stated, name + "5mm");
  const std::string kept = o.value(stated).value_or("");
  EXPECT_TRUE(kept == name + "5mm" || kept == "0.005") << o.name << " " << kept;
}

template <class Request>
void check_record(const std::vector<Option<Request>>& table, const Option<Request>& o) {
  Request changed;
  const std::string value = test::other_value(o);
  ASSERT_EQ(flaw_of(o, value), "") << o.name << " " << value;
  ASSERT_NE(o.value(changed), value) << o.name;
  o.assign(changed, value);
  EXPECT_EQ(o.value(changed), value) << o.name;
  for (const Option<Request>& other : table)
    if (other.name != o.name) {
      EXPECT_EQ(other.value(changed), default_of(other)) << other.name << " is set by " << o.name;
    }
  Request back;
  EXPECT_EQ(read_record(table, record_of(table, changed), back), "") << o.name;
  EXPECT_EQ(o.value(back), o.unrecorded ? default_of(o) : value) << o.name;
}

template <class Request>
void check(const char* name, const std::vector<Option<Request>>& table) {
  SCOPED_TRACE(name);
  EXPECT_FALSE(table.empty());
  check_names_and_texts(table);
  for (const Option<Request>& o : table) {
    check_ranges(o);
    check_lengths(o);
    check_record(table, o);
  }
}

TEST(OptionTables, AreSound) {
  check("meshes", certify::mesh_options());
  check("preparations", certify::preparation_options(certify::PreparedFor::Preparing));
  check("wraps", certify::wrap_options());
  check("sets", certify::set_options());
  check("robots' sets", certify::robot_set_options());
  check("swept sets", certify::swept_set_options());
  check("distances", distance::compare_options());
  check("verdicts on meshes", verify::mesh_verdict_options());
  check("verdicts on covers", verify::cover_verdict_options());
  check("verdicts on robots", verify::robot_verdict_options());
  check("verdicts on motions", verify::motion_verdict_options());
  check("inverse kinematics", kinematics::inverse_options());
  check("paths", motion::path_options());
  check("what motions keep", motion::keep_options());
  check("trajectories", motion::trajectory_options());
  check("files of paths", robot::path_options());
  check("shapes of robots", robot::shape_options());
  check("shapes of robots that are to be held", robot::held_shape_options());
  check("states", world::state_options());
  check("margins", world::margin_options());
  check("engines", engines::engine_options());
  check("motions", world::motion_options());
  check("pairs of links", world::pair_options());
  check("pairs of links by meshes", pairs::decide_options());
  check("scenes", scene::scene_options());
  check("grasps", scene::grasp_options());
  check("places", scene::place_options());
  check("plans", plan::solve_options());
  check("planning tasks", execution::task_options());
  check("executions", execution::run_options());
  check("robot drivers", execution::driver_options());
  check("pages of plans", execution::page_options());
  check("pictures", picture::panel_options());
}

/// Records of swept sets state what the links' bodies are made with, and digits as they were given.
TEST(OptionTables, RecordsOfSweptSetsKeepDigits) {
  certify::SweptSetOptions options;
  const auto& table = certify::swept_set_options();
  option_named(table, "epsilon").assign(options, "0.0100");
  option_named(table, "joint").assign(options, "finger=0.040\nthumb=1");
  const std::string record = certify::sweep_request_of(options).parameters;
  EXPECT_EQ(record,
            "--epsilon 0.0100 --bound balanced --body-epsilon 0.0100 --max-vertices-per-body 64 "
            "--effort normal --geometry collision --joint finger=0.040 --joint thumb=1");
  certify::SweptSetOptions back;
  EXPECT_EQ(read_record(table, record, back), "");
  EXPECT_EQ(back.joints, options.joints);
  EXPECT_EQ(back.epsilon, options.epsilon);
}

}  // namespace
}  // namespace kaboum

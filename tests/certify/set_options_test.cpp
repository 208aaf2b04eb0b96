// The options of sets: records keep the words that they had, and are read back; keys of the cache
// depend on each.

#include <gtest/gtest.h>
#include <kaboum/certify/set_cache.h>
#include <kaboum/certify/set_options.h>

#include "support/other_option_value.h"
#include "support/shapes.h"

namespace kaboum::certify {
namespace {

TEST(SetOptions, RecordsKeepTheirWords) {
  SetRequest r;
  EXPECT_EQ(r.parameters(), "--epsilon 1% --max-vertices-per-body 64 --effort normal");
  r.max_bodies = 7;
  r.effort = bcd::Effort::Fast;
  EXPECT_EQ(r.parameters(), "--max-bodies 7 --max-vertices-per-body 64 --effort fast");
  r = {};
  r.epsilon = Length{0.01};
  r.max_bodies = 3;
  r.max_vertices = 255;
  r.effort = bcd::Effort::Best;
  r.max_work = 2.5;
  r.max_total_vertices = 100;
  r.pre_step = bcd::PreStep::Off;
  r.simplify = 0.25;
  r.improve_work = 30;
  r.thickness = Length{0.0001};
  r.max_aspect = 50;
  r.scale = 0.001;
  r.preparation.drop_sheets = true;
  r.preparation.holes = geom::Holes::Refuse;
  r.preparation.keep_orientation = true;
  EXPECT_EQ(
      r.parameters(),
      "--epsilon 0.01 --max-bodies 3 --max-total-vertices 100 --min-thickness 1e-04 --max-aspect "
      "50 --max-vertices-per-body 255 --effort best --simplify 0.25 --max-work 2.5 "
      "--improve-work 30 --pre-step off --scale 0.001 --drop-sheets "
      "--holes refuse --keep-orientation");
  r = {};
  r.direction = SetRequest::Direction::Inner;
  EXPECT_EQ(r.parameters(),
            "--epsilon 1% --direction inner --max-vertices-per-body 64 --effort normal");
  r = {};
  r.wrap.emplace();
  r.wrap->offset = Length{0.1, true};
  r.wrap->seal = Length{2};
  EXPECT_EQ(r.parameters(),
            "--epsilon 1% --max-vertices-per-body 64 --effort normal --prepare wrap --offset 0.1% "
            "--seal 2");
}

TEST(SetOptions, EachIsRecordedReadBackAndPartOfTheKey) {
  const geom::Mesh mesh = test::box({1, 2, 3}, 1);
  for (const Option<SetOptions>& o : set_options()) {
    SetOptions plain, changed;
    const bool of_wrap = o.name == "offset" || o.name == "seal";
    if (of_wrap) plain.preparation.mode = changed.preparation.mode = PreparationOptions::Mode::Wrap;
    const std::string value = test::other_value(o);
    ASSERT_EQ(flaw_of(o, value), "") << o.name << " " << value;
    o.assign(changed, value);
    EXPECT_EQ(o.value(changed), value) << o.name;
    EXPECT_EQ(contradiction(changed, {o.name}), "") << o.name;
    EXPECT_NE(SetCache::key_of(mesh, "", request_of(plain)).hash,
              SetCache::key_of(mesh, "", request_of(changed)).hash)
        << o.name;
    SetOptions back;
    EXPECT_EQ(read_record(set_options(), request_of(changed).parameters(), back), "") << o.name;
    if (!o.unrecorded) {
      EXPECT_EQ(o.value(options_of(request_of(back))), o.value(options_of(request_of(changed))))
          << o.name;
    }
  }
}

/// Containers made by a program that had another option are read; what is not known is named.
TEST(SetOptions, UnknownPartsOfRecordsAreNamed) {
  SetOptions read;
  EXPECT_EQ(read_record(set_options(), "--max-bodies 6 --method voxels --scale 0.001", read),
            "--method");
  EXPECT_EQ(read.request.max_bodies, 6U);
}

TEST(SetOptions, ContradictionsNameBoth) {
  const auto flaw = [](std::vector<std::pair<std::string, std::string>> stated) {
    SetOptions options;
    std::set<std::string> names;
    for (const auto& [name, value] : stated)
      for (const Option<SetOptions>& o : set_options())
        if (o.name == name) {
          o.assign(options, value);
          names.insert(name);
        }
    EXPECT_EQ(names.size(), stated.size());
    return contradiction(options, names);
  };
  for (const auto& pair : std::vector<std::vector<std::pair<std::string, std::string>>>{
           {{"offset", "1%"}, {"prepare", "auto"}},
           {{"holes", "fill"}, {"prepare", "strict"}},
           {{"drop-sheets", "true"}, {"prepare", "wrap"}},
           {{"keep-orientation", "true"}, {"prepare", "wrap"}},
           {{"prepare", "wrap"}, {"direction", "inner"}},
           {{"simplify", "0.5"}, {"direction", "inner"}},
           {{"improve-work", "5"}, {"direction", "inner"}},
           {{"max-total-vertices", "50"}, {"direction", "inner"}},
           {{"pre-step", "on"}, {"direction", "inner"}},
           {{"bodies", "capsules"}, {"direction", "inner"}},
           {{"bodies", "boxes"}, {"direction", "inner"}},
           {{"bodies", "mixed"}, {"direction", "inner"}},
           {{"max-work", "5"}, {"bodies", "spheres"}},
           {{"simplify", "0.5"}, {"max-total-vertices", "50"}}}) {
    const std::string text = flaw(pair);
    for (const auto& [name, value] : pair)
      EXPECT_NE(text.find("{" + name + "}"), std::string::npos) << name << ": " << text;
  }
  EXPECT_EQ(flaw({{"seal", "1%"}, {"prepare", "wrap"}}), "");
  EXPECT_EQ(flaw({{"bodies", "spheres"}, {"direction", "inner"}}), "");
  EXPECT_EQ(flaw({{"bodies", "spheres"}, {"direction", "inner"}, {"max-bodies", "5"}}), "");
  EXPECT_EQ(flaw({{"drop-sheets", "true"}, {"prepare", "strict"}}), "");
}

}  // namespace
}  // namespace kaboum::certify

// The options of bounding meshes: keys of the cache depend on each, records are read back, and
// contradictions are named.

#include <gtest/gtest.h>
#include <kaboum/certify/mesh_options.h>

#include "support/other_option_value.h"

namespace kaboum::certify {
namespace {

TEST(MeshOptions, EachIsReadBackAndPartOfTheKey) {
  for (const Option<MeshOptions>& o : mesh_options()) {
    MeshOptions plain, changed;
    if (o.name == "offset" || o.name == "seal")
      plain.preparation.mode = changed.preparation.mode = PreparationOptions::Mode::Wrap;
    const std::string value = test::other_value(o);
    ASSERT_EQ(flaw_of(o, value), "") << o.name << " " << value;
    o.assign(changed, value);
    EXPECT_EQ(o.value(changed), value) << o.name;
    const bool measured = o.name == "measure";  // every enclosing mesh is
    EXPECT_EQ(
        enclosure_request_of(plain).parameters() == enclosure_request_of(changed).parameters(),
        measured)
        << o.name;
    MeshOptions back;
    EXPECT_EQ(read_record(mesh_options(), record_of(mesh_options(), changed), back), "") << o.name;
    EXPECT_EQ(o.value(back), o.value(changed)) << o.name;
  }
}

std::string flaw(const std::vector<std::pair<std::string, std::string>>& stated) {
  MeshOptions options;
  std::set<std::string> names;
  for (const auto& [name, value] : stated)
    for (const Option<MeshOptions>& o : mesh_options())
      if (o.name == name) {
        o.assign(options, value);
        names.insert(name);
      }
  EXPECT_EQ(names.size(), stated.size());
  return contradiction(options, names);
}

TEST(MeshOptions, ContradictionsNameBoth) {
  for (const auto& [one, other] : std::vector<
           std::pair<std::pair<std::string, std::string>, std::pair<std::string, std::string>>>{
           {{"vertices", "100,50"}, {"ratio", "0.5"}},
           {{"cost", "distance"}, {"as-printed", "true"}},
           {{"cost", "mean"}, {"sharp-angle", "60"}},
           {{"prepare", "wrap"}, {"direction", "inner"}},
           {{"prepare", "strict"}, {"holes", "keep"}},
           {{"prepare", "auto"}, {"seal", "1%"}}}) {
    std::vector<std::pair<std::string, std::string>> stated{one, other};
    if (one.first != "vertices") stated.emplace_back("epsilon", "1%");
    const std::string text = flaw(stated);
    EXPECT_NE(text.find("{" + one.first + "}"), std::string::npos) << text;
    EXPECT_NE(text.find("{" + other.first + "}"), std::string::npos) << text;
  }
  EXPECT_NE(flaw({{"epsilon", "1%"}, {"direction", "any"}, {"verify", "true"}}), "");
  EXPECT_NE(flaw({{"direction", "outer"}}).find("at least one of"), std::string::npos);
  EXPECT_EQ(flaw({{"epsilon", "1%"}, {"prepare", "wrap"}, {"seal", "1%"}}), "");
  EXPECT_EQ(flaw({{"vertices", "50,100"}}), "");
}

TEST(MeshOptions, NumbersOfVerticesFall) {
  MeshOptions options;
  for (const Option<MeshOptions>& o : mesh_options()) {
    if (o.name != "vertices") continue;
    o.assign(options, "50,2000,100");
    EXPECT_EQ(options.request.vertices, (std::vector<std::size_t>{2000, 100, 50}));
    EXPECT_EQ(o.value(options), "2000,100,50");
    for (const char* wrong :
         {"", "3", "50,50", "50,", ",50", "50 40", "5e1", "-5", "50;40", "99999999999999999999999"})
      EXPECT_NE(flaw_of(o, wrong), "") << wrong;
  }
}

}  // namespace
}  // namespace kaboum::certify

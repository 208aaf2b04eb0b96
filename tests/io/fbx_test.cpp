// FBX: read through assimp; objects that it leaves out without a word are refused.

#include <functional>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

bool can_read() {
  const auto names = readable_formats();
  return std::ranges::find(names, "fbx") != names.end();
}

const std::string kMesh = R"(	Geometry: 10, "Geometry::g", "Mesh" {
		Vertices: *12 {
			a: 0,0,0,1,0,0,0,1,0,0,0,1
		}
		PolygonVertexIndex: *12 {
			a: 0,2,-2,0,1,-4,1,2,-4,2,0,-4
		}
		GeometryVersion: 124
	}
	Model: 20, "Model::m", "Mesh" {
		Version: 232
	}
)";

const std::string kConnections = "\tC: \"OO\",20,0\n\tC: \"OO\",10,20\n";

std::string fbx(const std::string& objects, const std::string& settings = "",
                const std::string& connections = kConnections) {
  return R"(; FBX 7.3.0 project file { not a brace
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7300
	Creator: "KABouM"
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UpAxis", "int", "Integer", "",1
)" + settings +
         R"(	}
}
Objects:  {
)" + objects +
         R"(}
Connections:  {
)" + connections +
         "}\n";
}

/// A record of a binary file with 4-byte sizes, at `at`.
std::string record(std::size_t at, const std::string& name, const std::string& properties,
                   std::uint32_t count, const std::function<std::string(std::size_t)>& children) {
  const std::size_t inside = at + 13 + name.size() + properties.size();
  const std::string nested = children ? children(inside) + std::string(13, '\0') : "";
  std::string bytes;
  append(bytes, static_cast<std::uint32_t>(inside + nested.size()));
  append(bytes, count);
  append(bytes, static_cast<std::uint32_t>(properties.size()));
  bytes += static_cast<char>(name.size());
  return bytes + name + properties + nested;
}

std::string text_property(const std::string& text) {
  std::string bytes = "S";
  append(bytes, static_cast<std::uint32_t>(text.size()));
  return bytes + text;
}

std::string binary_fbx(const std::string& kind, const std::string& type) {
  std::string bytes = "Kaydara FBX Binary  ";
  bytes += std::string("\0\x1A\0", 3);
  append(bytes, std::uint32_t{7400});
  std::string properties = "L";
  append(properties, std::int64_t{10});
  properties += "d";
  for (const std::uint32_t word : {1U, 0U, 8U}) append(properties, word);
  append(properties, 0.5);
  properties += text_property("name") + text_property(type);
  bytes += record(bytes.size(), "Objects", "", 0,
                  [&](std::size_t at) { return record(at, kind, properties, 4, nullptr); });
  return bytes + std::string(13, '\0');
}

TEST(Fbx, Mesh) {
  if (!can_read()) return;
  const ReadResult r = parse(fbx(kMesh), Format::Fbx);
  EXPECT_EQ(r.mesh.triangles.size(), 4U);
  EXPECT_TRUE(is_closed_chain(r.mesh));
  EXPECT_TRUE(r.single_precision);
}

TEST(Fbx, ObjectsThatMayHoldASurfaceAreRefused) {
  if (!can_read()) return;
  const auto object = [](const std::string& kind, const std::string& type) {
    return "	" + kind + ": 11, \"" + kind + "::x\", \"" + type + "\" {\n	}\n";
  };
  const std::array<std::array<const char*, 2>, 10> refused = {{{"Geometry", "NurbsSurface"},
                                                               {"Geometry", "NurbsCurve"},
                                                               {"Geometry", "TrimNurbsSurface"},
                                                               {"Geometry", "Patch"},
                                                               {"Geometry", "Boundary"},
                                                               {"NodeAttribute", "LodGroup"},
                                                               {"Deformer", "Skin"},
                                                               {"Constraint", "Parent-Child"},
                                                               {"SceneReference", ""},
                                                               {"Mystery", ""}}};
  for (const auto& [kind, type] : refused) {
    expect_error(fbx(kMesh + object(kind, type)), Format::Fbx,
                 {"line 26", *type != '\0' && kind != std::string("Constraint") ? type : kind});
    expect_error(binary_fbx(kind, type), Format::Fbx,
                 {"byte", *type != '\0' && kind != std::string("Constraint") ? type : kind});
  }
  EXPECT_NO_THROW(
      parse(fbx(kMesh + object("Material", "") + object("NodeAttribute", "Light")), Format::Fbx));
}

// assimp leaves them out without a word.
TEST(Fbx, ModelsThatAreNotInTheSceneAreRefused) {
  if (!can_read()) return;
  const std::string more = R"(	Geometry: 11, "Geometry::h", "Mesh" {
		Vertices: *12 {
			a: 5,0,0,6,0,0,5,1,0,5,0,1
		}
		PolygonVertexIndex: *12 {
			a: 0,2,-2,0,1,-4,1,2,-4,2,0,-4
		}
		GeometryVersion: 124
	}
	Model: 21, "Model::loose", "Mesh" {
		Version: 232
	}
	Model: 22, "Model::parent", "Null" {
		Version: 232
	}
)";
  const auto connected = [&](const std::string& more_connections) {
    return fbx(kMesh + more, "", kConnections + more_connections);
  };
  const std::string of_model = "\tC: \"OO\",11,21\n";
  EXPECT_EQ(parse(connected(of_model + "\tC: \"OO\",21,0\n"), Format::Fbx).mesh.triangles.size(),
            8U);
  EXPECT_EQ(parse(connected(of_model + "\tC: \"OO\",21,22\n\tC: \"OO\",22,0\n"), Format::Fbx)
                .mesh.triangles.size(),
            8U);
  expect_error(connected(of_model), Format::Fbx, {"line 35", "not connected"});
  expect_error(connected(of_model + "\tC: \"OO\",21,22\n"), Format::Fbx, {"not connected"});
  expect_error(connected(of_model + "\tC: \"OP\",21,0,\"x\"\n"), Format::Fbx, {"not connected"});
  const ReadResult hidden = parse(connected("\tC: \"OO\",21,0\n"), Format::Fbx);
  EXPECT_EQ(hidden.mesh.triangles.size(), 4U);
  EXPECT_TRUE(has_note(hidden, "1 mesh that no model shows"));
  expect_error(fbx(kMesh + kMesh), Format::Fbx, {"second object of the number 10"});
}

TEST(Fbx, Units) {
  if (!can_read()) return;
  const auto unit_of = [](const std::string& factor) {
    return parse(fbx(kMesh,
                     "\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," + factor + "\n"),
                 Format::Fbx)
        .unit;
  };
  EXPECT_EQ(unit_of("0.1"), "mm");  // which the importer keeps as a float
  EXPECT_EQ(unit_of("1"), "cm");
  EXPECT_EQ(unit_of("2.54"), "in");
  EXPECT_EQ(unit_of("30.48"), "ft");
  EXPECT_EQ(unit_of("100"), "m");
  EXPECT_EQ(parse(fbx(kMesh), Format::Fbx).unit, "cm");
}

TEST(Fbx, Damaged) {
  if (!can_read()) return;
  expect_error("this is no FBX", Format::Fbx, {});
  expect_error(fbx(kMesh) + "}", Format::Fbx, {"brace"});
  expect_error(fbx(kMesh) + "a: \"", Format::Fbx, {"quote"});
  const std::string good = binary_fbx("Geometry", "Patch");
  for (std::size_t n = 0; n < good.size(); ++n) {
    const std::vector<char> cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_THROW(parse({cut.data(), cut.size()}, Format::Fbx), Error) << n;
    std::string changed = good;
    changed[n] = '\xFF';
    EXPECT_THROW(parse(changed, Format::Fbx), Error) << n;
  }
}

}  // namespace
}  // namespace kaboum::io::test

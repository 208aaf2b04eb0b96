// 3MF: what is read is what the package says, in double precision; the rest is refused.

#include "io_test.h"
#include "package.h"

namespace kaboum::io::test {
namespace {

std::string model(const std::string& attributes, const std::string& resources,
                  const std::string& build) {
  return "<?xml version=\"1.0\"?>\n<model " + kCoreSpace + " " + attributes + "><resources>" +
         resources + "</resources><build>" + build + "</build></model>";
}

std::string object(int id, const std::string& content, const std::string& attributes = "") {
  return "<object id=\"" + std::to_string(id) + "\" " + attributes + ">" + content + "</object>";
}

std::string item(int id, const std::string& attributes = "") {
  return "<item objectid=\"" + std::to_string(id) + "\" " + attributes + "/>";
}

const std::string kPart = three_mf_mesh("0");
const std::string kOne = model("", object(1, kPart), item(1));

ReadResult read(const std::string& bytes) { return parse(bytes, Format::ThreeMf); }

void expect_refused(const std::string& bytes, const std::vector<std::string>& parts) {
  expect_error(bytes, Format::ThreeMf, parts);
}

/// `text` with the first `from` replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(ThreeMf, MeshInDoublePrecision) {
  const ReadResult r = read(three_mf(kOne));
  EXPECT_EQ(r.mesh.triangles.size(), 4U);
  EXPECT_TRUE(is_closed_chain(r.mesh));
  EXPECT_FALSE(r.single_precision);
  EXPECT_EQ(r.mesh.vertices[3].z(), 0.1);
  EXPECT_TRUE(has_note(r, "millimeter"));
  EXPECT_EQ(r.unit, "mm");
  const ReadResult inches = read(three_mf(replaced(kOne, "<model", "<model unit=\"inch\"")));
  EXPECT_TRUE(has_note(inches, "inch"));
  EXPECT_EQ(inches.unit, "in");
}

TEST(ThreeMf, TransformsAreOfRowVectors) {
  // x -> y -> z -> x, then a shift: not symmetric, so that a transposed matrix is seen.
  const ReadResult r = read(
      three_mf(model("", object(1, kPart), item(1, R"(transform="0 1 0 0 0 1 1 0 0 10 20 30")"))));
  EXPECT_EQ(soup(r.mesh)[0], Vec3(10, 20, 30));
  EXPECT_EQ(soup(r.mesh)[1], Vec3(10, 20, 31));  // (0, 1, 0)
  EXPECT_EQ(soup(r.mesh)[2], Vec3(10, 21, 30));  // (1, 0, 0)
  const ReadResult mirrored = read(
      three_mf(model("", object(1, kPart), item(1, R"(transform="-1 0 0 0 1 0 0 0 1 0 0 0")"))));
  EXPECT_EQ(soup(mirrored.mesh)[0], Vec3(-1, 0, 0));
  EXPECT_TRUE(has_note(mirrored, "mirror"));
}

TEST(ThreeMf, Components) {
  const ReadResult r = read(three_mf(model(
      "",
      object(1, kPart) +
          object(2,
                 R"(<components><component objectid="1"/>)"
                 R"(<component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/></components>)"),
      item(2, R"(transform="1 0 0 0 1 0 0 0 1 0 7 0")"))));
  ASSERT_EQ(r.mesh.triangles.size(), 8U);
  EXPECT_EQ(soup(r.mesh)[0], Vec3(0, 7, 0));
  EXPECT_EQ(soup(r.mesh)[12], Vec3(5, 7, 0));
}

TEST(ThreeMf, ProductionExtensionReadsOtherParts) {
  // The same object number in both files: the path decides which one is meant.
  const std::string other = model("", object(1, three_mf_mesh("3")), "");
  for (const char* required : {"", R"(requiredextensions="p")"}) {
    const std::string attributes = kProductionSpace + " " + required;
    const ReadResult by_component = read(three_mf(
        model(
            attributes,
            object(1, kPart) + object(2, R"(<components><component objectid="1"/><component )"
                                         R"(p:path="/3D/Other.model" objectid="1"/></components>)"),
            item(2)),
        {{"3D/other.model", other}}));
    EXPECT_EQ(by_component.mesh.triangles.size(), 8U);
    EXPECT_EQ(soup(by_component.mesh)[12], Vec3(3, 0, 0));
    const ReadResult by_item =
        read(three_mf(model(attributes, object(1, kPart), item(1, R"(p:path="/3D/other.model")")),
                      {{"3D/other.model", other}}));
    EXPECT_EQ(soup(by_item.mesh)[0], Vec3(3, 0, 0));
    EXPECT_TRUE(has_note(by_item, "1 object that the build does not show"));
  }
  EXPECT_TRUE(has_note(read(three_mf(kOne, {{"3D/other.model", other}})), "1 model file"));
  const std::string shown = model(kProductionSpace, "", item(1, R"(p:path="/3D/other.model")"));
  expect_refused(three_mf(shown), {"/3D/other.model"});
  expect_refused(
      three_mf(shown, {{"3D/other.model", replaced(other, "<model", "<model unit=\"inch\"")}}),
      {"other.model", "unit", "inch"});
  expect_refused(three_mf(shown, {{"3D/other.model",
                                   model(kProductionSpace,
                                         object(1, R"(<components><component objectid="1" )"
                                                   R"(p:path="/3D/3dmodel.model"/></components>)"),
                                         "")}}),
                 {"path", "line 2"});
}

TEST(ThreeMf, NamespacesDecideNotPrefixes) {
  std::string text = kOne;
  for (const char* name : {"model", "resources", "object", "mesh", "vertices", "vertex",
                           "triangles", "triangle", "build", "item"})
    for (const std::string before : {"<", "</"})
      for (const char* after : {" ", ">"}) {
        std::string found = before;
        found.append(name).append(after);
        for (std::size_t at = 0; (at = text.find(found, at)) != std::string::npos;)
          text.insert(at + before.size(), "c:");
      }
  text = replaced(text, "xmlns=", "xmlns:c=");
  EXPECT_EQ(read(three_mf(text)).mesh.triangles.size(), 4U);
  expect_refused(three_mf(replaced(kOne, "core/2015/02", "core/2099/01")), {"namespace"});
}

TEST(ThreeMf, ExtensionsThatMayHoldGeometryAreRefused) {
  const std::string base = "http://schemas.microsoft.com/3dmanufacturing/";
  const auto declared = [&](const std::string& name, const std::string& more = "") {
    return "xmlns:x=\"" + base + name + "\" " + more;
  };
  for (const char* name : {"slice/2015/07", "beamlattice/2017/02", "volumetric/2022/01",
                           "booleans/2023/07", "displacement/2022/07", "securecontent/2019/04"})
    expect_refused(
        three_mf(model(declared(name, R"(requiredextensions="x")"), object(1, kPart), item(1))),
        {"required extension", name});
  expect_refused(three_mf(model(R"(requiredextensions="q")", object(1, kPart), item(1))), {"'q'"});
  const auto in_mesh = [&](const std::string& more) {
    return three_mf(model(declared("beamlattice/2017/02"),
                          object(1, replaced(kPart, "</mesh>", more + "</mesh>")), item(1)));
  };
  expect_refused(in_mesh("<x:beamlattice/>"), {"<x:beamlattice>"});
  expect_refused(three_mf(model(declared("slice/2015/07"),
                                object(1, kPart, R"(x:slicestackid="2")"), item(1))),
                 {"x:slicestackid"});
  expect_refused(
      three_mf(model(declared("booleans/2023/07"), object(1, "<x:booleanshape/>"), item(1))),
      {"booleanshape"});
  expect_refused(three_mf(model(declared("volumetric/2022/01"),
                                "<x:function id=\"4\"/>" + object(1, kPart), item(1))),
                 {"x:function"});
  // Colours, triangle sets and metadata hold none.
  EXPECT_NO_THROW(read(three_mf(
      model("xmlns:m=\"" + base + "material/2015/02\" xmlns:t=\"" + base +
                "trianglesets/2021/07\" requiredextensions=\"m t\"",
            "<basematerials id=\"7\"/><m:colorgroup id=\"8\"><m:color "
            "color=\"#FF0000\"/></m:colorgroup>" +
                object(1, "<metadatagroup><metadata name=\"a\">b</metadata></metadatagroup>" +
                              replaced(kPart, "</mesh>", "<t:trianglesets/></mesh>")),
            item(1)))));
}

TEST(ThreeMf, TypesOfObjects) {
  const auto typed = [&](const std::string& type) {
    return three_mf(model("", object(1, kPart, "type=\"" + type + "\""), item(1)));
  };
  EXPECT_NO_THROW(read(typed("model")));
  EXPECT_NO_THROW(read(typed("surface")));
  EXPECT_TRUE(has_note(read(typed("support")), "support"));
  EXPECT_TRUE(has_note(read(typed("solidsupport")), "support"));
  expect_refused(typed("other"), {"'other'"});
  expect_refused(typed("magic"), {"'magic'"});
}

TEST(ThreeMf, Damaged) {
  expect_refused("this is no zip", {"zip"});
  expect_refused(package({{"a", "b"}}), {"_rels/.rels"});
  expect_refused(three_mf("<x/>"), {"3D/3dmodel.model", "namespace"});
  expect_refused(three_mf("<model"), {"well-formed"});
  expect_refused(three_mf(model("", object(1, kPart), "")), {"no triangles"});
  expect_refused(three_mf(model("", object(1, kPart), item(2))), {"object 2"});
  expect_refused(three_mf(model("", object(1, kPart) + object(1, kPart), item(1))), {"second"});
  expect_refused(three_mf(replaced(kOne, "v3=\"1\"", "v3=\"4\"")), {"vertex 4", "there are 4"});
  expect_refused(three_mf(replaced(kOne, "z=\"0.1\"", "z=\"0,1\"")), {"line 2", "'0,1'"});
  expect_refused(three_mf(replaced(kOne, "z=\"0.1\"", "z=\"nan\"")), {"finite"});
  expect_refused(three_mf(replaced(kOne, "z=\"0.1\"", "")), {"'z'"});
  expect_refused(three_mf(replaced(kOne, "z=\"0.1\"", "z=\"0.1\" z=\"5\"")), {"well-formed"});
  expect_refused(three_mf(replaced(kOne, "<triangles>", "<triangles>text")), {"'text'"});
  expect_refused(three_mf(replaced(kOne, "<triangles>", "<triangles><quad/>")), {"<quad>"});
  for (const char* bad : {"1 0 0 0 1 0 0 0 1 0 0", "1 0 0 0 1 0 0 0 1 0 0 0 0", "a"})
    expect_refused(
        three_mf(model("", object(1, kPart), item(1, "transform=\"" + std::string(bad) + "\""))),
        {"line 2"});
  expect_refused(three_mf(replaced(kOne, "?>", "?><!DOCTYPE m [<!ENTITY a \"b\">]>")),
                 {"declarations"});
  // Two parts that other programs take for the same.
  expect_refused(three_mf(kOne, {{"3d/3DMODEL.model", kOne}}), {"two parts"});
}

TEST(ThreeMf, DamagedBytesOfAPartAreSeen) {
  const std::string good = three_mf(kOne);
  std::size_t refused = 0, tried = 0;
  // Stored after the local header of the third part; every byte of its data is under the checksum.
  for (std::size_t at = good.find("3D/3dmodel.model") + 16; at < good.find("PK\1\2"); ++at) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 4);
    ++tried;
    try {
      read(bad);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::InvalidInput) << e.what();
      ++refused;
    }
  }
  EXPECT_GT(tried, 100U);
  EXPECT_EQ(refused, tried);
}

TEST(ThreeMf, NestingAndSizesAreLimited) {
  const auto twice = [](int id) {
    const std::string c = "<component objectid=\"" + std::to_string(id) + "\"/>";
    return "<components>" + c + c + "</components>";
  };
  expect_error(three_mf(model("", object(1, twice(1)), item(1))), Format::ThreeMf, {"nested"});
  for (const std::string& leaf : {kPart, std::string("<mesh><vertices/><triangles/></mesh>")}) {
    std::string objects = object(0, leaf);
    for (int i = 1; i < 60; ++i) objects += object(i, twice(i - 1));
    expect_error(three_mf(model("", objects, item(59))), Format::ThreeMf, {"repeat"},
                 ErrorCode::LimitReached);
  }
  std::string spaces(8'000'000, ' ');
  for (int i = 0; i < 2; ++i) spaces += std::string(spaces);
  const std::string bomb = three_mf(spaces);
  EXPECT_LT(bomb.size(), 200'000U);
  expect_error(bomb, Format::ThreeMf, {"inflates"}, ErrorCode::LimitReached);
}

}  // namespace
}  // namespace kaboum::io::test

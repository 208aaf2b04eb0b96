// Units of length: what is scaled is each product's nearest double, and says so; two units are not
// compared.

#include <kaboum/io/convex_io.h>
#include <kaboum/io/file_unit.h>

#include <cmath>
#include <limits>
#include <random>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

ReadResult result_of(Mesh mesh, const std::string& unit = "") {
  ReadResult r;
  r.mesh = std::move(mesh);
  r.format = Format::Off;
  r.unit = unit;
  return r;
}

TEST(FileUnit, EveryCoordinateIsTheProductRoundedOnce) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double factor : {0.001, 25.4, 0.0254, 1e-9, 1e9, 3.0}) {
    Mesh mesh = tetrahedron();
    for (Vec3& v : mesh.vertices) v = Vec3(unit(random), unit(random), unit(random)) * 1e3;
    ReadResult r = result_of(mesh);
    scale(r, factor, "sample");
    ASSERT_EQ(r.mesh.triangles.size(), 4U);
    const std::vector<Vec3> before = soup(mesh), after = soup(r.mesh);
    for (std::size_t i = 0; i < before.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        // The error of the product is a double: no neighbour is nearer.
        const double error = std::fma(before[i][k], factor, -after[i][k]);
        const double up = std::nextafter(after[i][k], HUGE_VAL),
                     down = std::nextafter(after[i][k], -HUGE_VAL);
        EXPECT_LE(std::abs(error), std::abs(std::fma(before[i][k], factor, -up)));
        EXPECT_LE(std::abs(error), std::abs(std::fma(before[i][k], factor, -down)));
      }
    EXPECT_TRUE(has_note(r, "multiplied by"));
  }
}

TEST(FileUnit, OneChangesNothing) {
  ReadResult r = result_of(tetrahedron(), "mm");
  r.single_precision = true;
  scale(r, 1, "sample");
  EXPECT_TRUE(r.notes.empty());
  EXPECT_TRUE(r.single_precision);
  EXPECT_EQ(r.unit, "mm");
}

// Rounding maps neighbours to one double where the product's binade is coarser.
TEST(FileUnit, VerticesThatBecomeEqualAreMerged) {
  Mesh mesh = tetrahedron();
  const double a = std::nextafter(2.0, 0), b = std::nextafter(a, 0);  // times 1 / 1.9: both above 1
  double factor = 0;
  for (double f = 0.5; f < 0.6 && factor == 0; f += 1e-4)
    if (f * a == f * b && f * a > 1) factor = f;
  ASSERT_GT(factor, 0);
  mesh.vertices[1].x() = a;
  mesh.vertices.push_back(Vec3(b, 0, 0));
  mesh.triangles.push_back({1, 4, 2});
  ReadResult r = result_of(mesh);
  scale(r, factor, "sample");
  EXPECT_EQ(r.mesh.vertices.size(), 4U);
  EXPECT_EQ(r.mesh.triangles.size(), 4U);
  EXPECT_EQ(r.collapsed_triangles, 1U);
  EXPECT_TRUE(is_closed_chain(r.mesh));
}

TEST(FileUnit, RefusesWhatIsNoFactorAndWhatLeavesTheRange) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    ReadResult r = result_of(tetrahedron());
    EXPECT_THROW(scale(r, bad, "sample"), Error) << bad;
  }
  for (const auto& [size, factor] : {std::pair{1e305, 1e6}, std::pair{1e-305, 1e-6}}) {
    Mesh mesh = tetrahedron();
    mesh.vertices[1].x() = size;
    ReadResult r = result_of(mesh);
    try {
      scale(r, factor, "sample");
      ADD_FAILURE() << size;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::InvalidInput);
      EXPECT_NE(std::string(e.what()).find("sample: its coordinate"), std::string::npos);
    }
  }
}

TEST(FileUnit, StatedUnitsBecomeThoseOfTheProducts) {
  const auto scaled = [](const char* unit, double factor) {
    ReadResult r = result_of(tetrahedron(), unit);
    scale(r, factor, "sample");
    return r.unit;
  };
  EXPECT_EQ(scaled("mm", 0.001), "m");
  EXPECT_EQ(scaled("in", 25.4), "mm");
  EXPECT_EQ(scaled("m", 100), "cm");
  EXPECT_EQ(scaled("0.005 m", 5), "mm");
  EXPECT_EQ(scaled("m", 200), "0.005 m");
  EXPECT_EQ(scaled("", 0.001), "");
}

TEST(FileUnit, NamesAndMetres) {
  for (const char* name : {"m", "dm", "cm", "mm", "um", "km", "in", "ft"})
    EXPECT_EQ(unit_of_metres(metres_of(name).value()), name);
  EXPECT_EQ(metres_of("0.005 m"), 0.005);
  for (const char* bad : {"", "parsec", "0 m", "-1 m", "nan m", "1 mm", " m", "1e999 m"})
    EXPECT_FALSE(metres_of(bad).has_value()) << bad;
  // Digits that give the number back.
  for (const double metres : {1.0 / 3, 1e-9, 0.0254 / 3, 123456789.125, 0.001 * (1 + 1e-13)})
    EXPECT_EQ(metres_of(unit_of_metres(metres)), metres) << unit_of_metres(metres);
  EXPECT_EQ(unit_of_metres(1e-9), "1e-09 m");
}

// Rounding of one product and one quotient hides no name.
TEST(FileUnit, NamesOfQuotients) {
  std::mt19937_64 random(3);
  for (const char* name : {"m", "dm", "cm", "mm", "um", "km", "in", "ft"}) {
    const double metres = metres_of(name).value();
    for (const char* other : {"m", "dm", "cm", "mm", "um", "km", "in", "ft"})
      EXPECT_EQ(unit_of_metres(metres / (metres / metres_of(other).value())), other);
    for (int round = 0; round < 1000; ++round) {
      const double factor = static_cast<double>(1 + random() % 100'000) / 1000;
      EXPECT_EQ(unit_of_metres(metres * factor / factor), name) << factor;
      EXPECT_EQ(unit_of_metres(metres / (1 / factor) / factor), name) << factor;
    }
    EXPECT_NE(unit_of_metres(metres * (1 + 1e-14)), name);
  }
}

// The triangles of a CAD file, scaled, stand for faces that are within the scaled deviation.
TEST(FileUnit, ScaledBoundsHold) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 1000; ++round) {
    const double factor =
        std::ldexp(1 + std::abs(unit(random)), static_cast<int>(random() % 20) - 10);
    Mesh mesh = tetrahedron();
    for (Vec3& v : mesh.vertices) v = Vec3(unit(random), unit(random), unit(random)) * 1e4;
    ReadResult r = result_of(mesh);
    scale(r, factor, "sample");
    const double bound = std::abs(unit(random)) * 1e-12;
    const double allowed = scaled_bound(bound, factor, r.mesh);
    EXPECT_GE(allowed, bound * factor);
    // What rounding has moved a vertex by, in long double, is within the rest.
    const std::vector<Vec3> before = soup(mesh), after = soup(r.mesh);
    for (std::size_t i = 0; i < before.size(); ++i) {
      long double squared = 0;
      for (int k = 0; k < 3; ++k) {
        const long double d = static_cast<long double>(before[i][k]) * factor - after[i][k];
        squared += d * d;
      }
      EXPECT_LE(std::sqrt(squared) + static_cast<long double>(bound) * factor, allowed);
    }
  }
}

TEST(FileUnit, RecordsOfScales) {
  EXPECT_EQ(recorded_scale("--epsilon 1% --scale 0.001 --effort fast"), 0.001);
  EXPECT_EQ(recorded_scale("bmesh-decimate 0.1.0 --scale 25.4"), 25.4);
  EXPECT_EQ(recorded_scale("--epsilon 1%"), 1);
  EXPECT_EQ(recorded_scale("--scale 1e-09"), 1e-9);
  EXPECT_NO_THROW(require_recorded_scale("a.glb", "--scale 0.001", 0.001));
  EXPECT_THROW(require_recorded_scale("a.glb", "--scale 0.001", 1), Error);
  EXPECT_THROW(require_recorded_scale("a.glb", "", 0.001), Error);
  // What cannot be understood is not taken for 1.
  for (const char* bad :
       {"--scale", "--epsilon 1% --scale --effort", "--scale x", "--scale nan", "--scale inf",
        "--scale 0", "--scale -1", "--scale 1x", "--scale 0x1p3", "--scale 1e999"}) {
    EXPECT_THROW(recorded_scale(bad), Error) << bad;
    try {
      require_recorded_scale("a.glb", bad, 1);
      ADD_FAILURE() << bad;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::InvalidInput);
      EXPECT_NE(std::string(e.what()).find("a.glb: its record says a scale of"), std::string::npos)
          << e.what();
    }
  }
}

TEST(FileUnit, TwoUnitsAreNotCompared) {
  EXPECT_NO_THROW(require_same_unit("a", "mm", "b", "mm"));
  EXPECT_NO_THROW(require_same_unit("a", "", "b", "mm"));
  EXPECT_NO_THROW(require_same_unit("a", "mm", "b", ""));
  try {
    require_same_unit("a.3mf", "mm", "b.glb", "m");
    ADD_FAILURE();
  } catch (const Error& e) {
    for (const char* part : {"a.3mf is in mm", "b.glb in m", "«scale=0.001»"})
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
  // Two roundings of one unit are one.
  EXPECT_NO_THROW(require_same_unit("a", "0.005 m", "b", "0.005000000000000001 m"));
  EXPECT_THROW(require_same_unit("a", "0.005 m", "b", "0.00500000000001 m"), Error);
}

// Who does as the message says is not refused again.
TEST(FileUnit, TheFactorThatIsNamedMakesUnitsAlike) {
  for (const double metres : {0.0254 / 3, 1.0 / 3, 0.3048 / 7, 1e-9, 0.005, 123.456789})
    for (const char* other : {"mm", "in", "m", "0.007 m"}) {
      ReadResult r = result_of(tetrahedron(), unit_of_metres(metres));
      try {
        require_same_unit("a", r.unit, "b", other);
        ADD_FAILURE() << r.unit;
      } catch (const Error& e) {
        const std::string text = e.what();
        const std::size_t at = text.find("«scale=") + std::string("«scale=").size();
        const double factor = std::stod(text.substr(at, text.find("»", at) - at));
        scale(r, factor, "a");
        EXPECT_NO_THROW(require_same_unit("a", r.unit, "b", other)) << text;
      }
    }
}

// What a GLB of ours was made of need not be metres; of other programs it is.
TEST(FileUnit, OfGlb) {
  const std::vector<char> bytes = serialise_mesh(tetrahedron(), Format::Glb);
  std::string text(bytes.begin(), bytes.end());
  EXPECT_EQ(parse(text, Format::Glb).unit, "");
  SetReadDetails details;
  parse_convex_set(text, Format::Glb, "sample", &details);
  EXPECT_EQ(details.unit, "");
  text.replace(text.find("KABouM"), 6, "Blende");
  EXPECT_EQ(parse(text, Format::Glb).unit, "m");
  parse_convex_set(text, Format::Glb, "sample", &details);
  EXPECT_EQ(details.unit, "m");
}

}  // namespace
}  // namespace kaboum::io::test

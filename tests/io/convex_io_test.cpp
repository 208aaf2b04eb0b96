#include <kaboum/io/convex_folder.h>
#include <kaboum/io/convex_io.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

namespace fs = std::filesystem;
using geom::ConvexSet;

ConvexSet parse_set(std::string_view bytes, Format format, SetReadDetails* details = nullptr) {
  return parse_convex_set({bytes.data(), bytes.size()}, format, "sample", details);
}

std::string written(const ConvexSet& set, SetFormat format) {
  const std::vector<char> bytes = serialise_convex_set(set, format);
  return {bytes.begin(), bytes.end()};
}

/// Bodies far apart and touching, with awkward but float32 coordinates.
ConvexSet sample_set(int bodies, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  ConvexSet set;
  for (int i = 0; i < bodies; ++i) {
    Mesh hull = tetrahedron();
    for (Vec3& p : hull.vertices)
      for (double& x : p)
        x = static_cast<double>(
            static_cast<float>(std::ldexp(x + 0.1 * unit(random), i % 40 - 20)));
    set.bodies.push_back({"part " + std::to_string(i), hull});
  }
  set_margin(set, 0.1);  // no float32 number
  set.provenance = {"a \"quoted\" name.stl",
                    std::string(64, 'a'),
                    "tool 1.0",
                    "--epsilon 1%",
                    "mm",
                    "link_3",
                    "outer",
                    1.0 / 3,
                    true,
                    false};
  return set;
}

void expect_same(const ConvexSet& a, const ConvexSet& b) {
  ASSERT_EQ(a.bodies.size(), b.bodies.size());
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    EXPECT_EQ(a.bodies[i].core.triangles.size(), b.bodies[i].core.triangles.size());
    EXPECT_EQ(soup(a.bodies[i].core), soup(b.bodies[i].core)) << i;
  }
}

class ConvexIo : public ::testing::Test {
 protected:
  ConvexIo()
      : directory_(fs::path(::testing::TempDir()) / ("kaboum-sets-" + std::to_string(::getpid()))) {
    fs::create_directories(directory_);
  }
  ~ConvexIo() override { fs::remove_all(directory_); }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory_), {}));
  }
  fs::path directory_;
};

void expect_set_error(const std::string& bytes, Format format, const std::string& part) {
  try {
    parse_set(bytes, format);
    ADD_FAILURE() << "no error instead of '" << part << "'";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::InvalidInput);
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    EXPECT_TRUE(std::string_view(e.what()).starts_with("sample")) << e.what();
  }
}

/// A polytope, an enlarged one, a capsule's core and a ball's.
ConvexSet rounded_set() {
  ConvexSet set = sample_set(2, 3);
  set_margin(set, 0);
  set.bodies[1].radius = 0.1;  // no float32 number
  set.bodies.push_back({"capsule", {{{0, 0, 0.5}, {1, 0, 0.25}}, {}}, 1.0 / 3});
  set.bodies.push_back({"ball", {{{0.125, 2, -3}}, {}}, 1e-3});
  return set;
}

TEST_F(ConvexIo, RadiiAndCoresRoundTrip) {
  const ConvexSet set = rounded_set();
  const std::string bytes = written(set, SetFormat::Glb);
  SetReadDetails details;
  const ConvexSet back = parse_set(bytes, Format::Glb, &details);
  expect_same(back, set);
  for (std::size_t i = 0; i < set.bodies.size(); ++i) {
    EXPECT_EQ(back.bodies[i].name, set.bodies[i].name);
    EXPECT_EQ(back.bodies[i].radius, set.bodies[i].radius);
  }
  for (const std::size_t i : {2U, 3U}) {
    EXPECT_EQ(back.bodies[i].core.vertices, set.bodies[i].core.vertices);
    EXPECT_TRUE(back.bodies[i].core.triangles.empty());
  }
  EXPECT_EQ(back.provenance, set.provenance);
  EXPECT_TRUE(details.notes.empty());
  EXPECT_EQ(written(back, SetFormat::Glb), bytes);
  // One radius is a margin, and the record is the one that older programs read.
  ConvexSet one = sample_set(2, 3);
  EXPECT_NE(written(one, SetFormat::Glb).find("\"version\":1,\"bodies\":2,\"margin\":0.1"),
            std::string::npos);
  EXPECT_NE(bytes.find("\"version\":2,\"bodies\":4,\"radii\":[0.0,0.1,"), std::string::npos);
}

TEST_F(ConvexIo, DamagedRadiiAreRefused) {
  const std::string bytes = written(rounded_set(), SetFormat::Glb);
  const auto with = [&](const std::string& from, std::string to) {
    std::string out = bytes;
    const std::size_t at = out.find(from);
    EXPECT_NE(at, std::string::npos);
    to.resize(from.size(), ' ');
    return out.replace(at, from.size(), to);
  };
  expect_set_error(with("\"radii\":[0.0,0.1,", "\"radii\":[0.0,"), Format::Glb, "one radius");
  expect_set_error(with("\"radii\":[0.0,0.1,", "\"radii\":[0,-0.1,"), Format::Glb, "negative");
  expect_set_error(with("\"radii\"", "\"radix\""), Format::Glb, "damaged");
  expect_set_error(with("0.001]", "0]"), Format::Glb, "without a radius");
  expect_set_error(with("\"version\":2", "\"version\":3"), Format::Glb, "version");
  // Without their radii, points are not bodies.
  expect_set_error(with("\"version\":2", "\"version\":1"), Format::Glb, "");
}

TEST_F(ConvexIo, RadiiAreNotLostInOtherFormats) {
  const ConvexSet set = rounded_set();
  EXPECT_THROW(written(set, SetFormat::Obj), Error);
  EXPECT_THROW(write_convex_set(directory_ / "set", set), Error);
  EXPECT_THROW(parse_mesh(serialise_convex_set(set, SetFormat::Glb), Format::Glb, "sample"), Error);
  ConvexSet bad = set;
  bad.bodies[3].radius = 0;
  EXPECT_THROW(written(bad, SetFormat::Glb), Error);
  bad = set;
  bad.bodies[2].core.vertices.emplace_back(1, 2, 3);
  EXPECT_THROW(written(bad, SetFormat::Glb), Error);
}

TEST_F(ConvexIo, ContainerRoundTrip) {
  for (const int bodies : {0, 1, 2, 57}) {
    const ConvexSet set = sample_set(bodies, 7);
    const std::string bytes = written(set, SetFormat::Glb);
    SetReadDetails details;
    const ConvexSet back = parse_set(bytes, Format::Glb, &details);
    expect_same(back, set);
    for (int i = 0; i < bodies; ++i) EXPECT_EQ(back.bodies[i].name, set.bodies[i].name);
    EXPECT_EQ(margin_of(back).value(), margin_of(set).value());
    EXPECT_EQ(back.provenance, set.provenance);
    EXPECT_TRUE(details.has_record);
    EXPECT_TRUE(details.notes.empty());
    EXPECT_EQ(written(back, SetFormat::Glb), bytes);
  }
}

TEST_F(ConvexIo, ContainerIsAValidMeshFileForOthers) {
  ConvexSet set = sample_set(5, 3);
  set_margin(set, 0);
  const std::vector<char> bytes = serialise_convex_set(set, SetFormat::Glb);
  ASSERT_EQ(bytes.size() % 4, 0U);
  const ReadResult mesh = parse_mesh(bytes, Format::Glb, "container");
  std::vector<Vec3> all;
  for (const geom::ConvexBody& body : set.bodies)
    for (const Vec3& p : soup(body.core)) all.push_back(p);
  EXPECT_EQ(soup(mesh.mesh), all);
}

TEST_F(ConvexIo, ObjRoundTripKeepsDoubles) {
  ConvexSet set = sample_set(4, 5);
  set_margin(set, 0);
  set.bodies[1].core.vertices[0].x() = 1.0 / 3;
  set.bodies[2].name = "with # and \\";
  const std::string bytes = written(set, SetFormat::Obj);
  const ConvexSet back = parse_set(bytes, Format::Obj);
  expect_same(back, set);
  EXPECT_EQ(back.bodies[0].name, "part_0");
  // One body: no groups to tell apart, but one component.
  set.bodies.resize(1);
  expect_same(parse_set(written(set, SetFormat::Obj), Format::Obj), set);
}

TEST_F(ConvexIo, FolderRoundTrip) {
  ConvexSet set = sample_set(12, 9);
  set_margin(set, 0);
  const fs::path path = directory_ / "set";
  write_convex_set(path, set);
  SetReadDetails details;
  const ConvexSet back = read_convex_set(path, {}, &details);
  expect_same(back, set);
  EXPECT_EQ(back.provenance, set.provenance);
  EXPECT_EQ(back.bodies[11].name, "body-0011");
  // Replaced by a smaller set: nothing of the old one stays.
  set.bodies.resize(3);
  write_convex_set(path, set);
  expect_same(read_convex_set(path), set);
  EXPECT_EQ(entries(), 1U);
  // A missing body is noticed.
  fs::remove(path / "body-0001.stl");
  EXPECT_THROW(read_convex_set(path), Error);
  // Folders with other things in them are left alone.
  std::ofstream(path / "thesis.tex") << "x";
  EXPECT_THROW(write_convex_set(path, set), Error);
  EXPECT_TRUE(fs::exists(path / "thesis.tex"));
  EXPECT_EQ(entries(), 1U);
  EXPECT_THROW(write_convex_set(directory_ / "none" / "set", set), Error);
}

TEST_F(ConvexIo, FolderOfManyWritersIsOneOfTheirs) {
  const fs::path place = directory_ / "set";
  std::vector<std::thread> writers;
  for (int w = 0; w < 4; ++w)
    writers.emplace_back([&, w] {
      ConvexSet set = sample_set(2 + 3 * w, static_cast<unsigned>(w));
      set_margin(set, 0);
      for (int round = 0; round < 25; ++round) write_convex_folder(place, set, "part", Format::Stl);
    });
  for (std::thread& t : writers) t.join();
  const ConvexSet back = read_convex_set(place);  // whose record counts the bodies
  EXPECT_EQ((back.bodies.size() - 2) % 3, 0U);
  EXPECT_EQ(entries(), 1U);
}

TEST_F(ConvexIo, RecordOfAFolderThatIsNestedTooDeepIsRefused) {
  const fs::path place = directory_ / "set";
  ConvexSet set = sample_set(2, 1);
  set_margin(set, 0);
  write_convex_folder(place, set, "part", Format::Stl);
  const std::string name = (place / "convex-set.json").string();
  std::vector<char> bytes = read_file(name);
  std::string record(bytes.begin(), bytes.end());
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  record.replace(record.find("\"bodies\": 2"), 11, "\"bodies\": " + deep);
  write_file(name, record);
  EXPECT_THROW(read_convex_set(place), Error);
}

/// From here on this process cannot exchange two names in one step, as on file systems that lack
/// it. False: nor can that be arranged.
bool forbid_exchange() {
  constexpr std::uint32_t kOffset = offsetof(seccomp_data, args) + 4 * sizeof(std::uint64_t);
  std::array<sock_filter, 6> filter{
      {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
       BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_renameat2, 0, 3),
       BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kOffset),  // of the flags, on little-endian machines
       BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, RENAME_EXCHANGE, 0, 1),
       BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EINVAL),
       BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)}};
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return std::endian::native == std::endian::little &&
         ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// What `run` returns in a child process.
int in_child(const std::function<int()>& run) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(run());
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status);
}

// Where names cannot be exchanged, what is replaced is put aside: under no name that another
// machine's process of the same number has made.
TEST_F(ConvexIo, FolderIsReplacedInTwoSteps) {
  constexpr int kUnarranged = 77, kNames = 500;
  const fs::path place = directory_ / "set";
  ConvexSet set = sample_set(5, 1);
  set_margin(set, 0);
  write_convex_set(place, set);
  const int result = in_child([&] {
    if (!forbid_exchange()) return kUnarranged;
    const std::string start = ".kaboum-new-" + std::to_string(::getpid()) + "-";
    for (int i = 1; i < kNames; i += 2)
      fs::create_directory(directory_ / (start + std::to_string(i) + ".tmp"));
    set.bodies.resize(2);
    try {
      write_convex_set(place, set);
    } catch (const Error& e) {
      std::cerr << e.what() << '\n';
      return 1;
    }
    return 0;
  });
  if (result == kUnarranged) GTEST_SKIP() << "system calls cannot be filtered here";
  EXPECT_EQ(result, 0);
  EXPECT_EQ(entries(), 1U + kNames / 2);
  EXPECT_EQ(read_convex_set(place).bodies.size(), 2U);
}

TEST_F(ConvexIo, FolderBehindALink) {
  ConvexSet set = sample_set(5, 1);
  set_margin(set, 0);
  const fs::path place = directory_ / "set", link = directory_ / "link",
                 astray = directory_ / "astray";
  write_convex_set(place, set);
  fs::create_directory_symlink("set", link);
  set.bodies.resize(2);
  write_convex_set(link, set, SetFormat::Directory);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_convex_set(place).bodies.size(), 2U);
  // What is no folder is not replaced.
  fs::create_symlink("nowhere", astray);
  EXPECT_THROW(write_convex_set(astray, set, SetFormat::Directory), Error);
  EXPECT_TRUE(fs::is_symlink(astray));
  EXPECT_EQ(entries(), 3U);
}

TEST_F(ConvexIo, FolderInNaturalOrder) {
  for (const char* name : {"hull10.stl", "hull9.STL", "hull1.stl", "note.txt"}) {
    Mesh mesh = tetrahedron();
    mesh.vertices[3].z() = std::string_view(name).starts_with("hull10") ? 10 : 1;
    write_file(directory_ / name, serialise_mesh(mesh, Format::Stl));
  }
  const ConvexSet set = read_convex_set(directory_);
  ASSERT_EQ(set.bodies.size(), 3U);
  EXPECT_EQ(set.bodies[0].name, "hull1");
  EXPECT_EQ(set.bodies[1].name, "hull9");
  EXPECT_EQ(set.bodies[2].name, "hull10");
  EXPECT_EQ(geom::bounding_box(set.bodies[2].core).max.z(), 10);
}

TEST_F(ConvexIo, PlainMeshesFallIntoComponents) {
  const ConvexSet set = sample_set(6, 1);
  Mesh all;
  for (const geom::ConvexBody& body : set.bodies) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), body.core.vertices.begin(), body.core.vertices.end());
    for (const Triangle& t : body.core.triangles)
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  for (const Format format : {Format::Stl, Format::Ply, Format::Off, Format::Obj, Format::Glb}) {
    SetReadDetails details;
    const std::vector<char> bytes = serialise_mesh(all, format);
    const ConvexSet back = parse_convex_set(bytes, format, "plain", &details);
    if (format == Format::Glb) {  // one mesh is one body
      EXPECT_EQ(back.bodies.size(), 1U);
    } else {
      expect_same(back, set);
    }
    EXPECT_FALSE(details.has_record);
    EXPECT_EQ(margin_of(back).value(), 0);
  }
}

TEST_F(ConvexIo, ObjGroups) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const ConvexSet set =
      parse_set(vertices + "g a\ng b\nf 1 2 3\ng b\nf -1 -2 -3\no c\n", Format::Obj);
  ASSERT_EQ(set.bodies.size(), 2U);  // every statement begins a body; empty ones do not count
  EXPECT_EQ(set.bodies[0].name, "b");
  EXPECT_EQ(soup(set.bodies[1].core),
            (std::vector<Vec3>{Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(1, 0, 0)}));
  EXPECT_TRUE(geom::find_not_convex(set).has_value());  // read nevertheless
  expect_set_error(vertices + "o a\nf 1 2 3\no b\nf 1 1 2\n", Format::Obj, "equal corners");
  expect_set_error(vertices + "o a\nf 1 2 3\no b\nf 1 2 9\n", Format::Obj, "vertex 9");
}

TEST_F(ConvexIo, WhatCannotBeWritten) {
  const auto code_of = [](const ConvexSet& set, SetFormat format) {
    try {
      serialise_convex_set(set, format);
    } catch (const Error& e) {
      return e.code();
    }
    return ErrorCode::Internal;
  };
  ConvexSet set = sample_set(2, 1);
  EXPECT_EQ(code_of(set, SetFormat::Obj), ErrorCode::OutputFailed);  // margin
  EXPECT_THROW(write_convex_set(directory_ / "set", set), Error);
  EXPECT_EQ(entries(), 0U);
  EXPECT_THROW(write_convex_set(directory_ / "set.step", set), Error);
  set_margin(set, -1);
  EXPECT_EQ(code_of(set, SetFormat::Glb), ErrorCode::InvalidArgument);
  set_margin(set, 0);
  set.bodies[1].core.vertices[2].y() = 0.1;  // no float32 number
  EXPECT_EQ(code_of(set, SetFormat::Glb), ErrorCode::OutputFailed);
  set.bodies[1].core.triangles[0][1] = 99;
  EXPECT_EQ(code_of(set, SetFormat::Obj), ErrorCode::InvalidArgument);
  set.bodies.clear();
  EXPECT_EQ(code_of(set, SetFormat::Obj), ErrorCode::InvalidArgument);
}

/// The container with its JSON part changed.
std::string with_json(const std::string& glb, const std::function<void(nlohmann::json&)>& change) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  nlohmann::json json = nlohmann::json::parse(glb.substr(20, length));
  change(json);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string rest = glb.substr(20 + length);
  std::string out = glb.substr(0, 8);
  append(out, static_cast<std::uint32_t>(20 + text.size() + rest.size()));
  append(out, static_cast<std::uint32_t>(text.size()));
  return out + glb.substr(16, 4) + text + rest;
}

TEST_F(ConvexIo, DamagedContainers) {
  const std::string good = written(sample_set(3, 2), SetFormat::Glb);
  const auto bad = [&](const char* part, const std::function<void(nlohmann::json&)>& change) {
    expect_set_error(with_json(good, change), Format::Glb, part);
  };
  EXPECT_NO_THROW(parse_set(with_json(good, [](auto&) {}), Format::Glb));
  bad("incomplete", [](auto& j) { j["scenes"][0]["nodes"].erase(1); });
  bad("margin", [](auto& j) { j["extras"]["kaboum_convex_set"]["margin"] = -1; });
  bad("record", [](auto& j) { j["extras"]["kaboum_convex_set"].erase("epsilon"); });
  bad("1e+300 bodies", [](auto& j) { j["extras"]["kaboum_convex_set"]["bodies"] = 1e300; });
  bad("version", [](auto& j) { j["extras"]["kaboum_convex_set"]["version"] = 3; });
  bad("accessors[0]: its 1000000", [](auto& j) { j["accessors"][0]["count"] = 1000000; });
  bad("accessors[0].count", [](auto& j) { j["accessors"][0]["count"] = -1; });
  bad("bufferViews[0]", [](auto& j) { j["bufferViews"][0]["byteOffset"] = 1U << 31U; });
  bad("accessors[0]: its min", [](auto& j) { j["accessors"][0]["count"] = 2; });
  bad("refers to vertex 2", [](auto& j) {
    j["accessors"][0]["count"] = 2;
    j["accessors"][0].erase("min");
    j["accessors"][0].erase("max");
  });
  bad("4 corners", [](auto& j) { j["accessors"][1]["count"] = 4; });
  bad("meshes[1]: 'primitives'", [](auto& j) { j["meshes"][1].erase("primitives"); });
  bad("number 77 of 3 meshes", [](auto& j) { j["nodes"][1]["mesh"] = 77; });
  bad("twice", [](auto& j) { j["nodes"][1]["children"] = {1}; });
  bad("no mesh", [](auto& j) {
    j.erase("extras");
    j["scenes"][0].erase("nodes");
  });
  // Many nodes that show the same data.
  std::string multiplied = with_json(good, [](auto& j) {
    for (int i = 0; i < 100000; ++i) j["scenes"][0]["nodes"].push_back(0);
  });
  EXPECT_THROW(parse_set(multiplied, Format::Glb), Error);
  // Without a record, transforms are applied.
  const std::string moved = with_json(good, [](auto& j) {
    j.erase("extras");
    j["nodes"][0]["translation"] = {0, 0, 4};
  });
  SetReadDetails details;
  EXPECT_EQ(parse_set(moved, Format::Glb, &details).bodies.size(), 3U);
  EXPECT_FALSE(details.notes.empty());
}

TEST_F(ConvexIo, HostileContainers) {
  ConvexSet set = sample_set(2, 4);
  const std::string glb = written(set, SetFormat::Glb);
  set_margin(set, 0);
  const std::string obj = written(set, SetFormat::Obj);
  const auto attempt = [](const std::string& bytes, Format format) {
    const std::vector<char> exact(bytes.begin(), bytes.end());
    try {
      const ConvexSet read = parse_convex_set(exact, format, "sample");
      for (const geom::ConvexBody& body : read.bodies) {
        ASSERT_FALSE(body.core.empty());
        for (const Triangle& t : body.core.triangles)
          for (const std::uint32_t c : t) ASSERT_LT(c, body.core.vertices.size());
        for (const Vec3& p : body.core.vertices) ASSERT_TRUE(p.allFinite());
      }
    } catch (const Error& e) {
      EXPECT_NE(e.code(), ErrorCode::Internal) << e.what();
    }
  };
  for (std::size_t n = 0; n < glb.size(); ++n) attempt(glb.substr(0, n), Format::Glb);
  for (std::size_t n = 0; n < obj.size(); ++n) attempt(obj.substr(0, n), Format::Obj);
  std::mt19937_64 random(1);
  for (int round = 0; round < 4000; ++round) {
    const Format format = round % 2 == 0 ? Format::Glb : Format::Obj;
    std::string bytes = format == Format::Glb ? glb : obj;
    for (std::size_t n = 1 + random() % 3; n > 0; --n) {
      const std::size_t at = random() % bytes.size();
      switch (random() % 4) {
        case 0:
          bytes[at] = static_cast<char>(random());
          break;
        case 1:
          bytes.erase(at, 1 + random() % 4);
          break;
        case 2:
          bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 16));
          break;
        default:
          bytes[at] = "0123456789-.e{}[]#\\\n \""[random() % 22];
      }
    }
    attempt(bytes, format);
  }
}

}  // namespace
}  // namespace kaboum::io::test

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

namespace fs = std::filesystem;

class Files : public ::testing::Test {
 protected:
  Files()
      : directory_(fs::path(::testing::TempDir()) /
                   ("kaboum-files-" + std::to_string(::getpid()))) {
    fs::create_directories(directory_);
  }
  ~Files() override { fs::remove_all(directory_); }

  static void write(const fs::path& path, std::string_view text) {
    write_file(path, {text.data(), text.size()});
  }
  static std::string content(const fs::path& path) {
    const std::vector<char> bytes = read_file(path);
    return {bytes.begin(), bytes.end()};
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory_), {}));
  }
  static std::string write_error(const fs::path& path) {
    try {
      write(path, "x");
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::OutputFailed);
      return e.what();
    }
    return "no error";
  }
  static std::string read_error(const fs::path& path, std::optional<Format> format = {}) {
    try {
      read_mesh(path, format);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::InvalidInput);
      return e.what();
    }
    return "no error";
  }

  fs::path directory_;
};

TEST_F(Files, WriteReplacesAtomically) {
  const fs::path path = directory_ / "mesh.off";
  write(path, "old");
  ::chmod(path.c_str(), 0640);
  const fs::path kept = directory_ / "kept";
  fs::create_hard_link(path, kept);
  write(path, "new content");
  EXPECT_EQ(content(path), "new content");
  EXPECT_EQ(content(kept), "old");  // the old file was not touched
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
  EXPECT_EQ(entries(), 2U);  // no temporary file is left
  write(path, "");
  EXPECT_EQ(content(path), "");
}

TEST_F(Files, SymbolicLinksStay) {
  write(directory_ / "real", "old");
  fs::create_symlink("real", directory_ / "link");
  write(directory_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(directory_ / "link"));
  EXPECT_EQ(content(directory_ / "real"), "new");
}

TEST_F(Files, WriteErrors) {
  EXPECT_NE(write_error(directory_ / "none" / "x.ply").find("does not exist"), std::string::npos);
  EXPECT_NE(write_error(directory_).find("directory"), std::string::npos);
  EXPECT_NE(write_error("").find("empty"), std::string::npos);
  write(directory_ / "file", "x");
  EXPECT_NE(write_error(directory_ / "file" / "x.ply").find("cannot be written"),
            std::string::npos);
  EXPECT_EQ(entries(), 1U);
  if (fs::exists("/dev/full")) {
    EXPECT_NE(write_error("/dev/full").find("space"), std::string::npos);
  }
}

TEST_F(Files, DevicesAreWrittenDirectly) {
  write("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  // Standard output redirected to a file is appended to, not replaced.
  std::fflush(stdout);
  const fs::path path = directory_ / "out";
  const int saved = ::dup(STDOUT_FILENO);
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT, 0600);
  ::dup2(file, STDOUT_FILENO);
  write("-", "one ");
  write("/dev/stdout", "two ");
  write("/dev/fd/1", "three");
  ::dup2(saved, STDOUT_FILENO);
  ::close(saved);
  ::close(file);
  EXPECT_EQ(content(path), "one two three");
}

TEST_F(Files, StandardInput) {
  const fs::path path = directory_ / "in.off";
  const std::vector<char> bytes = serialise_mesh(tetrahedron(), Format::Off);
  write_file(path, bytes);
  const int saved = ::dup(STDIN_FILENO);
  const auto redirect = [&] {
    const int file = ::open(path.c_str(), O_RDONLY);
    ::dup2(file, STDIN_FILENO);
    ::close(file);
  };
  redirect();
  EXPECT_EQ(read_mesh("-", Format::Off).mesh.triangles.size(), 4U);
  redirect();
  EXPECT_NE(read_error("-").find("format"), std::string::npos);
  ::dup2(saved, STDIN_FILENO);
  ::close(saved);
}

TEST_F(Files, ReadMesh) {
  const fs::path path = directory_ / "mesh.PLY";
  const std::vector<char> written = serialise_mesh(tetrahedron(), Format::Ply);
  write_file(path, written);
  std::vector<char> bytes;
  const ReadResult r = read_mesh(path, {}, &bytes);
  EXPECT_EQ(r.format, Format::Ply);
  EXPECT_EQ(bytes, written);
  EXPECT_EQ(r.mesh.triangles.size(), 4U);
  EXPECT_NE(read_error(directory_ / "none.ply").find("none.ply: cannot be read"),
            std::string::npos);
  EXPECT_NE(read_error(directory_, Format::Ply).find("directory"), std::string::npos);
  EXPECT_NE(read_error(directory_ / "mesh.xyz").find("stl"), std::string::npos);
  EXPECT_NE(read_error(path, Format::Off).find("mesh.PLY: line 1"), std::string::npos);
}

TEST(Sha256, Vectors) {
  const auto hash = [](const std::string& text) { return sha256({text.data(), text.size()}); };
  // FIPS 180-4 and NIST's test vectors.
  EXPECT_EQ(hash(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hash("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hash("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(
      hash("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopqklmno"
           "pqrlmnopqrsmnopqrstnopqrstu"),
      "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
  EXPECT_EQ(hash(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, EveryPaddingLength) {
  // sha256 of 0..130 times 'x', hashed together; value from Python's hashlib.
  std::string all;
  for (std::size_t n = 0; n <= 130; ++n) {
    const std::string text(n, 'x');
    all += sha256({text.data(), text.size()});
  }
  EXPECT_EQ(sha256({all.data(), all.size()}),
            "87aca1c44bc7ba8897768170211f0a02063de70801131ff86c7edb9ce32c6a50");
}

}  // namespace
}  // namespace kaboum::io::test

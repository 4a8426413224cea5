// Damaged and odd files of other projects' test suites: refused with a message that names them, or rendered.
#include "support/data_folder.h"
#include "support/program.h"

#include <algorithm>
#include <cstdint>
#include <gtest/gtest.h>

namespace etendue::test {
namespace {

std::vector<std::filesystem::path> files_of(const std::string& kind) {
  std::vector<std::filesystem::path> files;
  std::error_code absent;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder() / "badinput" / kind, absent))
    files.push_back(std::filesystem::absolute(entry.path()));
  std::sort(files.begin(), files.end());
  return files;
}

constexpr const char* small_camera =
    "<camera type=\"perspective\"><integer name=\"width\" value=\"4\"/><integer name=\"height\" value=\"4\"/>"
    "</camera>";

/// Ends in time, within memory, and rendered or with a message that names the file.
void check(const std::vector<std::string>& arguments, const std::filesystem::path& where,
           const std::string& file) {
  constexpr double most_seconds = 20;
  constexpr long most_memory_kib = 2L << 20;
  const ProgramResult result = run_program(arguments, where, most_seconds);
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 2) << "exit code " << result.exit_code;
  EXPECT_LT(result.seconds, most_seconds);
  EXPECT_LT(result.peak_memory_kib, most_memory_kib);
  if (result.exit_code == 2) {
    EXPECT_NE(result.err.find(file), std::string::npos);
  }
  if (testing::Test::HasFailure()) ADD_FAILURE() << result.err;
}

void check_scene(const std::string& body, const std::filesystem::path& folder, const std::string& file) {
  write_file(folder / "scene.xml", "<scene>" + std::string(small_camera) + body + "</scene>");
  check({"render", "scene.xml", "-o", "a.exr", "--spp", "1", "--threads", "1"}, folder, file);
}

/// \param type obj or ply
std::string mesh_xml(const std::string& type, const std::string& file) {
  return "<mesh type=\"" + type + "\"><string name=\"filename\" value=\"" + file +
         "\"/><emitter type=\"area\"/></mesh>";
}

std::string envmap_xml(const std::string& file) {
  return "<mesh type=\"sphere\"/><emitter type=\"envmap\"><string name=\"filename\" value=\"" + file +
         "\"/></emitter>";
}

TEST(BadFiles, AsScenes) {
  const auto files = files_of("xml");
  if (files.empty()) GTEST_SKIP() << data_folder() << " is not there";
  const TemporaryFolder folder;
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    check({"render", file.string(), "-o", "a.exr", "--spp", "1", "--threads", "1"}, folder.path(),
          file.string());
  }
}

TEST(BadFiles, AsMeshes) {
  for (const std::string type : {"obj", "ply"}) {
    const auto files = files_of(type);
    if (files.empty()) GTEST_SKIP() << data_folder() << " is not there";
    const TemporaryFolder folder;
    for (const auto& file : files) {
      SCOPED_TRACE(file);
      check_scene(mesh_xml(type, file.string()), folder.path(), file.filename().string());
    }
  }
}

TEST(BadFiles, AsEnvironmentMaps) {
  const auto files = files_of("exr");
  if (files.empty()) GTEST_SKIP() << data_folder() << " is not there";
  const TemporaryFolder folder;
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    check_scene(envmap_xml(file.string()), folder.path(), file.filename().string());
  }
}

/// A square in ASCII or binary, and the same with claims that no file could keep.
std::string ply_file(bool is_binary, const std::string& vertices = "4", const std::string& faces = "1") {
  std::string file = std::string("ply\nformat ") + (is_binary ? "binary_little_endian" : "ascii") +
                     " 1.0\nelement vertex " + vertices +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
                     "\nproperty list uchar uint vertex_indices\nend_header\n";
  if (!is_binary) return file + "-1 -1 5\n1 -1 5\n1 1 5\n-1 1 5\n4 0 1 2 3\n";
  for (const float k : {-1, -1, 5, 1, -1, 5, 1, 1, 5, -1, 1, 5})
    file.append(reinterpret_cast<const char*>(&k), sizeof(k));
  file += '\4';
  for (const std::uint32_t k : {0, 1, 2, 3}) file.append(reinterpret_cast<const char*>(&k), sizeof(k));
  return file;
}

TEST(BadFiles, MutatedPly) {
  const TemporaryFolder folder;
  const auto check_file = [&](const std::string& bytes) {
    std::filesystem::remove(folder.path() / "mesh.ply");
    write_file(folder.path() / "mesh.ply", bytes);
    check_scene(mesh_xml("ply", "mesh.ply"), folder.path(), "mesh.ply");
  };
  for (const bool is_binary : {false, true}) {
    const std::string file = ply_file(is_binary);
    SCOPED_TRACE(is_binary ? "binary" : "ascii");
    for (std::size_t length = 0; length <= file.size(); length += 13) {
      SCOPED_TRACE(length);
      check_file(file.substr(0, length));
    }
    for (std::size_t bit = 3; bit < 8 * file.size(); bit += 61) {
      SCOPED_TRACE(bit);
      std::string flipped = file;
      flipped[bit / 8] ^= char(1 << bit % 8);
      check_file(flipped);
    }
    for (const std::string claim : {"4000000000", "18446744073709551615"}) {
      check_file(ply_file(is_binary, claim));
      check_file(ply_file(is_binary, "4", claim));
    }
  }
}

}  // namespace
}  // namespace etendue::test

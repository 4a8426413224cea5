// How files come under their names.
//
// Seen to fail when: the link itself is replaced; a relative link is taken from the working folder; the
// permissions are those of a new file; a failed write leaves a file behind.
#include "base/temporary_file.h"

#include "support/error_of.h"
#include "support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <thread>

namespace etendue {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class Writing : public testing::Test {
 protected:
  void write(const fs::path& file, const std::string& text) const {
    check_destination(file);
    TemporaryFile out(file);
    out.write(text.data(), text.size());
    out.commit();
  }
  static unsigned mode(const fs::path& file) { return unsigned(fs::status(file).permissions()); }
  std::size_t files_in(const fs::path& where) const {
    return std::size_t(std::distance(fs::directory_iterator(where), fs::directory_iterator()));
  }

  const test::TemporaryFolder temporary;
  const fs::path folder = temporary.path();
};

TEST_F(Writing, GoesThroughSymbolicLinks) {
  fs::create_directory(folder / "images");
  test::write_file(folder / "images/a", "old");
  fs::create_symlink("images/a", folder / "one");
  fs::create_symlink(folder / "one", folder / "two");
  write(folder / "two", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "one"));
  EXPECT_TRUE(fs::is_symlink(folder / "two"));
  EXPECT_EQ(test::read_file(folder / "images/a"), "new");

  fs::create_symlink("images/b", folder / "to_nothing");
  write(folder / "to_nothing", "b");
  EXPECT_EQ(test::read_file(folder / "images/b"), "b");
  EXPECT_TRUE(fs::is_symlink(folder / "to_nothing"));
  EXPECT_EQ(files_in(folder), 4u);
  EXPECT_EQ(files_in(folder / "images"), 2u);

  fs::create_symlink("nowhere/a", folder / "lost");
  EXPECT_THAT(test::error_of([&] { write(folder / "lost", ""); }), HasSubstr("lost: the folder"));
  fs::create_symlink("circle", folder / "circle");
  EXPECT_THAT(test::error_of([&] { write(folder / "circle", ""); }), HasSubstr("circle: "));
}

TEST_F(Writing, KeepsPermissionsAndGivesNewFilesTheUsualOnes) {
  const mode_t before = umask(027);
  write(folder / "a", "1");
  EXPECT_EQ(mode(folder / "a"), 0640u);
  for (const unsigned kept : {0600u, 0664u, 0444u}) {
    fs::permissions(folder / "a", fs::perms(kept));
    write(folder / "a", "2");
    EXPECT_EQ(mode(folder / "a"), kept);
  }
  fs::create_symlink("a", folder / "link");
  write(folder / "link", "3");
  EXPECT_EQ(mode(folder / "a"), 0444u);
  umask(before);
}

TEST_F(Writing, DevicesAndPipesAreWrittenToAsTheyAre) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = test::read_file(folder / "pipe"); });
  write(folder / "pipe", "through");
  reader.join();
  EXPECT_EQ(read, "through");
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
  EXPECT_EQ(files_in(folder), 1u);
}

TEST_F(Writing, AFullDiskIsCalledSo) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  fs::create_symlink("/dev/full", folder / "full");
  for (const std::size_t size : {std::size_t(10), std::size_t(1) << 20})
    EXPECT_THAT(test::error_of([&] { write(folder / "full", std::string(size, 'x')); }),
                HasSubstr("full: cannot write: No space left on device"));
  EXPECT_TRUE(fs::is_symlink(folder / "full"));
}

}  // namespace
}  // namespace etendue

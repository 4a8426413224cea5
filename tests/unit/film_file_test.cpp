#include "film/film_file.h"

#include "support/error_of.h"
#include "support/temporary_folder.h"

#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

namespace etendue {
namespace {

using testing::HasSubstr;

/// Eleven replicates of 3 x 2 pixels from replicate 3 on: films over [3, 4), [4, 8), [8, 12), [12, 14).
FilmState some_film() {
  FilmState state{{.seed = 0xfedcba9876543210,
                   .scene_hash = 0x0123456789abcdef,
                   .samples_per_replicate = 12345678901,
                   .replicates_by = ReplicatesBy::scrambling,
                   .sampler = "sobol",
                   .integrator = "mis heuristic=power light_samples=3 sampler=power bsdf_samples=2",
                   .isa = "v3",
                   .dialect = "nori-eth",
                   .software = "Etendue"},
                  FilmStack(3, 2, 3)};
  std::mt19937_64 engine(1);
  std::lognormal_distribution<double> radiance(0, 3);
  state.film.begin_pass(14);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) {
      std::vector<Color<double>> means(11);
      for (auto& mean : means) mean = {radiance(engine), radiance(engine), radiance(engine)};
      if (x == 2 && y == 1) means[4].g = std::numeric_limits<double>::quiet_NaN();
      state.film.add(x, y, means);
    }
  state.film.commit_pass();
  return state;
}

class FilmFile : public testing::Test {
 protected:
  std::filesystem::path path() const { return folder_.path() / "a.film"; }
  std::string error_of_reading(const std::string& bytes) const {
    test::write_file(path(), bytes);
    return test::error_of([&] { read_film(path()); });
  }
  std::string bytes_of(const FilmState& state) const {
    write_film(path(), state);
    return test::read_file(path());
  }
  const test::TemporaryFolder folder_;
};

TEST_F(FilmFile, KeepsEveryFieldToTheBit) {
  const FilmState state = some_film();
  write_film(path(), state);
  const FilmState again = read_film(path());
  EXPECT_EQ(again.origin, state.origin);
  EXPECT_EQ(again.film.first(), 3u);
  EXPECT_EQ(again.film.last(), 14u);
  ASSERT_EQ(again.film.blocks().size(), state.film.blocks().size());
  for (std::size_t k = 0; k < again.film.blocks().size(); ++k) {
    const FilmBlock &a = again.film.blocks()[k], &b = state.film.blocks()[k];
    EXPECT_EQ(a.first, b.first);
    EXPECT_EQ(a.last, b.last);
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x)
        EXPECT_EQ(std::memcmp(&a.film.at(x, y), &b.film.at(x, y), sizeof(PixelStatistics)), 0);
  }
  EXPECT_EQ(bytes_of(again), bytes_of(state));
}

TEST_F(FilmFile, IsAsLongAsTheFormatSays) {
  const std::size_t header = 8 + 4 + 2 * 4 + 3 * 8 + 1 + (4 + 5) + (4 + 64) + (4 + 2) + (4 + 8) + (4 + 7) + 4;
  EXPECT_EQ(bytes_of(some_film()).size(), header + 4 * (16 + 6 * 80) + 8);
}

TEST_F(FilmFile, RefusesWhatIsCutShortAnywhere) {
  const std::string whole = bytes_of(some_film());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string error = error_of_reading(whole.substr(0, size));
    ASSERT_THAT(error, HasSubstr("a.film: cannot read this film: ")) << size;
    ASSERT_THAT(error, HasSubstr(size < 8 ? "another kind of file" : "cut short")) << size;
  }
}

TEST_F(FilmFile, RefusesEveryByteThatIsChanged) {
  const std::string whole = bytes_of(some_film());
  std::mt19937_64 engine(2);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = char(changed[at] ^ (1 + engine() % 255));
    ASSERT_NE(error_of_reading(changed), "") << at;
  }
  EXPECT_THAT(error_of_reading(whole + '\0'), HasSubstr("longer"));
}

TEST_F(FilmFile, SaysWhatIsWrong) {
  EXPECT_THAT(error_of_reading("v/1\x01 an image or so"), HasSubstr("another kind of file"));
  std::string bytes = bytes_of(some_film());
  bytes[8] = 7;
  EXPECT_THAT(error_of_reading(bytes), HasSubstr("version 7, and this program reads version 1"));
  bytes[8] = 1;
  bytes[bytes.size() - 100] ^= 1;
  EXPECT_THAT(error_of_reading(bytes), HasSubstr("damaged: its checksum"));
  EXPECT_THAT(test::error_of([&] { read_film(folder_.path() / "none.film"); }), HasSubstr("No such file"));
  EXPECT_NE(test::error_of([&] { read_film(folder_.path()); }), "");
  EXPECT_NE(test::error_of([&] { write_film("/proc/a.film", some_film()); }), "");
}

TEST_F(FilmFile, RefusesReplicatesWithoutSamples) {
  std::string bytes = bytes_of(some_film());
  for (const std::int64_t samples : {0, -3}) {
    std::memcpy(&bytes[36], &samples, sizeof samples);
    EXPECT_THAT(error_of_reading(bytes), HasSubstr(fmt::format("{} samples a replicate", samples)));
    FilmState state = some_film();
    state.origin.samples_per_replicate = samples;
    EXPECT_THAT(test::error_of([&] { write_film(path(), state); }),
                HasSubstr(fmt::format("{} samples a replicate", samples)));
  }
}

TEST_F(FilmFile, RefusesPixelsThatLackReplicates) {
  std::string bytes = bytes_of(some_film());
  const std::size_t last_pixel = bytes.size() - 8 - 80;
  for (const std::int64_t count : {0, 1, 3, -2}) {
    std::memcpy(&bytes[last_pixel], &count, sizeof count);
    EXPECT_THAT(error_of_reading(bytes),
                HasSubstr(fmt::format("damaged: pixel (2, 1) has {} of replicates 12 to 14", count)));
  }
}

TEST_F(FilmFile, IsNotWrittenOfAFragment) {
  FilmState state{some_film().origin, FilmStack(2, 1)};
  const auto error = [&] { return test::error_of([&] { write_film(path(), state); }); };
  EXPECT_THAT(error(), HasSubstr("a.film: cannot save this film: it has no replicates"));
  state.film.begin_pass(1);
  state.film.add(0, 0, std::vector<Color<double>>{{1, 1, 1}});
  state.film.commit_pass();
  EXPECT_THAT(error(), HasSubstr("fragment: pixel (1, 0) lacks replicates"));
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(FilmFile, AHugeClaimAllocatesNothing) {
  std::string bytes = bytes_of(some_film());
  const std::uint32_t huge = 1u << 30;
  std::memcpy(&bytes[12], &huge, sizeof huge);
  std::memcpy(&bytes[16], &huge, sizeof huge);
  EXPECT_THAT(error_of_reading(bytes), HasSubstr("cut short"));
}

}  // namespace
}  // namespace etendue

#include "film/film_stack.h"

#include "base/error.h"

#include <bit>
#include <gtest/gtest.h>
#include <random>

namespace etendue {
namespace {

using Means = std::vector<Color<double>>;

Means random_means(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::lognormal_distribution<double> radiance(0, 2);
  Means means(count);
  for (auto& mean : means) mean = {radiance(engine), radiance(engine), radiance(engine)};
  return means;
}

/// The means of the pixel (1, 0) of a film of two, from replicate `first` on.
void add_pass(FilmStack& stack, const Means& all, std::uint64_t end) {
  stack.begin_pass(end);
  const auto means = std::span(all).subspan(stack.last() - stack.first(), end - stack.last());
  stack.add(0, 0, means);
  stack.add(1, 0, means);
}

TEST(FilmStack, PassesOfAnySizeGiveTheBitsOfOne) {
  std::mt19937_64 engine(7);
  for (const std::uint64_t first : {0, 1, 3, 8, 12})
    for (std::uint64_t count = 1; count < 70; ++count) {
      const Means all = random_means(count, count);
      FilmStack stack(2, 1, first);
      EXPECT_EQ(stack.pixel(1, 0), PixelStatistics{});
      while (stack.last() < first + count) {
        const std::uint64_t left = first + count - stack.last();
        add_pass(stack, all, stack.last() + 1 + engine() % left);
        stack.commit_pass();
      }
      ASSERT_EQ(stack.pixel(1, 0), combine_replicates(all, first)) << first << " + " << count;
      ASSERT_LE(stack.blocks().size(), 12u);
    }
}

TEST(FilmStack, KeepsFewFilms) {
  const Means all = random_means(1024, 1);
  FilmStack stack(2, 1);
  for (std::uint64_t end = 1; end <= 1024; ++end) {
    add_pass(stack, all, end);
    stack.commit_pass();
    ASSERT_EQ(stack.blocks().size(), std::size_t(std::popcount(end)));
  }
}

TEST(FilmStack, APassThatIsGivenUpChangesNothing) {
  const Means all = random_means(16, 2);
  FilmStack stack(2, 1);
  add_pass(stack, all, 7);
  stack.commit_pass();
  add_pass(stack, random_means(16, 3), 8);  // not committed
  EXPECT_EQ(stack.pixel(0, 0), combine_replicates(std::span(all).first(7), 0));
  EXPECT_EQ(stack.last(), 7u);
  add_pass(stack, all, 16);
  stack.commit_pass();
  EXPECT_EQ(stack.pixel(0, 0), combine_replicates(all, 0));
}

TEST(FilmStack, AFirstPassThatIsGivenUpLeavesNoPixels) {
  FilmStack stack(2, 1);
  stack.begin_pass(3);
  stack.add(1, 0, random_means(3, 5));
  stack.begin_pass(3);
  stack.commit_pass();
  EXPECT_EQ(stack.pixel(1, 0), PixelStatistics{});
}

TEST(FilmStack, GoesOnFromItsBlocks) {
  const Means all = random_means(13, 4);
  FilmStack stack(2, 1);
  add_pass(stack, all, 11);
  stack.commit_pass();
  FilmStack again(stack.blocks());
  add_pass(again, all, 13);
  again.commit_pass();
  EXPECT_EQ(again.pixel(1, 0), combine_replicates(all, 0));
}

TEST(FilmStack, RefusesBlocksThatDoNotFit) {
  EXPECT_THROW(FilmStack(0, 1), InputError);
  EXPECT_THROW(FilmStack(std::vector<FilmBlock>{}), InputError);
  EXPECT_THROW(FilmStack({{0, 3, Film(2, 1)}}), InputError);
  EXPECT_THROW(FilmStack({{0, 4, Film(2, 1)}, {5, 6, Film(2, 1)}}), InputError);
  EXPECT_THROW(FilmStack({{0, 4, Film(2, 1)}, {4, 6, Film(1, 2)}}), InputError);
  EXPECT_THROW(FilmStack({{4, 4, Film(2, 1)}}), InputError);
}

}  // namespace
}  // namespace etendue

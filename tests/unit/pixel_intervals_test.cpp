// Intervals of films whose law is known. Fixed seeds; a right program fails none of the shares below but with
// probability 1e-6 each (normal approximation of the binomial law, pixels that share neighbours counted as
// 9). Seen to fail when: nothing is pooled; all pixels count as alike; the bound of black pixels is 0.
#include "film/pixel_intervals.h"

#include "stats/quantile.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <stdexcept>

namespace etendue {
namespace {

struct NoisyPicture {
  Film film;
  ReplicateLuminances luminances;
  std::vector<PixelInterval> intervals(double confidence = 0.95) const {
    return pixel_intervals(film, luminances, confidence);
  }
};

using Law = std::function<double(int x, int y)>;

NoisyPicture noisy_picture(int side_px, int replicates, const Law& draw) {
  NoisyPicture picture{Film(side_px, side_px), ReplicateLuminances(side_px, side_px, replicates)};
  std::vector<Color<double>> means(static_cast<std::size_t>(replicates));
  for (int y = 0; y < side_px; ++y)
    for (int x = 0; x < side_px; ++x) {
      for (Color<double>& mean : means) {
        const double value = draw(x, y);
        mean = {value, value, value};
      }
      picture.film.at(x, y) = combine_replicates(means, 0);
      picture.luminances.add(x, y, 0, means);
    }
  return picture;
}

struct Shares {
  double covered = 0, trusted = 0, covered_where_trusted = 0;
};

Shares shares(const NoisyPicture& picture, double truth) {
  const std::vector<PixelInterval> intervals = picture.intervals();
  double covered = 0, trusted = 0, both = 0;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const int width = picture.film.width();
    const double mean = picture.film.at(int(i) % width, int(i) / width).mean.g;
    const bool is_covered = std::abs(mean - truth) <= double(intervals[i].half_width.g);
    const bool is_trusted =
        intervals[i].rule == IntervalRule::student_t || intervals[i].rule == IntervalRule::neighbours;
    covered += is_covered;
    trusted += is_trusted;
    both += is_covered && is_trusted;
  }
  return {covered / double(intervals.size()), trusted / double(intervals.size()), both / trusted};
}

TEST(PixelIntervals, HoldTheirShareWhereReplicatesAreNormal) {
  for (const int replicates : {4, 8, 16, 32}) {
    std::mt19937_64 engine(1);
    std::normal_distribution<double> law(3, 0.5);
    const Shares found = shares(noisy_picture(128, replicates, [&](int, int) { return law(engine); }), 3);
    EXPECT_GT(found.covered, 0.94) << replicates;
    EXPECT_LT(found.covered, replicates == 4 ? 0.992 : 0.985) << replicates;
    EXPECT_GT(found.trusted, 0.97) << replicates;
  }
}

TEST(PixelIntervals, HoldWhereOneReplicateInEightFindsTheLight) {
  // Student's t over the same replicates holds the mean in 85 % of pixels.
  std::mt19937_64 engine(2);
  std::bernoulli_distribution hit(0.125);
  const NoisyPicture found = noisy_picture(128, 16, [&](int, int) { return 1 + 100 * hit(engine); });
  EXPECT_GT(shares(found, 13.5).covered, 0.93);
  EXPECT_GT(shares(found, 13.5).covered_where_trusted, 0.93);
}

TEST(PixelIntervals, SayWhereLightIsMetTooSeldom) {
  // Six of ten pixels have met nothing.
  std::mt19937_64 engine(3);
  std::bernoulli_distribution hit(1.0 / 32);
  const NoisyPicture found = noisy_picture(128, 16, [&](int, int) { return 1 + 100 * hit(engine); });
  EXPECT_GT(shares(found, 1 + 100.0 / 32).covered, 0.9);
  for (const PixelInterval& interval : found.intervals()) ASSERT_NE(interval.rule, IntervalRule::unknown);
}

TEST(PixelIntervals, LeaveAQuietPixelAloneBesideAnEdge) {
  std::mt19937_64 engine(4);
  std::normal_distribution<double> law(0, 1);
  const NoisyPicture found = noisy_picture(
      32, 16, [&](int x, int) { return x < 16 ? 1 + 1e-3 * law(engine) : 5 + 0.5 * law(engine); });
  const std::vector<PixelInterval> intervals = found.intervals();
  for (int y = 0; y < 32; ++y) {
    EXPECT_LT(intervals[std::size_t(y * 32 + 15)].half_width.g, 1.5e-3);
    EXPECT_GT(intervals[std::size_t(y * 32 + 16)].half_width.g, 0.1);
  }
}

TEST(PixelIntervals, BoundWhatBlackPixelsMayHide) {
  const auto black_but_for_a_corner = [](int replicates) {
    return noisy_picture(16, replicates, [](int x, int y) { return x == 0 && y == 0 ? 7.0 : 0.0; });
  };
  const PixelInterval far = black_but_for_a_corner(8).intervals()[16 * 8 + 8];
  EXPECT_EQ(far.rule, IntervalRule::black);
  // -ln 0.05 of at most 7 each in 8 replicates of 25 pixels.
  EXPECT_NEAR(far.half_width.g, 2.9957 * 7 / (8 * 25), 1e-5);
  EXPECT_NEAR(far.luminance_half_width, far.half_width.g, 1e-7);
  EXPECT_NEAR(black_but_for_a_corner(16).intervals()[16 * 8 + 8].half_width.g, 2.9957 * 7 / (16 * 25), 1e-5);
  const PixelInterval shining = black_but_for_a_corner(8).intervals()[0];
  EXPECT_EQ(shining.rule, IntervalRule::student_t);
  EXPECT_EQ(shining.half_width.g, 0);
}

TEST(PixelIntervals, ABlackPixelAmongOnesThatMetLightHasTheirs) {
  int drawn = 0;
  const NoisyPicture found =
      noisy_picture(5, 8, [&](int x, int y) { return x == 2 && y == 2 ? 0.0 : double(drawn++ % 8 == 0); });
  const PixelInterval middle = found.intervals()[12];
  EXPECT_EQ(middle.rule, IntervalRule::neighbours);
  EXPECT_GT(middle.half_width.r, 0.1);
}

TEST(PixelIntervals, KnowNothingOfLessThanTwoReplicates) {
  const NoisyPicture one = noisy_picture(2, 1, [](int, int) { return 1.0; });
  EXPECT_EQ(one.intervals()[0].rule, IntervalRule::unknown);
  EXPECT_TRUE(std::isnan(one.intervals()[0].half_width.r));
  EXPECT_TRUE(std::isnan(one.intervals()[0].luminance_half_width));
  const std::vector<PixelInterval> fragment = pixel_intervals(Film(3, 2), {}, 0.95);
  ASSERT_EQ(fragment.size(), 6u);
  EXPECT_EQ(fragment[5].rule, IntervalRule::unknown);
}

TEST(PixelIntervals, TakeTheLuminanceOfReplicatesWhereItIsKept) {
  // Red and green that cancel: luminance does not vary.
  Film film(1, 1);
  ReplicateLuminances luminances(1, 1, 2);
  const std::vector<Color<double>> means{{1 / 0.212671, 0, 0}, {0, 1 / 0.715160, 0}};
  film.at(0, 0) = combine_replicates(means, 0);
  luminances.add(0, 0, 0, means);
  EXPECT_NEAR(pixel_intervals(film, luminances, 0.95)[0].luminance_error, 0, 1e-6);
  EXPECT_NEAR(pixel_intervals(film, {}, 0.95)[0].luminance_error, 1, 1e-6);
}

TEST(PixelIntervals, WidenWithTheConfidence) {
  std::mt19937_64 engine(5);
  std::normal_distribution<double> law(3, 0.5);
  const NoisyPicture found = noisy_picture(3, 8, [&](int, int) { return law(engine); });
  EXPECT_GT(found.intervals(0.99)[4].half_width.g, found.intervals(0.9)[4].half_width.g);
  EXPECT_THROW(found.intervals(1), std::domain_error);
}

TEST(ReplicateLuminances, AreNotKeptWhereTheyTakeTooMuch) {
  EXPECT_TRUE(ReplicateLuminances(3840, 2160, 16).is_kept());
  EXPECT_FALSE(ReplicateLuminances(3840, 2160, 17).is_kept());
  EXPECT_TRUE(ReplicateLuminances(3840, 2160, 17).at(3, 4, 2).empty());
  ReplicateLuminances grown(3840, 2160, 3);
  grown.make_room(17);
  EXPECT_FALSE(grown.is_kept());
}

TEST(ReplicateLuminances, StayWhereRoomIsMade) {
  ReplicateLuminances luminances(2, 2, 0);
  for (int replicate = 0; replicate < 9; ++replicate) {
    luminances.make_room(replicate + 1);
    for (const int pixel : {0, 1, 2, 3}) {
      const double value = 10 * pixel + replicate;
      luminances.add(pixel % 2, pixel / 2, replicate, std::array{Color<double>{value, value, value}});
    }
  }
  for (const int pixel : {0, 1, 2, 3})
    for (int replicate = 0; replicate < 9; ++replicate)
      EXPECT_NEAR(luminances.at(pixel % 2, pixel / 2, 9)[std::size_t(replicate)], 10 * pixel + replicate,
                  1e-4);
}

/// A pixel of many samples beside those of few: their errors tell less about its own.
TEST(PixelIntervals, ScaleTheErrorsOfNeighboursToThePixelsNumberOfSamples) {
  constexpr int side = 3;
  Film film(side, side);
  SampleAllocation allocation(side, side, 4);
  allocation.at(1, 1) = 256;
  ReplicateLuminances none;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double error_sq = 64.0 / allocation.at(x, y);  // Of the mean of 4 replicates.
      film.at(x, y) = {4, {5, 5, 5}, Color<double>{1, 1, 1} * (error_sq * 4 * 3), {0, 0, 0}};
    }
  const std::vector<PixelInterval> alike = pixel_intervals(film, none, 0.95),
                                   scaled = pixel_intervals(film, none, 0.95, &allocation);
  EXPECT_EQ(alike[4].rule, IntervalRule::neighbours);
  EXPECT_EQ(scaled[4].rule, IntervalRule::student_t);
  EXPECT_NEAR(scaled[4].luminance_half_width, 0.5 * student_t_quantile(0.975, 3), 1e-4);
  EXPECT_GT(alike[4].luminance_half_width, 4 * scaled[4].luminance_half_width);
  // One that has missed what its neighbours met takes theirs, as it would be with its samples.
  film.at(1, 1).m2 = {0, 0, 0};
  const PixelInterval missed = pixel_intervals(film, none, 0.95, &allocation)[4];
  EXPECT_EQ(missed.rule, IntervalRule::neighbours);
  EXPECT_NEAR(missed.luminance_half_width, 0.5 * std::sqrt(8.0 / 9) * student_t_quantile(0.975, 9 * 3), 1e-4);
}

}  // namespace
}  // namespace etendue

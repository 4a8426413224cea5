// Both samplers: equidistributed, uncorrelated where they should be, and Sobol's points a (0,2)-sequence.
//
// False-alarm rate of this file: 1e-5 (Sidak over its chi-squared and z-tests), fixed seeds; the
// stratification tests are exact.
// Seen to fail when: scramble_reversed multiplies by an even number; sobol_second_reversed leaves out its
// third step; the padded pairs share seed_order (`pair` left out of seed_index); the replicate is left out
// of the stream; independent gives y = x.
#include "sampler/sampler.h"

#include "stats/chi_squared.h"
#include "stats/running.h"
#include "stats/significance.h"
#include "stats/t_test.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace etendue {
namespace {

constexpr double family_level = 1e-5;
constexpr int family_size = 300;  // At least as many tests as are made below.
constexpr SamplerKind samplers[]{SamplerKind::independent, SamplerKind::sobol};

/// The point `index` of a stream.
Vec2<std::uint32_t> point(SamplerKind kind, std::uint64_t stream, std::uint32_t index, std::uint32_t pair) {
  return sample_2d<float>(kind, std::uint32_t(stream), std::uint32_t(stream >> 32), index, pair);
}
double unit(std::uint32_t bits) { return (bits + 0.5) * 0x1p-32; }

void expect_equidistributed(const std::vector<double>& counts, double total, const std::string& what) {
  const std::vector<double> expected(counts.size(), total / double(counts.size()));
  const ChiSquaredTest test = chi_squared_test(counts, expected);
  EXPECT_FALSE(is_rejected(test.p_value, family_level, family_size))
      << what << ": chi-squared " << test.statistic << ", " << test.degrees_of_freedom
      << " degrees of freedom";
}

TEST(Sobol, EveryElementaryIntervalOfTheFirstPowerOfTwoPointsHoldsExactlyOne) {
  for (const std::uint64_t seed : {0u, 1u, 77u})
    for (std::uint32_t pair = 0; pair < 4; ++pair)
      for (int k = 0; k <= 12; ++k) {
        const std::uint64_t stream = sample_stream(seed, 3, 5, 0);
        // As a sequence: the first block of 2^k points and a later one.
        for (const std::uint32_t block : {0u, 5u})
          for (int bits_x = 0; bits_x <= k; ++bits_x) {
            std::vector<int> counts(std::size_t(1) << k);
            for (std::uint32_t i = 0; i < (1u << k); ++i) {
              const auto p = point(SamplerKind::sobol, stream, (block << k) + i, pair);
              const std::uint64_t cell_x = std::uint64_t(p.x) >> (32 - bits_x);
              const std::uint64_t cell_y = std::uint64_t(p.y) >> (32 - (k - bits_x));
              ++counts[std::size_t((cell_x << (k - bits_x)) + cell_y)];
            }
            for (const int count : counts) ASSERT_EQ(count, 1) << "pair " << pair << ", 2^" << k << " points";
          }
      }
}

TEST(Sampler, PointsFillTheSquareEvenlyWithinAStream) {
  for (const SamplerKind kind : {SamplerKind::independent})
    for (std::uint32_t pair = 0; pair < 3; ++pair) {
      std::vector<double> counts(32 * 32);
      constexpr int n = 1 << 18;
      for (int i = 0; i < n; ++i) {
        const auto p = point(kind, sample_stream(9, 1, 2, 3), std::uint32_t(i), pair);
        ++counts[(p.x >> 27) * 32 + (p.y >> 27)];
      }
      expect_equidistributed(counts, n, "pair " + std::to_string(pair));
    }
}

/// One variable of an experiment: the stream and index that trial `i` looks at.
struct Across {
  const char* name;
  std::function<std::pair<std::uint64_t, std::uint32_t>(int)> at;
};

TEST(Sampler, OnePointIsUniformAcrossPixelsReplicatesAndSeeds) {
  const Across experiments[]{{"pixels",
                              [](int i) {
                                return std::pair{sample_stream(1, i % 512, i / 512, 0), 0u};
                              }},
                             {"replicates",
                              [](int i) {
                                return std::pair{sample_stream(1, 4, 4, i), 6u};
                              }},
                             {"seeds", [](int i) {
                                return std::pair{sample_stream(std::uint64_t(i), 4, 4, 0), 3u};
                              }}};
  for (const SamplerKind kind : samplers)
    for (const Across& across : experiments)
      for (const std::uint32_t pair : {0u, 2u}) {
        std::vector<double> upper(32 * 32), lower(32 * 32);
        constexpr int n = 1 << 18;
        for (int i = 0; i < n; ++i) {
          const auto [stream, index] = across.at(i);
          const auto p = point(kind, stream, index, pair);
          ++upper[(p.x >> 27) * 32 + (p.y >> 27)];
          // Bits 8 to 12 still matter: a light is chosen by the upper bits, its triangle by those below.
          ++lower[((p.x >> 8) & 31) * 32 + ((p.y >> 8) & 31)];
        }
        const std::string what = std::string(sampler_name(kind)) + " across " + across.name;
        expect_equidistributed(upper, n, what + ", upper bits");
        expect_equidistributed(lower, n, what + ", lower bits");
      }
}

/// The joint distribution of two numbers that should know nothing of each other.
void expect_independent(const std::function<std::pair<std::uint32_t, std::uint32_t>(int)>& numbers,
                        const std::string& what) {
  constexpr int n = 1 << 18;
  std::vector<double> counts(32 * 32);
  RunningStatistics product;
  for (int i = 0; i < n; ++i) {
    const auto [a, b] = numbers(i);
    ++counts[(a >> 27) * 32 + (b >> 27)];
    product.add((unit(a) - 0.5) * (unit(b) - 0.5));
  }
  expect_equidistributed(counts, n, what);
  const MeanTest correlation = z_test(product.mean, 0, 1.0 / 12 / std::sqrt(double(n)));
  EXPECT_FALSE(is_rejected(correlation.p_value, family_level, family_size))
      << what << ": correlation " << product.mean * 12;
}

TEST(Sampler, PairsPixelsReplicatesAndNeighbourIndicesAreUncorrelated) {
  for (const SamplerKind kind : samplers) {
    const std::string name(sampler_name(kind));
    const auto stream_of = [](int i) { return sample_stream(5, i % 64, i / 64 % 64, i / 4096); };
    for (std::uint32_t pair = 0; pair < 3; ++pair)
      for (std::uint32_t other = pair + 1; other < 4; ++other)
        for (const bool is_crossed : {false, true})
          expect_independent(
              [&](int i) {
                const auto a = point(kind, stream_of(i), 1, pair), b = point(kind, stream_of(i), 1, other);
                return std::pair{a.x, is_crossed ? b.y : b.x};
              },
              name + ": pairs " + std::to_string(pair) + " and " + std::to_string(other));
    expect_independent(
        [&](int i) {
          const auto p = point(kind, stream_of(i), 2, 1);
          return std::pair{p.x, p.y};
        },
        name + ": x and y");
    const auto x_at = [&](std::uint64_t stream) { return point(kind, stream, 0, 1).x; };
    expect_independent(
        [&](int i) {
          return std::pair{x_at(sample_stream(5, 2 * i, 7, 0)), x_at(sample_stream(5, 2 * i + 1, 7, 0))};
        },
        name + ": pixels side by side");
    expect_independent(
        [&](int i) {
          return std::pair{x_at(sample_stream(5, 7, 2 * i, 0)), x_at(sample_stream(5, 7, 2 * i + 1, 0))};
        },
        name + ": pixels one above the other");
    expect_independent(
        [&](int i) {
          return std::pair{x_at(sample_stream(5, 7, 7, 2 * i)), x_at(sample_stream(5, 7, 7, 2 * i + 1))};
        },
        name + ": replicates");
    expect_independent(
        [&](int i) {
          return std::pair{x_at(sample_stream(2 * i, 7, 7, 0)), x_at(sample_stream(2 * i + 1, 7, 7, 0))};
        },
        name + ": seeds");
  }
}

TEST(Sampler, EveryConsumerAtEveryVertexHasAPairOfItsOwn) {
  std::set<std::uint32_t> pairs{dimension::lens};
  constexpr std::uint32_t vertices = 10000;
  for (std::uint32_t vertex = 0; vertex < vertices; ++vertex)
    for (const std::uint32_t consumer :
         {dimension::film, dimension::light, dimension::bsdf, dimension::choice})
      pairs.insert(dimension::at_vertex(consumer, vertex));
  EXPECT_EQ(pairs.size(), 4 * vertices + 1);

  const auto stream_of = [](int i) { return sample_stream(6, i % 64, i / 64 % 64, i / 4096); };
  for (const SamplerKind kind : samplers)
    for (const std::uint32_t other :
         {dimension::film, dimension::light, dimension::bsdf, dimension::at_vertex(dimension::bsdf, 1),
          dimension::at_vertex(dimension::light, 30)})
      expect_independent(
          [&](int i) {
            return std::pair{point(kind, stream_of(i), 1, dimension::lens).x,
                             point(kind, stream_of(i), 1, other).x};
          },
          std::string(sampler_name(kind)) + ": lens and pair " + std::to_string(other));
}

TEST(Sampler, PairsAreUncorrelatedWithinAReplicateOfSobolPoints) {
  // Padding: within one stream, point i of one pair and point i of another must be shuffled against each
  // other.
  constexpr int n = 1 << 12;
  for (std::uint32_t pair = 0; pair < 2; ++pair) {
    std::vector<double> counts(16 * 16);
    constexpr int streams = 64;
    for (int s = 0; s < streams; ++s)
      for (int i = 0; i < n; ++i) {
        const std::uint64_t stream = sample_stream(11, s, 0, 0);
        const auto a = point(SamplerKind::sobol, stream, std::uint32_t(i), pair);
        const auto b = point(SamplerKind::sobol, stream, std::uint32_t(i), pair + 1);
        ++counts[(a.x >> 28) * 16 + (b.x >> 28)];
      }
    // Owen-scrambled margins are exact, which takes the degrees of freedom of the rows and columns away: at
    // most the statistic is smaller than chi-squared says.
    expect_equidistributed(counts, double(n) * streams, "pairs " + std::to_string(pair) + " and the next");
  }
}

/// Variance of the mean of n points of a smooth integrand, over streams.
double variance_of_mean(SamplerKind kind, int n) {
  RunningStatistics means;
  for (int s = 0; s < 2000; ++s) {
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const auto p = point(kind, sample_stream(21, s, 1, 0), std::uint32_t(i), 1);
      sum += std::exp(unit(p.x)) * std::sin(2 + unit(p.y));
    }
    means.add(sum / n);
  }
  const double exact = (std::exp(1.0) - 1) * (std::cos(2.0) - std::cos(3.0));
  EXPECT_FALSE(is_rejected(t_test(means, exact).p_value, family_level, family_size))
      << sampler_name(kind) << ", n = " << n;
  return means.variance();
}

TEST(Sampler, VarianceOfASmoothIntegrandFallsAsTheoryHasIt) {
  // Owen 1997, "Scrambled net variance for integrals of smooth functions": n^-3 (log n)^(s - 1); 64 times the
  // points, slope -3 + the log. The estimates of the variances are good to 5 %, so the slope to 0.02.
  const double slope_sobol =
      std::log2(variance_of_mean(SamplerKind::sobol, 256) / variance_of_mean(SamplerKind::sobol, 16)) / 4;
  EXPECT_LT(slope_sobol, -2.5);
  EXPECT_GT(slope_sobol, -3.1);
  const double slope_independent = std::log2(variance_of_mean(SamplerKind::independent, 256) /
                                             variance_of_mean(SamplerKind::independent, 16)) /
                                   4;
  EXPECT_NEAR(slope_independent, -1, 0.1);
}

TEST(Sampler, UnitFloatsStayBelowOne) {
  EXPECT_EQ(to_unit_float(0u), 0);
  EXPECT_EQ(to_unit_float(0xffffffffu), 0x1.fffffep-1f);
  EXPECT_EQ(to_unit_float(0x80000000u), 0.5f);
}

TEST(Sampler, EqualWeightsOfBitsOfTheStream) {
  // Every bit of the stream's key depends on seed, pixel and replicate: a flip of any bit of the key changes
  // each bit of the point in about half of the cases.
  for (const SamplerKind kind : samplers)
    for (int flipped = 0; flipped < 64; flipped += 7) {
      RunningStatistics share;
      for (int i = 0; i < 4096; ++i) {
        const std::uint64_t stream = sample_stream(3, i, 0, 0);
        const auto a = point(kind, stream, 1, 1),
                   b = point(kind, stream ^ (std::uint64_t(1) << flipped), 1, 1);
        share.add(double(std::popcount(a.x ^ b.x) + std::popcount(a.y ^ b.y)) / 64);
      }
      EXPECT_GT(share.mean, 0.2) << sampler_name(kind) << ", bit " << flipped;
    }
}

}  // namespace
}  // namespace etendue

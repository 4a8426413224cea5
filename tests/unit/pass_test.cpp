// Passes, tiles and threads: however a render is cut, it is the same render.
#include "render/pass.h"

#include "test_scene.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <tuple>

namespace etendue {
namespace {

/// Two lights of which one is too strong for floats, so that samples are invalid.
LoadedScene scene_with_invalid_samples(const std::string& sampler) {
  return load_scene_text(camera_xml({0, 0, 4}, {0, 0, 0}, 40, 37, sampler) +
                         rectangle_xml({0, 0, 0}, {9, 0, 0}, {0, 9, 0}, phong_xml(0.5, 0.3, 20)) +
                         sphere_xml({1, 0, 1.5}, 0.6, light_xml(3)) +
                         sphere_xml({-1, 0.5, 1}, 0.8, light_xml(3e38)));
}

RenderSettings settings_of(int samples, int replicates, ReplicatesBy by) {
  RenderSettings settings;
  settings.integrator = integrator_from_name("mis");
  settings.samples_per_pixel = samples;
  settings.replicates = replicates;
  settings.replicates_by = by;
  settings.seed = 5;
  settings.isa = available_isas().back();
  return settings;
}

bool operator==(const InvalidSample& a, const InvalidSample& b) {
  return a.x == b.x && a.y == b.y && a.replicate == b.replicate && a.index == b.index;
}

TEST(Passes, NoBitDependsOnHowTheyAreCut) {
  const ProgressCallback no_progress;
  for (const char* sampler : {"independent", "sobol"}) {
    const LoadedScene loaded = scene_with_invalid_samples(sampler);
    for (const ReplicatesBy by : {ReplicatesBy::block, ReplicatesBy::scrambling}) {
      const RenderSettings whole = settings_of(39, 13, by);
      const RenderResult expected = render(loaded.scene, whole);
      ASSERT_EQ(expected.invalid.first().size(), InvalidSamples::most_noted);
      for (const std::vector<int>& ends : {std::vector{13}, {1, 13}, {3, 4, 5, 13}, {1, 2, 4, 8, 12, 13}}) {
        RenderSettings settings = whole;
        settings.threads = int(ends.size());
        std::vector<FilmStack> stack{FilmStack(37, 37)};
        Passes passes(loaded.scene, settings, no_progress, nullptr);
        InvalidSamples invalid;
        ReplicateLuminances luminances(37, 37, 13);
        std::int64_t samples = 0;
        for (const int end : ends) {
          const PassResult pass = passes.render(stack, end, &luminances);
          EXPECT_TRUE(pass.is_complete);
          invalid.add(pass.invalid);
          samples += pass.counts.samples;
        }
        EXPECT_EQ(samples, 37 * 37 * 39);
        for (int y = 0; y < 37; ++y)
          for (int x = 0; x < 37; ++x)
            ASSERT_EQ(stack.front().pixel(x, y), expected.film.at(x, y)) << x << ' ' << y;
        for (int y = 0; y < 37; ++y)
          for (int x = 0; x < 37; ++x) {
            const std::span<const float> kept = luminances.at(x, y, 13);
            ASSERT_TRUE(std::ranges::equal(kept, expected.luminances.at(x, y, 13))) << x << ' ' << y;
            ASSERT_NEAR(std::accumulate(kept.begin(), kept.end(), 0.0) / 13,
                        luminance(expected.film.at(x, y).mean), 1e-6 * *std::ranges::max_element(kept));
          }
        EXPECT_EQ(invalid.count(), expected.invalid.count());
        for (std::size_t i = 0; i < invalid.first().size(); ++i)
          EXPECT_TRUE(invalid.first()[i] == expected.invalid.first()[i]) << i;
      }
    }
  }
}

TEST(Passes, PixelsOfAnAllocationAreThoseOfARenderOfThatManySamples) {
  const LoadedScene loaded = scene_with_invalid_samples("sobol");
  constexpr int most = 512, replicates = 4;
  std::mt19937_64 engine(11);
  RenderSettings settings = settings_of(16, replicates, ReplicatesBy::block);
  settings.allocation.emplace(37, 37, 1);
  std::int64_t samples = 0;
  for (int y = 0; y < 37; ++y)
    for (int x = 0; x < 37; ++x) {
      int& count = settings.allocation->at(x, y);
      count = engine() % 50 == 0 ? most : 1 << engine() % 5;
      samples += replicates * count;
    }
  const RenderResult mixed = render(loaded.scene, settings);
  EXPECT_EQ(mixed.counts.samples, samples);
  EXPECT_EQ(mixed.counts.camera_rays, samples);
  for (int count = 1; count <= most; count *= 2) {
    const Film uniform =
        render(loaded.scene, settings_of(replicates * count, replicates, ReplicatesBy::block)).film;
    for (int y = 0; y < 37; ++y)
      for (int x = 0; x < 37; ++x)
        if (settings.allocation->at(x, y) == count) {
          ASSERT_EQ(mixed.film.at(x, y), uniform.at(x, y)) << x << ' ' << y << ' ' << count;
        }
  }
}

TEST(Passes, FewerReplicatesAreARenderOfThatMany) {
  const LoadedScene loaded = scene_with_invalid_samples("sobol");
  for (const ReplicatesBy by : {ReplicatesBy::block, ReplicatesBy::scrambling}) {
    const Film fewer = render(loaded.scene, settings_of(15, 5, by)).film;
    const ProgressCallback no_progress;
    const RenderSettings more = settings_of(39, 13, by);
    Passes passes(loaded.scene, more, no_progress, nullptr);
    std::vector<FilmStack> stack{FilmStack(37, 37)};
    passes.render(stack, 5);
    for (int y = 0; y < 37; ++y)
      for (int x = 0; x < 37; ++x) ASSERT_EQ(stack.front().pixel(x, y), fewer.at(x, y));
  }
}

TEST(Passes, AStopAtOnceLeavesAFragmentOfTheFirstPassAndNothingOfLaterOnes) {
  const LoadedScene loaded = scene_with_invalid_samples("sobol");
  RenderSettings settings = settings_of(640, 2, ReplicatesBy::block);
  settings.threads = 1;
  StopRequest stop;
  const ProgressCallback stop_after_some = [&](const RenderProgress& progress) {
    if (progress.fraction > 0.1) stop.soon = stop.now = true;
  };
  Passes passes(loaded.scene, settings, stop_after_some, &stop);
  std::vector<FilmStack> fragment{FilmStack(37, 37)};
  const PassResult first = passes.render(fragment, 1);
  EXPECT_FALSE(first.is_complete);
  std::int64_t rendered = 0;
  for (int y = 0; y < 37; ++y)
    for (int x = 0; x < 37; ++x) rendered += fragment.front().pixel(x, y).count;
  EXPECT_GT(rendered, 0);
  EXPECT_LT(rendered, 37 * 37);
  EXPECT_EQ(first.counts.samples, rendered * 320);

  StopRequest later;
  const ProgressCallback stop_in_second_pass = [&](const RenderProgress& progress) {
    if (progress.fraction > 0.6) later.soon = later.now = true;
  };
  Passes more_passes(loaded.scene, settings, stop_in_second_pass, &later);
  std::vector<FilmStack> whole{FilmStack(37, 37)};
  EXPECT_TRUE(more_passes.render(whole, 1).is_complete);
  const PassResult second = more_passes.render(whole, 2);
  EXPECT_FALSE(second.is_complete);
  EXPECT_EQ(second.counts.samples, 0);
  EXPECT_EQ(second.counts.camera_rays, 0);
  EXPECT_EQ(whole.front().last(), 1u);
  for (int y = 0; y < 37; ++y)
    for (int x = 0; x < 37; ++x) ASSERT_EQ(whole.front().pixel(x, y).count, 1);
}

TEST(Passes, CountsOfAFragmentAreOfWhatIsInIt) {
  const LoadedScene loaded = scene_with_invalid_samples("sobol");
  RenderSettings settings = settings_of(6400, 1, ReplicatesBy::block);
  settings.threads = 4;  // So that some are in the midst of a tile when another asks for the stop.
  std::int64_t invalid = 0;
  for (const char* integrator : {"light", "mis"}) {
    settings.integrator = integrator_from_name(integrator);
    StopRequest stop;
    const ProgressCallback stop_after_some = [&](const RenderProgress& progress) {
      if (progress.fraction > 0.1) stop.soon = stop.now = true;
    };
    const RenderResult fragment = render(loaded.scene, settings, stop_after_some, &stop);
    ASSERT_TRUE(fragment.is_fragment);
    EXPECT_GT(fragment.counts.samples, 0);
    EXPECT_EQ(fragment.counts.camera_rays, fragment.counts.samples);
    invalid += fragment.invalid.count();
    for (const InvalidSample& sample : fragment.invalid.first())
      EXPECT_EQ(fragment.film.at(sample.x, sample.y).count, 1) << sample.x << ' ' << sample.y;
  }
  EXPECT_GT(invalid, 0);
}

TEST(Render, SaysWhetherItIsWhole) {
  const LoadedScene loaded = scene_with_invalid_samples("sobol");
  StopRequest stop;
  stop.soon = stop.now = true;
  const RenderResult nothing = render(loaded.scene, settings_of(16, 8, ReplicatesBy::block), {}, &stop);
  EXPECT_TRUE(nothing.is_interrupted && nothing.is_fragment);
  EXPECT_EQ(nothing.counts.samples, 0);
  const RenderResult all = render(loaded.scene, settings_of(16, 8, ReplicatesBy::block));
  EXPECT_FALSE(all.is_interrupted || all.is_fragment);
  EXPECT_EQ(all.replicates, 8);
  EXPECT_EQ(all.counts.samples, 37 * 37 * 16);
  EXPECT_EQ(all.counts.camera_rays, 37 * 37 * 16);
}

TEST(Passes, AStopSoonLetsAShortFirstPassComeToItsEnd) {
  const LoadedScene loaded = scene_with_invalid_samples("sobol");
  StopRequest stop;
  bool has_waited = false;
  const ProgressCallback stop_at_once = [&](const RenderProgress& progress) {
    has_waited = has_waited || progress.seconds_to_finish;
    stop.soon = true;
  };
  const RenderSettings settings = settings_of(640, 10, ReplicatesBy::block);
  Passes passes(loaded.scene, settings, stop_at_once, &stop);
  std::vector<FilmStack> stack{FilmStack(37, 37)};
  const PassResult first = passes.render(stack, 2);
  EXPECT_TRUE(first.is_complete && has_waited);
  EXPECT_EQ(first.counts.samples, 37 * 37 * 128);
  EXPECT_FALSE(passes.render(stack, 3).is_complete);
  for (int y = 0; y < 37; ++y)
    for (int x = 0; x < 37; ++x) ASSERT_EQ(stack.front().pixel(x, y).count, 2);
}

TEST(Passes, AStopSoonWaitsForTheSecondReplicateToo) {
  const LoadedScene loaded = scene_with_invalid_samples("sobol");
  StopRequest stop;
  stop.soon = true;
  const RenderSettings settings = settings_of(640, 10, ReplicatesBy::block);
  const ProgressCallback no_progress;
  Passes passes(loaded.scene, settings, no_progress, &stop);
  std::vector<FilmStack> stack{FilmStack(37, 37)};
  EXPECT_TRUE(passes.render(stack, 1).is_complete);
  EXPECT_TRUE(passes.render(stack, 2).is_complete);
  EXPECT_FALSE(passes.render(stack, 3).is_complete);
  stop.now = true;
  std::vector<FilmStack> hurried{FilmStack(37, 37)};
  EXPECT_FALSE(passes.render(hurried, 1).is_complete);
}

TEST(Passes, TakeAboutASecondAndEndAtRoundNumbers) {
  EXPECT_EQ(end_of_next_pass(1, 8, 0.01, 1e5), 8);
  EXPECT_EQ(end_of_next_pass(0, 5000, 0, 1), 1024);
  EXPECT_EQ(end_of_next_pass(0, 100, 0.011, 1e5), 100);
  EXPECT_EQ(end_of_next_pass(0, 2, 5, 1e5), 1);
  EXPECT_EQ(end_of_next_pass(0, 100, 5, 1e5), 1);
  EXPECT_EQ(end_of_next_pass(1, 200, 0.02, 1e5), 32);
  EXPECT_EQ(end_of_next_pass(32, 200, 0.02, 1e5), 64);
  EXPECT_EQ(end_of_next_pass(7, 100, 5, 1e5), 8);
  EXPECT_EQ(end_of_next_pass(99, 100, 5, 1e5), 100);
  EXPECT_EQ(end_of_next_pass(1, 1 << 30, 0, 1), 1024);
  for (const double seconds : {1e-4, 0.03, 0.4, 3.0})
    for (int done = 1; done < 1000;) {
      const int end = end_of_next_pass(done, 1000, seconds, 8e6);
      ASSERT_GT(end, done);
      ASSERT_TRUE((end - done) * seconds < 2 * 4.3 || end - done == 1);
      done = end;
    }
}

TEST(InvalidSamplesNoted, AreTheFirstInWhateverOrderTheyCome) {
  std::vector<InvalidSample> all;
  for (int i = 0; i < 60; ++i) all.push_back({i % 5, i / 20, i / 5 % 2, i / 10 % 2, {}});
  InvalidSamples in_order;
  for (const InvalidSample& sample : all) in_order.add(sample);
  std::mt19937_64 engine(3);
  for (int round = 0; round < 20; ++round) {
    std::shuffle(all.begin(), all.end(), engine);
    InvalidSamples parts[3], sum;
    for (std::size_t i = 0; i < all.size(); ++i) parts[engine() % 3].add(all[i]);
    for (const InvalidSamples& part : parts) sum.add(part);
    EXPECT_EQ(sum.count(), 60);
    ASSERT_EQ(sum.first().size(), InvalidSamples::most_noted);
    for (std::size_t i = 0; i < sum.first().size(); ++i) {
      const InvalidSample& sample = sum.first()[i];
      EXPECT_TRUE(sample == in_order.first()[i]);
      EXPECT_EQ(sample.y, 0);
      if (i > 0) {
        const InvalidSample& before = sum.first()[i - 1];
        EXPECT_LT(std::tie(before.x, before.replicate, before.index),
                  std::tie(sample.x, sample.replicate, sample.index));
      }
    }
  }
}

}  // namespace
}  // namespace etendue

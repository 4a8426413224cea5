// A student's integrator and the program's `light` estimate one image: Welch's t-test, block by block.
//
// False-alarm rate: 1e-5 for both scenes together (Sidak over scenes, blocks and channels); fixed seeds.
// Seen to fail when: Mesh::pdf is that of a single triangle; triangles of a mesh are chosen alike; the
// student's code leaves 1/n of n lights out; it asks the BSDF in world directions.
#include "film_statistics.h"
#include "stats/significance.h"
#include "stats/t_test.h"
#include "support/course_module.h"
#include "test_scene.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

void set_integer(Object& object, const std::string& name, int value) {
  for (Property& property : object.properties)
    if (property.name == name) property.value = value;
}

/// At 96 x 64 pixels.
LoadedScene small_exercise_scene(const std::string& name) {
  SceneDesc description = read_nori_xml(ETENDUE_SOURCE_DIR "/scenes/ex3/" + name);
  for (Object& child : description.root.children) {
    if (child.family != "camera") continue;
    set_integer(child, "width", 96);
    set_integer(child, "height", 64);
  }
  return load_scene(description);
}

class StudentLight : public ::testing::TestWithParam<const char*> {};

TEST_P(StudentLight, IsTheProgramsLight) {
  const LoadedScene loaded = small_exercise_scene(GetParam());
  constexpr int samples = 256, block_px = 16, tests = 2 * 24 * 3;
  constexpr double level = 1e-5;
  RenderSettings settings = render_settings("light", samples, 16, 1);
  const RenderResult own = render(loaded.scene, settings);
  settings.integrator =
      settings_of(test::student_integrator("light_integrator", loaded), loaded.scene.sampler);
  settings.seed = 2;
  const RenderResult students = render(loaded.scene, settings);
  EXPECT_EQ(students.invalid.count(), 0);
  for (int y = 0; y < own.film.height(); y += block_px)
    for (int x = 0; x < own.film.width(); x += block_px)
      for (const Channel64 channel : channels64) {
        const RunningStatistics a = block_mean(students.film, x, y, block_px, channel),
                                b = block_mean(own.film, x, y, block_px, channel);
        EXPECT_FALSE(is_rejected(welch_t_test(a, b).p_value, level, tests))
            << "block at " << x << ", " << y << ": the student's " << a.mean << " +- " << a.standard_error()
            << ", light " << b.mean << " +- " << b.standard_error();
      }
}

INSTANTIATE_TEST_SUITE_P(Ex3, StudentLight, ::testing::Values("area_sampling.xml", "phong_plates.xml"),
                         [](const auto& info) { return std::filesystem::path(info.param).stem().string(); });

}  // namespace
}  // namespace etendue

#include "course/scene_check.h"

#include "course/student_integrator.h"
#include "film/block_mean.h"
#include "render/render.h"
#include "scene/load_scene.h"
#include "scenefile/nori_xml.h"
#include "stats/significance.h"
#include "stats/t_test.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace etendue {

namespace {

constexpr int width_px = 96, block_px = 16, samples_per_pixel = 64;

LoadedScene small_scene(const std::filesystem::path& file) {
  SceneDesc description = read_nori_xml(file);
  for (Object& child : description.root.children) {
    if (child.family != "camera") continue;
    int width = 0;
    for (const Property& property : child.properties)
      if (property.name == "width") width = std::get<int>(property.value);
    for (Property& property : child.properties)
      if (property.name == "width" || property.name == "height")
        property.value = std::max(1, std::get<int>(property.value) * width_px / std::max(width, 1));
  }
  return load_scene(description);
}

Image image_of(const Film& film, double exposure) {
  Image image{film.width(), film.height(), {{"R", {}}, {"G", {}}, {"B", {}}}, {}};
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x)
      for (std::size_t c = 0; c < 3; ++c)
        image.channels[c].values.push_back(float(exposure * (film.at(x, y).mean.*channels64[c])));
  return image;
}

double luminance_of(const PixelStatistics& pixel) { return luminance(pixel.mean); }

/// Of each pixel's neighbourhood: grey where both are alike, blue where the student's is darker, red where
/// it is brighter; black where there is no light.
Image difference_of(const Film& students, const Film& lights) {
  Image image{lights.width(), lights.height(), {{"R", {}}, {"G", {}}, {"B", {}}}, {}};
  constexpr int reach = 1;
  for (int y = 0; y < lights.height(); ++y)
    for (int x = 0; x < lights.width(); ++x) {
      double mine = 0, right = 0;
      for (int j = std::max(y - reach, 0); j <= std::min(y + reach, lights.height() - 1); ++j)
        for (int i = std::max(x - reach, 0); i <= std::min(x + reach, lights.width() - 1); ++i) {
          mine += luminance_of(students.at(i, j));
          right += luminance_of(lights.at(i, j));
        }
      const double sum = std::abs(mine) + right;
      const double off = sum > 0 ? std::clamp((mine - right) / sum, -1.0, 1.0) : 0;
      const double grey = sum > 0 ? 0.25 : 0;
      image.channels[0].values.push_back(float(grey + (off > 0 ? 0.75 * off : 0.25 * off)));
      image.channels[1].values.push_back(float(grey - 0.25 * std::abs(off)));
      image.channels[2].values.push_back(float(grey + (off < 0 ? -0.75 * off : -0.25 * off)));
    }
  return image;
}

/// At which a bright place is white: a tenth of the pixels may be brighter.
double exposure_for(const Film& film) {
  std::vector<double> luminances;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) luminances.push_back(luminance_of(film.at(x, y)));
  const auto bright = luminances.begin() + std::ptrdiff_t(luminances.size() * 9 / 10);
  std::nth_element(luminances.begin(), bright, luminances.end());
  return *bright > 0 ? 0.6 / *bright : 1;
}

}  // namespace

SceneCheck check_scene(const StudentModule& module, const std::string& integrator,
                       const std::filesystem::path& scene, std::uint64_t seed, int scenes) {
  const LoadedScene loaded = small_scene(scene);
  RenderSettings settings;
  settings.integrator = integrator_from_name("light");
  settings.samples_per_pixel = samples_per_pixel;
  settings.replicates = 16;
  settings.replicates_by = ReplicatesBy::scrambling;
  settings.isa = available_isas().back();
  settings.seed = 2 * seed;
  const RenderResult lights = render(loaded.scene, settings);
  settings.integrator = settings_of(std::make_shared<const StudentIntegrator>(
                                        module, integrator, loaded.scene, loaded.places, loaded.integrator),
                                    loaded.scene.sampler);
  settings.seed = 2 * seed + 1;
  const RenderResult students = render(loaded.scene, settings);

  const int columns = (lights.film.width() + block_px - 1) / block_px,
            rows = (lights.film.height() + block_px - 1) / block_px;
  SceneCheck check;
  CheckedProperty& property = check.property;
  property = {"scene " + scene.stem().string(), PropertyVerdict::right, "", 3LL * columns * rows, 1};
  double ratio_students = 0, ratio_lights = 0, error_sq = 0;
  int wrong_blocks = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      bool is_wrong = false;
      for (const Channel64 channel : channels64) {
        const RunningStatistics mine = block_mean(students.film, column * block_px, row * block_px, block_px,
                                                  channel),
                                right = block_mean(lights.film, column * block_px, row * block_px, block_px,
                                                   channel);
        ratio_students += mine.mean;
        ratio_lights += right.mean;
        error_sq += mine.variance() / double(mine.count) + right.variance() / double(right.count);
        const double p = welch_t_test(mine, right).p_value;
        property.p_value = std::min(property.p_value, std::isfinite(p) ? p : 0);
        is_wrong |= is_rejected(p, level_of_scenes, scenes * property.tests);
      }
      wrong_blocks += is_wrong;
    }
  if (wrong_blocks > 0 || students.invalid.count() > 0) property.verdict = PropertyVerdict::wrong;
  property.what = fmt::format(
      "{} of {} blocks differ from the program's; brightness over all is {:.4f} +- {:.2g} of it",
      wrong_blocks, columns * rows, ratio_students / ratio_lights, std::sqrt(error_sq) / ratio_lights);
  if (students.invalid.count() > 0)
    property.what += fmt::format("; {} invalid samples", students.invalid.count());
  const double exposure = exposure_for(lights.film);
  check.students = image_of(students.film, exposure);
  check.lights = image_of(lights.film, exposure);
  check.difference = difference_of(students.film, lights.film);
  check.seconds_students = students.seconds;
  check.seconds_lights = lights.seconds;
  return check;
}

}  // namespace etendue

#include "render_outputs.h"

#include "image/image_file.h"
#include "output_files.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <system_error>

namespace etendue::app {

namespace {

Image to_image(const Film& film) {
  Image image;
  image.width = film.width();
  image.height = film.height();
  const auto size = std::size_t(film.width()) * std::size_t(film.height());
  for (const char* name : {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"})
    image.channels.push_back({name, std::vector<float>(size)});
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const PixelStatistics& pixel = film.at(x, y);
      const Color<double> error = standard_error(pixel);
      const std::size_t at = std::size_t(y) * std::size_t(film.width()) + std::size_t(x);
      const std::array values{pixel.mean.r, pixel.mean.g, pixel.mean.b, error.r, error.g, error.b};
      for (std::size_t c = 0; c < values.size(); ++c) image.channels[c].values[at] = float(values[c]);
    }
  return image;
}

std::vector<std::pair<std::string, std::string>> metadata(const Rendering& rendering) {
  const RenderSettings& settings = rendering.settings;
  std::vector<std::pair<std::string, std::string>> fields{
      {"scene", rendering.options.scene_file},
      {"sceneHash", fmt::format("{:016x}", rendering.scene_hash)},
      {"seed", std::to_string(settings.seed)},
      {"replicates", fmt::format("0-{}", rendering.result.replicates - 1)},
      {"replicatesBy", std::string(replicates_by_name(settings.replicates_by))},
      {"samplesPerPixel", std::to_string(rendering.samples_per_pixel())},
      {"integrator", std::string(settings.integrator.name)},
      {"isa", std::string(isa_name(settings.isa))},
      {"dialect", std::string(dialect_name(rendering.description.dialect))},
      {"sampler", std::string(sampler_name(rendering.loaded.scene.sampler))},
      {"software", "Etendue " ETENDUE_VERSION}};
  if (rendering.result.is_fragment)
    fields.emplace_back("pixelsNotRendered",
                        std::to_string(rendering.pixels() - rendering.pixels_rendered()));
  if (const std::string_view heuristic = heuristic_name(settings.integrator); !heuristic.empty())
    fields.emplace_back("heuristic", heuristic);
  if (const std::string_view light_sampler = settings.integrator.light_sampler(); !light_sampler.empty())
    fields.emplace_back("lightSampler", light_sampler);
  return fields;
}

/// Where an image goes that was asked for as `output`.
std::string destination_of(const std::string& output, const RenderResult& result) {
  std::error_code error;
  const bool keeps_place =
      !result.is_interrupted || (!result.is_fragment && !std::filesystem::exists(output, error));
  return keeps_place ? output : partial_name(output);
}

void say_what_was_saved(const Rendering& rendering, const std::vector<std::string>& saved) {
  const RenderResult& result = rendering.result;
  if (!result.is_interrupted || rendering.options.is_quiet || saved.empty()) return;
  const std::string samples = fmt::format("{} of {} replicates, {} of {} samples a pixel", result.replicates,
                                          rendering.settings.replicate_count(), rendering.samples_per_pixel(),
                                          rendering.settings.samples_per_pixel);
  if (result.is_fragment)
    fmt::print(
        stderr,
        "saved {} of {} pixels ({}) to {}; the others have radiance 0 and a standard error that is not a "
        "number\n",
        rendering.pixels_rendered(), rendering.pixels(), samples, fmt::join(saved, ", "));
  else
    fmt::print(stderr, "saved the whole image ({}) to {}\n", samples, fmt::join(saved, ", "));
  for (const std::string& output : rendering.options.outputs)
    if (std::error_code error;
        destination_of(output, result) != output && std::filesystem::exists(output, error))
      fmt::print(stderr, "{} is kept as it was\n", output);
}

}  // namespace

std::string partial_name(const std::string& output) {
  std::filesystem::path partial = output;
  const std::string ending = partial.extension().string();
  return partial.replace_extension(".partial" + ending).string();
}

std::vector<std::string> files_written(const RenderOptions& options) {
  std::vector<std::string> files = options.outputs;
  for (const std::string& output : options.outputs) files.push_back(partial_name(output));
  if (!options.stats_file.empty()) files.push_back(options.stats_file);
  return files;
}

bool write_outputs(const Rendering& rendering) {
  Image image = to_image(rendering.result.film);
  image.metadata = metadata(rendering);
  bool is_all_written = true;
  const auto is_written = [&](const auto& write) {
    try {
      write();
      return true;
    } catch (const InputError& error) {
      fmt::print(stderr, "error: {}\n", error.what());
      return is_all_written = false;
    }
  };
  std::vector<std::string> saved;
  for (const std::string& output : rendering.options.outputs) {
    const std::string file = destination_of(output, rendering.result);
    const bool is_png = image_format(file) == ImageFormat::png;
    if (is_written([&] { is_png ? write_png(file, image) : write_exr(file, image); })) saved.push_back(file);
  }
  say_what_was_saved(rendering, saved);
  if (const std::string& file = rendering.options.stats_file; !file.empty())
    is_written([&] { write_text_file(file, stats(rendering).dump(2) + "\n"); });
  return is_all_written;
}

}  // namespace etendue::app

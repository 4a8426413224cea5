#include "render_outputs.h"

#include "image/image_file.h"
#include "messages.h"
#include "output_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <system_error>

namespace etendue::app {

namespace {

Image to_image(const Film& film, const std::vector<PixelInterval>& intervals) {
  Image image;
  image.width = film.width();
  image.height = film.height();
  for (const char* name : {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B", "stderr.Y", "interval.R",
                           "interval.G", "interval.B", "interval.Y", "interval.trust"})
    image.channels.push_back({name, std::vector<float>(intervals.size())});
  for (std::size_t at = 0; at < intervals.size(); ++at) {
    const PixelStatistics& pixel =
        film.at(int(at % std::size_t(film.width())), int(at / std::size_t(film.width())));
    const Color<double> error = standard_error(pixel);
    const PixelInterval& interval = intervals[at];
    const std::array values{
        float(pixel.mean.r),   float(pixel.mean.g),   float(pixel.mean.b),           float(error.r),
        float(error.g),        float(error.b),        interval.luminance_error,      interval.half_width.r,
        interval.half_width.g, interval.half_width.b, interval.luminance_half_width, float(interval.rule)};
    for (std::size_t c = 0; c < values.size(); ++c) image.channels[c].values[at] = values[c];
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
      {"confidence", fmt::format("{}", rendering.options.confidence)},
      {"samplesPerPixel", std::to_string(rendering.samples_per_pixel())},
      {"integrator", std::string(settings.integrator.name)},
      {"isa", std::string(isa_name(settings.isa))},
      {"dialect", std::string(dialect_name(rendering.description.dialect))},
      {"sampler", std::string(sampler_name(rendering.loaded.scene.sampler))},
      {"software", "Etendue " ETENDUE_VERSION}};
  if (const auto* rules = std::get_if<SingleRays>(&settings.integrator.rules))
    fields.emplace_back("plugin", rules->plugin);
  if (rendering.result.is_fragment)
    fields.emplace_back("pixelsNotRendered",
                        std::to_string(rendering.pixels() - rendering.pixels_rendered()));
  if (const std::string_view heuristic = heuristic_name(settings.integrator); !heuristic.empty())
    fields.emplace_back("heuristic", heuristic);
  if (const std::string_view light_sampler = settings.integrator.light_sampler(); !light_sampler.empty())
    fields.emplace_back("lightSampler", light_sampler);
  if (const std::string_view technique = settings.integrator.light_technique(); !technique.empty())
    fields.emplace_back("technique", technique);
  if (const PathRules* rules = rendering.light_rules()) {
    fields.emplace_back("lightSamples", std::to_string(rules->light_count(0)));
    fields.emplace_back("candidates", std::to_string(rules->candidates(0)));
    fields.emplace_back("glossyCandidates", std::to_string(rules->glossy_candidates(0)));
    fields.emplace_back("bsdfSamples", std::to_string(rules->bsdf_samples(0)));
  }
  return fields;
}

/// Where an image goes that was asked for as `output`.
std::string destination_of(const std::string& output, const RenderResult& result) {
  std::error_code error;
  const bool keeps_place =
      !result.is_interrupted || (!result.is_fragment && !std::filesystem::exists(output, error));
  return keeps_place ? output : partial_name(output);
}

bool went_elsewhere(const WrittenFile& file) { return file.name != file.asked_for; }

void say_what_is_kept(const WrittenFile& file) {
  std::error_code error;
  if (went_elsewhere(file) && std::filesystem::exists(file.asked_for, error))
    say("{} is kept as it was\n", file.asked_for);
  if (const std::string partial = partial_name(file.asked_for);
      !went_elsewhere(file) && std::filesystem::exists(partial, error))
    say("{} is of an earlier render that was interrupted, and may be removed\n", partial);
}

std::string samples_text(const Rendering& rendering) {
  return fmt::format("{} of {} replicates, {} of {} samples a pixel", rendering.result.replicates,
                     rendering.settings.replicate_count(), rendering.samples_per_pixel(),
                     rendering.settings.samples_per_pixel);
}

void say_what_images_hold(const Rendering& rendering, const std::vector<WrittenFile>& images) {
  const RenderResult& result = rendering.result;
  std::vector<std::string> names;
  for (const WrittenFile& image : images) names.push_back(image.name);
  if (rendering.pixels_rendered() == 0)
    say("no pixel was rendered; no image is saved\n");
  else if (names.empty())
    return;
  else if (result.is_fragment)
    say("saved {} of {} pixels (of these {}) to {}; the others have radiance 0 and a standard error that is "
        "not a number\n",
        rendering.pixels_rendered(), rendering.pixels(), samples_text(rendering), fmt::join(names, ", "));
  else
    say("saved the whole image ({}) to {}{}\n", samples_text(rendering), fmt::join(names, ", "),
        result.replicates == 1 ? "; its error is unknown: it takes two replicates to tell" : "");
}

}  // namespace

std::string partial_name(const std::string& output) {
  std::filesystem::path partial = output;
  const std::string ending = partial.extension().string();
  return partial.replace_extension(".partial" + ending).string();
}

std::vector<std::string> files_written(const RenderOptions& options) {
  std::vector<std::string> files = options.outputs;
  if (!options.stats_file.empty()) files.push_back(options.stats_file);
  for (std::size_t k = 0, asked_for = files.size(); k < asked_for; ++k)
    files.push_back(partial_name(files[k]));
  return files;
}

WrittenFiles write_outputs(const Rendering& rendering) {
  const RenderResult& result = rendering.result;
  WrittenFiles written;
  const auto write = [&](const WrittenFile& file, std::vector<WrittenFile>& list, const auto& write_to) {
    try {
      write_to(file.name);
      list.push_back(file);
    } catch (const InputError& error) {
      say("error: {}\n", error.what());
      written.are_all = false;
    }
  };
  // All are settled before the first is written: an image must not stand in its own way.
  std::vector<WrittenFile> images;
  for (const std::string& output : rendering.options.outputs)
    images.push_back({output, destination_of(output, result)});
  const bool is_partial = std::any_of(images.begin(), images.end(), went_elsewhere);
  if (rendering.pixels_rendered() > 0) {
    Image image = to_image(result.film, rendering.errors.intervals);
    for (Channel& channel : layer_channels(rendering.layers.of_image, rendering.loaded.scene,
                                           {rendering.settings, result, rendering.errors.intervals}))
      image.channels.push_back(std::move(channel));
    image.metadata = metadata(rendering);
    for (const WrittenFile& file : images)
      write(file, written.images, [&](const std::string& name) {
        image_format(name) == ImageFormat::png ? write_png(name, image) : write_exr(name, image);
      });
  }
  if (const std::string& file = rendering.options.stats_file; !file.empty())
    write({file, is_partial ? partial_name(file) : file}, written.stats,
          [&](const std::string& name) { write_text_file(name, stats(rendering).dump(2) + "\n"); });
  return written;
}

void say_what_was_saved(const Rendering& rendering, const WrittenFiles& written) {
  const bool is_as_asked_for = rendering.pixels_rendered() > 0 &&
                               std::none_of(written.images.begin(), written.images.end(), went_elsewhere);
  if (rendering.options.is_quiet && is_as_asked_for) return;
  if (rendering.result.is_interrupted) say_what_images_hold(rendering, written.images);
  for (const WrittenFile& file : written.stats)
    if (went_elsewhere(file)) say("saved what --stats asks for to {}\n", file.name);
  for (const std::vector<WrittenFile>* files : {&written.images, &written.stats})
    for (const WrittenFile& file : *files) say_what_is_kept(file);
}

}  // namespace etendue::app

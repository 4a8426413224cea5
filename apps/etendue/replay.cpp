#include "replay.h"

#include "base/error.h"

#include <charconv>
#include <fmt/format.h>
#include <vector>

namespace etendue::app {

namespace {

std::string text(const Vec3f& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }
/// A place of the scene, as the file's world has it.
std::string place_text(const Scene& scene, const Vec3f& p) {
  const Vec3<double>& origin = scene.origin;
  if (length_sq(origin) == 0) return text(p);
  return fmt::format("{:.12g} {:.12g} {:.12g}", origin.x + p.x, origin.y + p.y, origin.z + p.z);
}
std::string text(const Colorf& c) { return fmt::format("{} {} {}", c.r, c.g, c.b); }

std::string light_text(const Scene& scene, std::int32_t light) {
  return light < 0 ? "no light" : fmt::format("light '{}'", scene.lights.name(light));
}

std::string light_sample_text(const Scene& scene, const SampleTrace::LightSample& sample) {
  std::string shadow_ray = !sample.is_shadow_ray_cast ? "not cast: nothing to add"
                           : sample.is_visible        ? "free"
                                                      : "blocked";
  if (sample.hidden_by)
    shadow_ray +=
        fmt::format(" by shape {}, triangle {}", sample.hidden_by->geometry + 1, sample.hidden_by->primitive);
  return fmt::format(
      "  light sample      {}\n"
      "    end             {} m\n"
      "    pdf             {} 1/sr\n"
      "    radiance / pdf  {}\n"
      "    unshadowed      {} (with BSDF, cosine, weight and throughput)\n"
      "    shadow ray      {}\n",
      light_text(scene, sample.light), place_text(scene, sample.end), sample.pdf_solid_angle,
      text(sample.radiance_over_pdf), text(sample.unshadowed), shadow_ray);
}

std::string bsdf_sample_text(const SampleTrace::BsdfSample& sample) {
  return fmt::format(
      "  BSDF sample\n"
      "    direction       {}\n"
      "    pdf             {} 1/sr\n"
      "    throughput      {} (of the path)\n"
      "    path            {}\n",
      text(sample.direction), sample.pdf_solid_angle, text(sample.throughput),
      sample.is_followed ? "goes on" : "ends");
}

std::string vertex_text(const Scene& scene, const SampleTrace::Vertex& vertex) {
  std::string all = vertex.branch == 0
                        ? fmt::format("vertex {}\n", vertex.number)
                        : fmt::format("vertex {}, BSDF sample {}\n", vertex.number, vertex.branch);
  switch (vertex.kind) {
    case SampleTrace::Vertex::Kind::nothing:
      all += "  hit               nothing\n";
      break;
    case SampleTrace::Vertex::Kind::medium:
      all += fmt::format("  in the medium     {} m\n", place_text(scene, vertex.position));
      break;
    case SampleTrace::Vertex::Kind::surface:
      all += fmt::format(
          "  hit               shape {}, triangle {}, material {}, {}\n"
          "  position          {} m\n"
          "  ng                {}\n"
          "  ns                {}\n",
          vertex.surface->geometry + 1, vertex.surface->primitive, vertex.surface->material,
          light_text(scene, vertex.surface->light), place_text(scene, vertex.position),
          text(vertex.surface->ng), text(vertex.surface->ns));
  }
  if (vertex.light_sample) all += light_sample_text(scene, *vertex.light_sample);
  if (vertex.bsdf_sample) all += bsdf_sample_text(*vertex.bsdf_sample);
  return all + fmt::format("  radiance so far   {}\n", text(vertex.radiance));
}

}  // namespace

SampleId sample_id_from_text(const std::string& text) {
  std::vector<std::int64_t> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at <= end) {
    std::int64_t number = 0;
    const auto [stop, error] = std::from_chars(at, end, number);
    if (error != std::errc() || (stop != end && *stop != ',')) break;
    numbers.push_back(number);
    at = stop + 1;
  }
  constexpr std::int64_t most = 1 << 30;
  if (at != end + 1 || numbers.size() != 4 || numbers[0] < -most || numbers[0] > most || numbers[1] < -most ||
      numbers[1] > most)
    throw InputError(
        fmt::format("--replay {}: expected X,Y,REPLICATE,SAMPLE: four whole numbers from 0 on", text));
  return {int(numbers[0]), int(numbers[1]), numbers[2], numbers[3]};
}

std::string describe(const Scene& scene, const SampleId& sample, const SampleTrace& trace) {
  std::string all = fmt::format(
      "pixel {},{} replicate {} sample {}\n"
      "film                {} {} px\n"
      "camera ray\n"
      "  origin            {} m\n"
      "  direction         {}\n",
      sample.x, sample.y, sample.replicate, sample.index, trace.x_px, trace.y_px,
      place_text(scene, trace.ray_origin), text(trace.ray_direction));
  for (const SampleTrace::Vertex& vertex : trace.vertices) all += vertex_text(scene, vertex);
  return all + fmt::format("radiance            {}\n", text(trace.radiance));
}

}  // namespace etendue::app

// A kernel that errs as renderers do, to see `etendue verify` find it: the sound stages, some of them behind
// a wrapper that does the mistake which the environment variable ETENDUE_PLANTED_BUG names. Loaded in place
// of the sound kernel by programs that find this folder first; docs/verify.md lists the mistakes.
#include "integrator/path_rules.h"
#include "integrator/vertex.h"
#include "lightsampler/light_sampler.h"

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

namespace etendue {

enum class Bug {
  none,
  no_light_pmf,              // 1 / pmf of the chosen light forgotten
  pmf_of_another_sampler,    // lights chosen by power or tree, divided by the pmf of uniform
  number_reused,             // the number that chose the light places the point too, not stretched
  light_never_chosen,        // the last light
  tree_blind,                // tree importance 0 where light arrives: on surfaces that lean; not with one facet
  points_not_uniform,        // denser on one side of the light than the density says
  area_of_one_triangle,      // of a light of two: its light samples are worth half
  cosine_twice,              // at the receiver
  cosine_missing,            // at the receiver
  geometric_cosine,          // geometric in place of shading normal
  distance_not_squared,      // 1 / r in place of 1 / r^2
  factor_2,                  // the light counted twice
  one_over_pi_missing,       // of light samples
  no_shadow_ray,             // nothing hides lights
  shadow_ray_too_short,      // ends half-way
  shadow_ray_too_long,       // meets the light itself
  self_shadow,               // starts below the surface where light comes in flat
  samples_not_averaged,      // several light samples of a vertex added up
  technique_density,         // 3 % off for all techniques but area
  mis_density_of_one_side,   // 5 % off
  mis_without_pmf,           // weights of met light without the light's pmf
  mis_light_side_in_full,    // light samples not weighted
  mis_met_side_in_full,      // met light not weighted
  mis_heuristics_mixed,      // balance on one side, power on the other
  bsdf_cosine_missing,       // of BSDF samples
  bsdf_pdf_of_one_lobe,      // weights with half of the BSDF's density
  resampling_divided_twice,  // by the number of candidates
};

namespace {

struct NamedBug {
  std::string_view name;
  Bug bug;
};
constexpr NamedBug named_bugs[]{
    {"none", Bug::none},
    {"no_light_pmf", Bug::no_light_pmf},
    {"pmf_of_another_sampler", Bug::pmf_of_another_sampler},
    {"number_reused", Bug::number_reused},
    {"light_never_chosen", Bug::light_never_chosen},
    {"tree_blind", Bug::tree_blind},
    {"points_not_uniform", Bug::points_not_uniform},
    {"area_of_one_triangle", Bug::area_of_one_triangle},
    {"cosine_twice", Bug::cosine_twice},
    {"cosine_missing", Bug::cosine_missing},
    {"geometric_cosine", Bug::geometric_cosine},
    {"distance_not_squared", Bug::distance_not_squared},
    {"factor_2", Bug::factor_2},
    {"one_over_pi_missing", Bug::one_over_pi_missing},
    {"no_shadow_ray", Bug::no_shadow_ray},
    {"shadow_ray_too_short", Bug::shadow_ray_too_short},
    {"shadow_ray_too_long", Bug::shadow_ray_too_long},
    {"self_shadow", Bug::self_shadow},
    {"samples_not_averaged", Bug::samples_not_averaged},
    {"technique_density", Bug::technique_density},
    {"mis_density_of_one_side", Bug::mis_density_of_one_side},
    {"mis_without_pmf", Bug::mis_without_pmf},
    {"mis_light_side_in_full", Bug::mis_light_side_in_full},
    {"mis_met_side_in_full", Bug::mis_met_side_in_full},
    {"mis_heuristics_mixed", Bug::mis_heuristics_mixed},
    {"bsdf_cosine_missing", Bug::bsdf_cosine_missing},
    {"bsdf_pdf_of_one_lobe", Bug::bsdf_pdf_of_one_lobe},
    {"resampling_divided_twice", Bug::resampling_divided_twice},
};

Bug planted() {
  static const Bug bug = [] {
    const char* const value = std::getenv("ETENDUE_PLANTED_BUG");
    const std::string_view name = value ? value : "none";
    for (const NamedBug& named : named_bugs)
      if (named.name == name) return named.bug;
    throw std::invalid_argument("unknown planted bug " + std::string(name));
  }();
  return bug;
}
bool is_planted(Bug bug) { return planted() == bug; }

/// Chooses as the sampler of the render does, or wrongly.
class PlantedLightSampler {
 public:
  PlantedLightSampler(const LightSampler& sound, std::int32_t lights) : sound_(sound), lights_(lights) {}

  template <class F>
  LightChoice<F> choose(const Receiver<F>& receiver, const UInt<F>& u, std::int32_t pass) const {
    LightChoice<F> choice = sound_.choose<F>(receiver, u, pass);
    const Mask<F> is_last = equal(choice.light, Int<F>(lights_ - 1));
    const bool is_single = sound_.passes() == 1;
    switch (planted()) {
      case Bug::no_light_pmf:
        if (is_single) choice.pmf = select(choice.pmf > F(0), F(1), F(0));
        break;
      case Bug::pmf_of_another_sampler:
        if (is_single) choice.pmf = select(choice.pmf > F(0), F(1 / float(lights_)), F(0));
        break;
      case Bug::number_reused:
        choice.u_left = u;
        break;
      case Bug::light_never_chosen:
        choice.pmf = select(is_last, F(0), choice.pmf);
        break;
      case Bug::tree_blind:
        if (sound_.tree()) choice.pmf = select(mask_and(is_last, receiver.ns.y < F(0.7f)), F(0), choice.pmf);
        break;
      default:
        break;
    }
    return choice;
  }

 private:
  const LightSampler& sound_;
  std::int32_t lights_;
};

}  // namespace

}  // namespace etendue

#define light_sample_weight sound_light_sample_weight
#define met_light_weight sound_met_light_weight
#include "integrator/weights.h"
#undef light_sample_weight
#undef met_light_weight

namespace etendue {

template <class F, class Function>
F light_sample_weight(const PathRules& rules, const F& pdf_light, Function&& pdf_bsdf) {
  if (is_planted(Bug::mis_light_side_in_full) && rules.needs_both_pdfs()) return F(1);
  const float factor = is_planted(Bug::mis_density_of_one_side) ? 1.05f : 1.0f;
  return sound_light_sample_weight<F>(rules, pdf_light * F(factor), pdf_bsdf);
}

template <class F, class Function>
F met_light_weight(const PathRules& rules, const F& pdf_bsdf, const Mask<F>& m, Function&& pdf_light) {
  if (is_planted(Bug::mis_met_side_in_full) && rules.needs_both_pdfs()) return F(1);
  if (is_planted(Bug::mis_heuristics_mixed) && rules.needs_both_pdfs()) {
    const bool is_power = *rules.heuristic() == Heuristic::power;
    const PathRules mixed = rules.with_heuristic(is_power ? Heuristic::balance : Heuristic::power);
    return sound_met_light_weight<F>(mixed, pdf_bsdf, m, pdf_light);
  }
  const float factor = is_planted(Bug::mis_without_pmf) ? 3.0f : 1.0f;
  return sound_met_light_weight<F>(rules, pdf_bsdf, m, [&] { return pdf_light() * F(factor); });
}

}  // namespace etendue

#define LightSampler PlantedLightSampler
#define sample_direct_light sound_sample_direct_light
#include "integrator/direct_light.h"
#undef LightSampler
#undef sample_direct_light

namespace etendue {

template <class F>
DirectLightSample<F> sample_direct_light(const Scene& scene, const LightSampler& light_sampler,
                                         const PathRules& rules, int vertex_number, const F& share,
                                         const Vertex<F>& vertex, const Receiver<F>& receiver,
                                         const Vec2<UInt<F>>& u_light, std::int32_t pass,
                                         const Mask<F>& lanes) {
  const PlantedLightSampler sampler(light_sampler, scene.lights.count());
  Vec2<UInt<F>> u = u_light;
  if (is_planted(Bug::points_not_uniform)) u.y = mul_hi(u.y, u.y);
  DirectLightSample<F> sample = sound_sample_direct_light<F>(scene, sampler, rules, vertex_number, share,
                                                             vertex, receiver, u, pass, lanes);
  const F cosine = max(abs(dot(vertex.ns, sample.light.wi)), F(1e-3f)),
          geometric = abs(dot(vertex.ng, sample.light.wi)), distance = length(sample.along);
  F factor(1);
  switch (planted()) {
    case Bug::area_of_one_triangle:
      factor = select(equal(sample.light.light, Int<F>(0)), F(0.5f), F(1));
      break;
    case Bug::cosine_twice:
      factor = cosine;
      break;
    case Bug::cosine_missing:
      factor = F(1) / cosine;
      break;
    case Bug::geometric_cosine:
      factor = geometric / cosine;
      break;
    case Bug::distance_not_squared:
      factor = distance;
      break;
    case Bug::factor_2:
      factor = F(2);
      break;
    case Bug::one_over_pi_missing:
      factor = F(pi);
      break;
    case Bug::no_shadow_ray:
      sample.along = sample.along * F(1e-4f);
      break;
    case Bug::shadow_ray_too_short:
      sample.along = sample.along * F(0.5f);
      break;
    case Bug::shadow_ray_too_long:
      sample.along = sample.along * F(1.01f);
      break;
    case Bug::self_shadow:
      factor = select(geometric < F(0.2f), F(0), F(1));
      break;
    case Bug::samples_not_averaged:
      factor = F(float(rules.light_count(vertex_number)));
      break;
    case Bug::technique_density:
      factor = F(rules.light_samples()->technique == LightTechnique::area ? 1.0f : 1.03f);
      break;
    default:
      break;
  }
  sample.unshadowed = sample.unshadowed * factor;
  return sample;
}

}  // namespace etendue

#define ResampledLight SoundResampledLight
#include "integrator/resampling.h"
#undef ResampledLight

namespace etendue {

template <class F>
class ResampledLight : public SoundResampledLight<F> {
 public:
  explicit ResampledLight(const F& u_selection) : SoundResampledLight<F>(u_selection) {}

  void offer(const DirectLightSample<F>& candidate) {
    SoundResampledLight<F>::offer(candidate);
    ++offered_;
  }
  DirectLightSample<F> take() const {
    DirectLightSample<F> sample = SoundResampledLight<F>::take();
    if (is_planted(Bug::resampling_divided_twice))
      sample.unshadowed = sample.unshadowed * F(1 / float(offered_));
    return sample;
  }

 private:
  int offered_ = 0;
};

}  // namespace etendue

#define sample_bsdf sound_sample_bsdf
#include "integrator/bsdf_stage.h"
#undef sample_bsdf

namespace etendue {

template <class F>
void sample_bsdf(const Scene& scene, SampleBlock& block, const PathRules& rules, int vertex_number) {
  sound_sample_bsdf<F>(scene, block, rules, vertex_number);
  PathColumns& path = block.path;
  if (is_planted(Bug::bsdf_pdf_of_one_lobe))
    for (int i = 0; i < path.padded_count; ++i) path.pdf[i] *= 0.5f;
  if (!is_planted(Bug::bsdf_cosine_missing)) return;
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const Vertex<F> vertex(scene, load_ray<F>(path.ray, i), load_hit<F>(path.hit, i));
    const Vec3<F> wi = load_lanes<F>(block.next_ray.direction, i);
    const F cosine = max(abs(dot(vertex.ns, wi)), F(1e-3f));
    store_lanes(path.throughput, i, load_lanes<F>(path.throughput, i) * (F(1) / cosine));
  }
}

}  // namespace etendue

#include "render/kernel.cpp"

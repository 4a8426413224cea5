// One light sample: choose a light, choose a point on it, its radiance over the density of that choice.
#pragma once

#include "light/light.h"
#include "lightsampler/uniform.h"
#include "scene/scene.h"

namespace etendue {

/// A sample of a light already chosen, each lane its own. \param u_y the second random number; the first is
/// what the choice left over \param choice with pmf 1 where all lights are sampled, one after the other
template <class F>
LightSample<F> sample_chosen_light(const Scene& scene, const LightChoice<F>& choice, const Vec3<F>& reference,
                                   const UInt<F>& u_y, const Mask<F>& m) {
  return scene.lights.sample<F>(choice.light, choice.pmf, reference, {choice.u_left, u_y}, m);
}

/// Uniform choice of a light, then a sample of it. \param u_light one 2-D sample, which chooses the light and
/// places the point or direction
template <class F>
LightSample<F> sample_lights(const Scene& scene, const Vec3<F>& reference, const Vec2<UInt<F>>& u_light,
                             const Mask<F>& m) {
  return sample_chosen_light<F>(scene, choose_light_uniformly<F>(scene.lights.count(), u_light.x), reference,
                                u_light.y, m);
}

/// The density (1/sr) with which `sample_lights` gives the direction `wi` from `reference`, which meets the
/// area light `light` at `position` with geometric normal `ng`; the probability of the light included.
template <class F>
F light_pdf_solid_angle(const Scene& scene, const Int<F>& light, const Vec3<F>& reference,
                        const Vec3<F>& position, const Vec3<F>& ng, const Vec3<F>& wi, const Mask<F>& m) {
  const F pdf_area = F(uniform_light_pmf(scene.lights.count())) *
                     scene.lights.pdf_area<F>(light, reference, position, ng, m);
  return select(is_front_facing(position, ng, reference),
                solid_angle_from_area(pdf_area, length_sq(position - reference), -dot(ng, wi)), F(0));
}

/// W/(m^2 sr) that a ray leaving the scene in `direction` (unit) meets of the infinite light k,
/// 0 <= k < scene.lights.infinite_count().
template <class F>
Color<F> environment_radiance(const Scene& scene, std::int32_t k, const Vec3<F>& direction,
                              const Mask<F>& m) {
  return scene.lights.infinite_radiance<F>(k, direction, m);
}

/// The density (1/sr) with which `sample_lights` gives `direction` by the infinite light k; the probability
/// of the light included.
template <class F>
F environment_pdf_solid_angle(const Scene& scene, std::int32_t k, const Vec3<F>& direction,
                              const Mask<F>& m) {
  return F(uniform_light_pmf(scene.lights.count())) *
         scene.lights.infinite_pdf_solid_angle<F>(k, direction, m);
}

}  // namespace etendue

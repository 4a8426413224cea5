// The family of surface scattering models.
//
// To add one: write bsdf/NAME.h with the three functions of the concept below, templated on the lane type,
// and its plugin description in bsdf/NAME.cpp; add it to the variant and to the table in bsdf.cpp; add it to
// the chi-squared test's list in tests/statistical/bsdf_test.cpp.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/diffuse.h"
#include "bsdf/phong.h"
#include "scenefile/parameters.h"

#include <concepts>
#include <variant>
#include <vector>

namespace etendue {

/// All directions are unit, point away from the surface and are local: z is the shading normal.
///   eval_: f(wo, wi) in 1/sr, without the cosine; 0 below the horizon of either direction.
///   pdf_solid_angle_: the density (1/sr) with which sample_ gives wi; both sides of MIS weights call it.
///   sample_: wi with its weight f cos(theta_i) / pdf.
template <class B>
concept BsdfModel = requires(const B& bsdf, const Vec3<float>& w, const Vec2<float>& u_bsdf) {
  { bsdf.eval_(w, w) } -> std::same_as<Color<float>>;
  { bsdf.pdf_solid_angle_(w, w) } -> std::same_as<float>;
  { bsdf.sample_(w, u_bsdf) } -> std::same_as<BsdfSample<float>>;
};

using Bsdf = std::variant<Diffuse, Phong>;
static_assert(BsdfModel<Diffuse> && BsdfModel<Phong>);

const std::vector<Plugin>& bsdf_plugins();

/// Throws InputError for an unknown model (with the known ones) or a parameter out of range.
Bsdf make_bsdf(const Object& description, std::vector<UnreadKey>& unread);

/// f(model, lanes) for each distinct material among the lanes of `m`, with the model's own type.
template <class F, class Function>
void for_each_material(const std::vector<Bsdf>& materials, const Int<F>& material, const Mask<F>& m,
                       Function&& f) {
  for_each_unique<F>(material, m, [&](std::int32_t id, const Mask<F>& lanes) {
    std::visit([&](const auto& bsdf) { f(bsdf, lanes); }, materials[std::size_t(id)]);
  });
}

}  // namespace etendue

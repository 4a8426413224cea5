// The family of surface scattering models.
//
// To add one: write bsdf/NAME.h with the four functions of the concepts below, templated on the lane type,
// and its plugin description in bsdf/NAME.cpp; add it to the variant and to the table in bsdf.cpp; add it to
// the lists of models in tests/statistical/bsdf_test.cpp.
#pragma once

#include "base/lookup_table.h"
#include "bsdf/bsdf_sample.h"
#include "bsdf/dielectric.h"
#include "bsdf/diffuse.h"
#include "bsdf/glossy_lobes.h"
#include "bsdf/microfacet.h"
#include "bsdf/mirror.h"
#include "bsdf/phong.h"
#include "bsdf/roughconductor.h"
#include "bsdf/roughdielectric.h"
#include "scenefile/parameters.h"

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <variant>
#include <vector>

namespace etendue {

/// What a material is at one point. All directions are unit, point away from the surface and are local: z is
/// the shading normal; either may lie below it.
///   eval: f(wo, wi) in 1/sr, without the cosine; 0 where the model scatters nothing.
///   pdf_solid_angle: the density (1/sr) with which sample gives wi; both sides of MIS weights call it.
///   sample: wi with its weight f |cos(theta_i)| / pdf.
/// f is for radiance that arrives along wi and leaves along wo: across a boundary it has the factor
/// (eta_o / eta_i)^2. eval and pdf_solid_angle of a Dirac lobe are 0 for every pair; its samples have an
/// infinite density.
template <class B>
concept BsdfModel = requires(const B& bsdf, const Vec3<float>& w, const Vec2<float>& u_bsdf) {
  { bsdf.eval(w, w) } -> std::same_as<Color<float>>;
  { bsdf.pdf_solid_angle(w, w) } -> std::same_as<float>;
  { bsdf.sample(w, u_bsdf) } -> std::same_as<BsdfSample<float>>;
};

/// A material gives what it is at a point: its textures looked up at the surface coordinates uv in the lanes
/// given (the other lanes of uv may hold anything). One without textures gives itself. It states from which
/// sides it scatters light towards a viewer in front (and, where that is both sides, behind), and whether it
/// is diffuse: scatters from all directions alike.
template <class M>
concept MaterialModel = requires(const M& material, const Vec2<float>& uv, bool lanes) {
  requires BsdfModel<std::remove_cvref_t<decltype(material.at(uv, lanes))>>;
  { material.has_texture() } -> std::same_as<bool>;
  { M::lit_sides } -> std::convertible_to<std::int32_t>;
  { material.is_diffuse() } -> std::same_as<bool>;
};

using Material =
    std::variant<Diffuse, Phong, Mirror, Dielectric, Microfacet, RoughConductor, RoughDielectric>;
static_assert(MaterialModel<Diffuse> && MaterialModel<Phong> && MaterialModel<Mirror> &&
              MaterialModel<Dielectric> && MaterialModel<Microfacet> && MaterialModel<RoughConductor> &&
              MaterialModel<RoughDielectric>);

const std::vector<Plugin>& bsdf_plugins();

/// Image files are read through `files`. Throws InputError for an unknown model (with the known ones) or
/// a parameter out of range.
Material make_material(const Object& description, TextureFiles& files, std::vector<UnreadKey>& unread);

/// The materials of a scene, by id.
class Materials {
 public:
  explicit Materials(std::vector<Material> materials);

  std::int32_t count() const { return std::int32_t(all_.size()); }
  const Material& operator[](std::int32_t id) const { return all_[std::size_t(id)]; }
  const GlossyLobes& lobes() const { return lobes_; }
  bool have_textures() const { return have_textures_; }  ///< Some need to know uv.
  /// Of `lit_side`, for a viewer in front.
  template <class F>
  Int<F> lit_sides(const Int<F>& id) const {
    return lit_sides_.at(id);
  }
  template <class F>
  Mask<F> is_diffuse(const Int<F>& id) const {
    return equal(is_diffuse_.at(id), Int<F>(1));
  }

 private:
  std::vector<Material> all_;
  LookupTable<std::int32_t> lit_sides_, is_diffuse_;
  GlossyLobes lobes_;
  bool have_textures_ = false;
};

/// Whether the material needs to know uv.
bool has_texture(const Material& material);

/// f(model, lanes) for each distinct material among the lanes of `m`: what it is at `uv`, with the model's
/// own type.
template <class F, class Function>
void for_each_material(const Materials& materials, const Int<F>& material, const Vec2<F>& uv,
                       const Mask<F>& m, Function&& f) {
  for_each_unique<F>(material, m, [&](std::int32_t id, const Mask<F>& lanes) {
    std::visit([&](const auto& bsdf) { f(bsdf.at(uv, lanes), lanes); }, materials[id]);
  });
}

}  // namespace etendue

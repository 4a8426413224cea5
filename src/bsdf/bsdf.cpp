#include "bsdf/bsdf.h"

#include <cmath>
#include <optional>
#include <utility>

namespace etendue {

const std::vector<Plugin>& bsdf_plugins() {
  static const std::vector<Plugin> plugins{
      diffuse_plugin,    phong_plugin,          mirror_plugin,          dielectric_plugin,
      microfacet_plugin, roughconductor_plugin, roughdielectric_plugin, roughsubstrate_plugin};
  return plugins;
}

Material make_material(const Object& description, TextureFiles& files, std::vector<UnreadKey>& unread) {
  if (description.type == diffuse_plugin.name) return make_diffuse(description, files, unread);
  if (description.type == phong_plugin.name) return make_phong(description, unread);
  if (description.type == mirror_plugin.name) return make_mirror(description, unread);
  if (description.type == dielectric_plugin.name) return make_dielectric(description, unread);
  if (description.type == microfacet_plugin.name) return make_microfacet(description, unread);
  if (description.type == roughconductor_plugin.name) return make_roughconductor(description, unread);
  if (description.type == roughdielectric_plugin.name) return make_roughdielectric(description, unread);
  if (description.type == roughsubstrate_plugin.name) return make_roughsubstrate(description, unread);
  throw unknown_plugin(description, bsdf_plugins());
}

namespace {

// Those without an overload of their own scatter no lobe that one linearly transformed cosine has the shape
// of.
template <class Model>
std::optional<GlossyLobe> lobe_of(const Model& /*model*/) {
  return std::nullopt;
}

const ltc::Table& table_of(const MicrofacetDistribution& distribution) {
  return distribution.kind == MicrofacetDistribution::Kind::ggx ? ltc::ggx : ltc::beckmann;
}

std::optional<GlossyLobe> lobe_of(const Phong& model) {
  if (model.is_diffuse()) return std::nullopt;
  const float specular = luminance(model.ks);
  return GlossyLobe{ltc::phong, std::sqrt(2 / (model.exponent + 2)), [=](float) { return specular; },
                    luminance(model.kd)};
}

std::optional<GlossyLobe> lobe_of(const Microfacet& model) {
  const auto reflectance = [ks = model.ks, indices = model.indices](float cosine) {
    return ks * refract(cosine, indices.inside_over_outside).reflectance;
  };
  return GlossyLobe{table_of(model.distribution), model.distribution.alpha, reflectance, luminance(model.kd)};
}

std::optional<GlossyLobe> lobe_of(const RoughConductor& model) {
  return GlossyLobe{table_of(model.distribution), model.distribution.alpha, [](float) { return 1.0f; }, 0};
}

}  // namespace

Materials::Materials(std::vector<Material> materials) : all_(std::move(materials)) {
  for (const Material& material : all_) {
    is_diffuse_.push_back(std::visit([](const auto& model) { return model.is_diffuse(); }, material) ? 1 : 0);
    lit_sides_.push_back(std::visit([](const auto& model) { return model.lit_sides; }, material));
    const std::optional<GlossyLobe> lobe =
        std::visit([](const auto& model) { return lobe_of(model); }, material);
    lobes_.add(lobe ? &*lobe : nullptr);
    have_textures_ = have_textures_ || has_texture(material);
  }
}

bool has_texture(const Material& material) {
  return std::visit([](const auto& model) { return model.has_texture(); }, material);
}

}  // namespace etendue

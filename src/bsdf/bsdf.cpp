#include "bsdf/bsdf.h"

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

Materials::Materials(std::vector<Material> materials) : all_(std::move(materials)) {
  for (const Material& material : all_) {
    is_diffuse_.push_back(std::visit([](const auto& model) { return model.is_diffuse(); }, material) ? 1 : 0);
    lit_sides_.push_back(std::visit([](const auto& model) { return model.lit_sides; }, material));
    have_textures_ = have_textures_ || has_texture(material);
  }
}

bool has_texture(const Material& material) {
  return std::visit([](const auto& model) { return model.has_texture(); }, material);
}

}  // namespace etendue

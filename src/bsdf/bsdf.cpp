#include "bsdf/bsdf.h"

namespace etendue {

const std::vector<Plugin>& bsdf_plugins() {
  static const std::vector<Plugin> plugins{diffuse_plugin, phong_plugin};
  return plugins;
}

Bsdf make_bsdf(const Object& description, std::vector<UnreadKey>& unread) {
  if (description.type == diffuse_plugin.name) return make_diffuse(description, unread);
  if (description.type == phong_plugin.name) return make_phong(description, unread);
  throw unknown_plugin(description, bsdf_plugins());
}

}  // namespace etendue

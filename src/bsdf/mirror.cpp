#include "bsdf/mirror.h"

namespace etendue {

const Plugin mirror_plugin{
    "bsdf", "mirror", "A perfect mirror that reflects all light; black from behind.", {}, {}};

Mirror make_mirror(const Object& description, std::vector<UnreadKey>& unread) {
  const Parameters parameters(description, mirror_plugin, unread);
  return {};
}

}  // namespace etendue

// What other renderers, or other courses, call things: hints in our words, and keys that are refused.
#pragma once

#include "scenefile/scene_desc.h"

#include <string>
#include <string_view>

namespace etendue {

/// For a tag that has no place where it stands; empty where nothing is known of it.
std::string foreign_tag_hint(std::string_view tag);

/// For the name of a plugin that there is not, with the tag it stood in.
std::string foreign_plugin_hint(std::string_view tag, std::string_view type);

/// A key that some renderer of the family, or Mitsuba, or pbrt, has for a plugin of ours that does not know
/// it.
struct ForeignKey {
  std::string_view families;  ///< Of plugins (Plugin::family) that it belongs to, split by spaces.
  std::string_view types;     ///< Their names; empty: any.
  std::string_view key;
  std::string_view hint;  ///< What to do.
  bool is_refused;        ///< It would change the image: an error. Else other renderers pass over it too.
};
/// Null where none is known.
const ForeignKey* find_foreign_key(std::string_view family, std::string_view type, std::string_view key);

}  // namespace etendue

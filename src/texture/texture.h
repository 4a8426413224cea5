// The family of textures: colours over the surface coordinates uv.
//
// To add one: write texture/NAME.h with `at` as the others have it, templated on the lane type, and its
// plugin description in texture/NAME.cpp; add it to the variant and to the tables in texture.cpp.
#pragma once

#include "texture/checkerboard.h"
#include "texture/image_texture.h"
#include "texture/uv_texture.h"

#include <filesystem>
#include <variant>
#include <vector>

namespace etendue {

/// One colour everywhere, or a texture.
using ColorTexture = std::variant<Colorf, Checkerboard, UvTexture, ImageTexture>;

const std::vector<Plugin>& texture_plugins();

/// The colour parameter `name`, none of its channels negative: its value, or the texture that stands for it,
/// read through `files`. Throws InputError for an unknown texture or a bad value.
ColorTexture read_color_texture(const Parameters& parameters, std::string_view name, TextureFiles& files,
                                std::vector<UnreadKey>& unread);

inline bool is_uniform(const ColorTexture& texture) { return std::holds_alternative<Colorf>(texture); }

/// The colour at `uv` in these lanes; anything in the others.
template <class F>
Color<F> color_at(const ColorTexture& texture, const Vec2<F>& uv, const Mask<F>& lanes) {
  if (const Colorf* color = std::get_if<Colorf>(&texture)) return {F(color->r), F(color->g), F(color->b)};
  if (const auto* checkerboard = std::get_if<Checkerboard>(&texture)) return checkerboard->at(uv, lanes);
  if (const auto* image = std::get_if<ImageTexture>(&texture)) return image->at(uv, lanes);
  return std::get<UvTexture>(texture).at(uv, lanes);
}

}  // namespace etendue

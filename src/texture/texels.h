// Where a texture can change its colour abruptly or bend, and how bright it is: for those who sample it.
#pragma once

#include "texture/texture.h"

namespace etendue {

/// Lines of constant u and v: between them the texture is smooth.
struct TexelLattice {
  Vec2<double> per_unit;  ///< Texels in a unit of u and of v.
  Vec2<double> offset;    ///< Lines are where u * per_unit.x - offset.x is whole, and the same of v.
  enum class Between { constant, bilinear, other };
  Between between;  ///< What the texture is within the lines.
};

TexelLattice texel_lattice(const ColorTexture& texture);

/// At least as great as the luminance anywhere in this box of uv; 0 only where all of it is black.
double largest_luminance(const ColorTexture& texture, const Vec2<double>& low, const Vec2<double>& high);

/// As great as the luminance is anywhere, or somewhat greater.
double largest_luminance(const ColorTexture& texture);

}  // namespace etendue

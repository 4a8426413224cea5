// The glossy lobes of a scene's materials, as linearly transformed cosines.
#pragma once

#include "base/frame.h"
#include "base/lane_vec.h"
#include "base/lookup_table.h"
#include "bsdf/ltc.h"
#include "bsdf/ltc_tables.h"

#include <functional>
#include <vector>

namespace etendue {

/// What is known of a material's lobe, one about the mirror direction in front of the surface.
struct GlossyLobe {
  const ltc::Table& table;
  float roughness;                          ///< See ltc::roughnesses.
  std::function<float(float)> reflectance;  ///< Of the lobe's albedo, by the viewer's cosine: a luminance.
  float diffuse;                            ///< The albedo beside it, a luminance.
};

/// What a receiver scatters by its lobe.
template <class F>
struct LobeAtReceiver {
  LinearlyTransformedCosine<F> shape;
  F albedo, diffuse;  ///< Luminances of the lobe and of what is scattered beside it; rough.
};

class GlossyLobes {
 public:
  /// Of the next material; null: it has none, or one so narrow that polygons in it leave the range of floats.
  void add(const GlossyLobe* lobe);

  bool have_any() const { return have_any_; }
  template <class F>
  Mask<F> has(const Int<F>& material) const {
    return equal(has_lobe_.at(material), Int<F>(1));
  }

  /// About the least solid angle (sr) that the lobe fills, over the viewer's angles; 1 where there is none.
  template <class F>
  F narrowest(const Int<F>& material) const {
    return narrowest_.at(material);
  }

  /// \param material one that has a lobe; of the others anything finite comes
  /// \param ns, wo world, unit, dot(ns, wo) > 0
  template <class F>
  LobeAtReceiver<F> at(const Int<F>& material, const Vec3<F>& ns, const Vec3<F>& wo) const {
    const F cosine = dot(ns, wo);
    const F place = sqrt(max(F(1) - cosine, F(0))) * F(float(ltc::angles - 1));
    const Int<F> before = min(to_int(place), Int<F>(ltc::angles - 2));
    const F rest = min(place - to_float(before), F(1));
    const Int<F> row = (material * Int<F>(ltc::angles) + before) * Int<F>(columns);
    const auto value = [&](int column) {
      const F low = gather(entries_.data() + column, row),
              high = gather(entries_.data() + columns + column, row);
      return low + (high - low) * rest;
    };
    const F a = value(0), b = value(1), c = value(2), tan_tilt = value(3);
    // Seen from above, any direction may stand for the plane of incidence.
    const Vec3<F> across = cross(ns, wo);
    const Vec3<F> y = normalize(select(length_sq(across) > F(1e-10f), across, Frame<F>(ns).t));
    const Vec3<F> mirrored = ns * (F(2) * cosine) - wo;
    const Vec3<F> z = normalize(mirrored + cross(y, mirrored) * tan_tilt), x = cross(y, z);
    return {{.column_x = x * a,
             .column_y = y * b,
             .column_z = z + x * c,
             .row_x = (x - z * c) * (F(1) / a),
             .row_y = y * (F(1) / b),
             .row_z = z,
             .inverse_determinant = F(1) / (a * b)},
            value(4),
            value(5)};
  }

 private:
  static constexpr int columns = 6;  ///< a, b, c, tan_tilt, albedo, diffuse.
  std::vector<float> entries_;       ///< Of each material at each angle.
  LookupTable<std::int32_t> has_lobe_;
  LookupTable<float> narrowest_;
  bool have_any_ = false;
};

}  // namespace etendue

// Distributions of the normals of microfacets: density, shadowing, and sampling of the visible ones.
#pragma once

#include "base/error_function.h"
#include "base/vec.h"
#include "base/warp.h"
#include "scenefile/parameters.h"

namespace etendue {

/// Isotropic, over the normals h of the upper hemisphere. Shadowing is Smith's, exact for each distribution,
/// and separable: G(wo, wi) = G1(wo) G1(wi), as in Walter et al. 2007, "Microfacet models for refraction
/// through rough surfaces".
struct MicrofacetDistribution {
  enum class Kind { beckmann, ggx };
  Kind kind = Kind::beckmann;
  float alpha = 0.1f;  ///< Roughness: the root mean square slope times sqrt(2) (Beckmann).

  /// D(h) in 1/sr, h.z > 0 unit: Walter et al. 2007, eq. 25 and 33.
  template <class F>
  F density(const Vec3<F>& h) const {
    constexpr float least = 1e-18f;  // Its square can be divided by; there the exponential is 0.
    const F across_sq = h.x * h.x + h.y * h.y, along_sq = max(h.z * h.z, F(least));
    const float alpha_sq = alpha * alpha;
    if (kind == Kind::ggx) {
      const F stretched = across_sq + F(alpha_sq) * along_sq;
      return F(alpha_sq * inv_pi) / (stretched * stretched);
    }
    return exp(across_sq / (along_sq * F(-alpha_sq))) * F(inv_pi / alpha_sq) / (along_sq * along_sq);
  }

  /// G1(w) / cos(theta) for a direction of this cosine >= 0: finite at grazing angles, where both go to 0.
  template <class F>
  F shadowing_over_cos(const F& cos_theta) const {
    const F sin_sq = max(F(1) - cos_theta * cos_theta, F(0));
    if (kind == Kind::ggx)
      return F(2) / (cos_theta + sqrt(cos_theta * cos_theta + F(alpha * alpha) * sin_sq));
    const F stretched_sin = sqrt(sin_sq) * F(alpha);
    const F slope = cos_theta / max(stretched_sin, F(1e-20f));
    const F bell = exp(-min(slope * slope, F(80)));
    return F(2) / (cos_theta * (F(1) + erf_nonnegative(slope, bell)) + stretched_sin * bell * F(inv_sqrt_pi));
  }

  /// The same by the rational approximation of Beckmann's that Nori and its forks take: Walter et al. 2007,
  /// below eq. 27.
  template <class F>
  F rational_shadowing_over_cos(const F& cos_theta) const {
    const F stretched_sin = F(alpha) * sqrt(max(F(1) - cos_theta * cos_theta, F(0)));
    // b = cos_theta / stretched_sin, multiplied out so that neither may be 0.
    const F numerator = F(3.535f) * stretched_sin + F(2.181f) * cos_theta;
    const F denominator =
        stretched_sin * stretched_sin + cos_theta * (F(2.276f) * stretched_sin + F(2.577f) * cos_theta);
    const Mask<F> is_shadowed = cos_theta < F(1.6f) * stretched_sin;
    return select(is_shadowed, numerator / max(denominator, F(1e-30f)), F(1) / max(cos_theta, F(1e-30f)));
  }

  /// A normal with density D(h) h.z; Beckmann's only.
  template <class F>
  Vec3<F> sample_normal(const Vec2<F>& u) const {
    F sine, cosine;
    sincos_turns(u.y, sine, cosine);
    const F tangent = F(alpha) * sqrt(-log(F(1) - u.x));
    const F cos_theta = F(1) / sqrt(F(1) + tangent * tangent);
    return {tangent * cos_theta * cosine, tangent * cos_theta * sine, cos_theta};
  }

  /// A normal with density G1(wo) max(wo . h, 0) D(h) / cos(theta_o), those that wo sees; wo.z >= 0.
  template <class F>
  Vec3<F> sample_visible(const Vec3<F>& wo, const Vec2<F>& u) const {
    // A surface stretched to roughness 1 sees this.
    const Vec3<F> w = normalize(Vec3<F>{wo.x * F(alpha), wo.y * F(alpha), wo.z});
    const Vec3<F> h = kind == Kind::ggx ? sample_unit_ggx(w, u) : sample_unit_beckmann(w, u);
    return normalize(Vec3<F>{h.x * F(alpha), h.y * F(alpha), h.z});
  }

 private:
  static constexpr float inv_sqrt_pi = 0.56418958354775628695f;

  /// A point of a spherical cap: Dupuy and Benyoub 2023, "Sampling visible GGX normals with spherical caps",
  /// listing 3. Not normalised.
  template <class F>
  static Vec3<F> sample_unit_ggx(const Vec3<F>& w, const Vec2<F>& u) {
    F sine, cosine;
    sincos_turns(u.x, sine, cosine);
    const F z = (F(1) - u.y) * (F(1) + w.z) - w.z;
    const F radius = sqrt(max((F(1) - z) * (F(1) + z), F(0)));
    return {radius * cosine + w.x, radius * sine + w.y, z + w.z};
  }

  /// The slope towards w by inversion, the one across it by its normal distribution: Heitz and d'Eon 2014,
  /// "Importance sampling microfacet-based BSDFs using the distribution of visible normals", inverted as in
  /// Jakob 2014, "An improved visible normal sampling routine for the Beckmann distribution": three steps of
  /// Newton for y = erf(slope), from an approximation that is exact at grazing angles. Not normalised.
  template <class F>
  static Vec3<F> sample_unit_beckmann(const Vec3<F>& w, const Vec2<F>& u) {
    // Open, because y = -1 or 1 would be an infinite slope; the fraction of normals lost is 2^-24.
    constexpr float least = 0x1p-25f, largest = 0x1.fffffep-1f;
    const F sine = sqrt(w.x * w.x + w.y * w.y);
    const F u_y = max(u.y, F(least)), u_x = max(u.x, F(least));
    const F steepest = w.z / max(sine, F(1e-20f));
    const F bell = exp(-min(steepest * steepest, F(80)));
    const F highest = erf_nonnegative(steepest, bell);
    const F start = sqrt(-log(u_y));
    F y = highest - (F(1) + highest) * erf_nonnegative(start, u_y);
    const F share = u_y * (w.z * (F(1) + highest) + sine * bell * F(inv_sqrt_pi));
    const F most_y = min(highest, F(largest));
    const auto clamp = [&](const F& v) { return min(max(v, F(-largest)), most_y); };
    for (int step = 0; step < 3; ++step) {
      y = clamp(y);
      const F slope = inverse_erf(y);
      const F value = w.z * (F(1) + y) + sine * exp(-slope * slope) * F(inv_sqrt_pi) - share;
      y = y - value / max(w.z - slope * sine, F(1e-6f));
    }
    const F along = inverse_erf(clamp(y));
    const F across = inverse_erf(F(2) * u_x - F(1));
    // Slopes of the frame in which w lies in the xz plane, turned back; the normal of slope s is (-s, 1).
    const F cos_phi = select(sine > F(0), w.x / max(sine, F(1e-20f)), F(1));
    const F sin_phi = select(sine > F(0), w.y / max(sine, F(1e-20f)), F(0));
    return {across * sin_phi - along * cos_phi, -along * sin_phi - across * cos_phi, F(1)};
  }
};

Parameter alpha_parameter();
/// The parameters `distribution` and `alpha`.
std::vector<Parameter> microfacet_parameters();

/// Throw InputError for an unknown distribution or an alpha out of range; `smooth_models` are the ones to use
/// where it is too small.
float read_alpha(const Parameters& parameters, const std::string& smooth_models);
MicrofacetDistribution read_microfacet_distribution(const Parameters& parameters,
                                                    const std::string& smooth_models);

}  // namespace etendue

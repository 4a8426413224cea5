// A homogeneous medium that fills a box.
#pragma once

#include "base/lane_vec.h"
#include "base/simd_math.h"
#include "base/transform.h"
#include "geometry/geometry.h"
#include "medium/phase.h"
#include "scenefile/parameters.h"

#include <array>

namespace etendue {

/// Absorption and scattering coefficients are per metre. The box is the unit cube under `world_from_medium`.
class HomogeneousMedium {
 public:
  HomogeneousMedium(const Colorf& sigma_a, const Colorf& sigma_s, const HenyeyGreenstein& phase_function,
                    const Transform& world_from_medium);

  HenyeyGreenstein phase;

  /// The sphere about the centre of `shapes` that holds both them and the whole box.
  Sphere bounds_with(const Sphere& shapes) const;

  /// Transmittance between `origin` and `origin` + `along`.
  template <class F>
  Color<F> transmittance(const Vec3<F>& origin, const Vec3<F>& along) const {
    const Overlap<F> overlap(*this, origin, along, F(0), F(1));
    return fall_off(overlap.length * length(along));
  }

  /// The fate of a ray on its way to `t_far`.
  template <class F>
  struct Flight {
    Mask<F> is_scattered;  ///< At t; elsewhere it gets to its end.
    F t;
    Color<F> weight;  ///< Transmittance, times sigma_s where it is scattered, over the density.
  };

  /// Samples a free flight along a ray of unit direction. A medium that does not scatter only dims. Of a
  /// coloured one each third of the samples follows one channel, weighted by the mean over the channels (the
  /// balance heuristic of one sample; Veach 1997, section 9.2.4).
  template <class F>
  Flight<F> sample_flight(const Vec3<F>& origin, const Vec3<F>& direction, const F& t_near, const F& t_far,
                          const F& u_flight) const {
    const Overlap<F> overlap(*this, origin, direction, t_near, t_far);
    const Color<F> passed = fall_off(overlap.length);
    if (!is_scattering_) return {F(1) < F(0), overlap.begin, passed};
    F u = u_flight, sigma = F(sigma_t_.r);
    if (!is_grey_) {
      const F scaled = u_flight * F(3);
      const Int<F> channel = to_int(scaled);
      u = min(scaled - to_float(channel), F(0x1.fffffep-1f));
      sigma = select(equal(channel, Int<F>(0)), F(sigma_t_.r),
                     select(equal(channel, Int<F>(1)), F(sigma_t_.g), F(sigma_t_.b)));
    }
    const F flown = -log(F(1) - u) / max(sigma, F(1e-30f));
    const Mask<F> is_scattered = flown < overlap.length;
    const Color<F> at_t = fall_off(flown);
    const F mean_passed = (passed.r + passed.g + passed.b) * F(1.0f / 3);
    const F density =
        (at_t.r * F(sigma_t_.r) + at_t.g * F(sigma_t_.g) + at_t.b * F(sigma_t_.b)) * F(1.0f / 3);
    const Color<F> scattered = at_t * Color<F>{F(sigma_s_.r), F(sigma_s_.g), F(sigma_s_.b)};
    return {is_scattered, overlap.begin + flown,
            select(is_scattered, scattered * (F(1) / max(density, F(1e-37f))),
                   passed * (F(1) / max(mean_passed, F(1e-37f))))};
  }

 private:
  /// The part of a ray within the box.
  template <class F>
  struct Overlap {
    F begin, length;  ///< In units of the ray's direction; length 0: it misses the box.

    Overlap(const HomogeneousMedium& medium, const Vec3<F>& origin, const Vec3<F>& direction, F from, F to) {
      for (const std::array<float, 4>& row : medium.medium_from_world_) {
        const Vec3<F> axis{F(row[0]), F(row[1]), F(row[2])};
        const F at = dot(axis, origin) + F(row[3]), speed = dot(axis, direction);
        const F inverse = F(1) / select(abs(speed) < F(1e-30f), F(1e-30f), speed);
        const F t_0 = -at * inverse, t_1 = (F(1) - at) * inverse;
        from = max(from, min(t_0, t_1));
        to = min(to, max(t_0, t_1));
      }
      begin = from;
      length = max(to - from, F(0));
    }
  };

  template <class F>
  Color<F> fall_off(const F& distance) const {
    return {exp(-distance * F(sigma_t_.r)), exp(-distance * F(sigma_t_.g)), exp(-distance * F(sigma_t_.b))};
  }

  Colorf sigma_s_, sigma_t_;
  bool is_scattering_, is_grey_;
  std::array<std::array<float, 4>, 3> medium_from_world_;
  std::array<Vec3f, 8> corners_;  ///< World, m.
};

const std::vector<Plugin>& medium_plugins();
const std::vector<Plugin>& phase_plugins();
/// Throws InputError for an unknown one or a parameter out of range.
HenyeyGreenstein make_phase(const Object& description, std::vector<UnreadKey>& unread);

/// Throws InputError for unknown names, coefficients that are not finite and >= 0, a singular transform.
HomogeneousMedium make_medium(const Object& description, std::vector<UnreadKey>& unread);

}  // namespace etendue

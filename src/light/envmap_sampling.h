// Envmap's look-ups and samples, over lanes.
#pragma once

#include "light/envmap.h"
#include "light/sample_linear.h"

namespace etendue {

template <class F, bool is_compensated>
Envmap::Corners<F> Envmap::corners(const Int<F>& column, const Int<F>& row) const {
  using I = Int<F>;
  const I right = select(less(column + I(1), I(width_)), column + I(1), I(0));
  const I upper = select(less(I(0), row), row - I(1), I(0));
  const I lower = select(less(row, I(height_)), row, I(height_ - 1));
  const F sin_upper = gather(sin_theta_.data(), upper), sin_lower = gather(sin_theta_.data(), lower);
  Corners<F> result;
  for (int k = 0; k < 4; ++k) {
    const I texel = ((k < 2 ? upper : lower) * I(width_) + (k % 2 == 0 ? column : right)) * I(3);
    result.color[k] = {gather(rgb_.data(), texel), gather(rgb_.data() + 1, texel),
                       gather(rgb_.data() + 2, texel)};
    result.weight[k] = luminance(result.color[k]) * (k < 2 ? sin_upper : sin_lower);
    if constexpr (is_compensated)
      result.weight[k] =
          max(luminance(result.color[k]) - F(floor_luminance_), F(0)) * (k < 2 ? sin_upper : sin_lower);
  }
  return result;
}

template <class F>
Envmap::Value<F> Envmap::value(const Corners<F>& c, const Place<F>& place, const F& sin_theta) const {
  const F s = place.s, t = place.t, s0 = F(1) - s, t0 = F(1) - t;
  const F share[4]{s0 * t0, s * t0, s0 * t, s * t};
  Color<F> radiance = black<F>();
  F weight(0);
  for (int k = 0; k < 4; ++k) {
    radiance = radiance + c.color[k] * share[k];
    weight = weight + c.weight[k] * share[k];
  }
  const F mean = (c.weight[0] + c.weight[1] + c.weight[2] + c.weight[3]) * F(0.25f);
  const Int<F> first = place.row * Int<F>(width_ + 1);
  const F pmf = inversion_pmf<F>(row_shares_.data(), Int<F>(0), place.row) *
                inversion_pmf<F>(column_shares_.data(), first, place.column);
  constexpr float two_pi = 2 * pi;
  const F cell_size = select(is_cap<F>(place.row), F(two_pi * float(cap_one_minus_cos_) / float(width_)),
                             sin_theta * F(two_pi * pi / (float(width_) * float(height_))));
  const F pdf = pmf * weight / (mean * cell_size);
  return {radiance, select(mask_and(pmf > F(0), mean > F(0)), pdf, F(0))};
}

template <class F>
Envmap::Value<F> Envmap::at(const Vec3<F>& d, const Mask<F>& m) const {
  return floor_luminance_ > 0 ? value_at<F, true>(d, m) : value_at<F, false>(d, m);
}

template <class F, bool is_compensated>
Envmap::Value<F> Envmap::value_at(const Vec3<F>& d, const Mask<F>& m) const {
  using I = Int<F>;
  const F sin_theta = sqrt(d.x * d.x + d.z * d.z);
  const F u = atan2(d.x, -d.z) * F(0.5f * inv_pi), v = atan2(sin_theta, d.y) * F(inv_pi);
  const F x_signed = u * F(float(width_)) - F(0.5f);
  const F x = select(m, select(x_signed < F(0), x_signed + F(float(width_)), x_signed), F(0));
  const F y = select(m, v * F(float(height_)) + F(0.5f), F(0.5f));
  // A direction that is NaN must give a NaN, not a look-up outside of the table.
  const auto whole = [](const F& at, std::int32_t most) {
    return to_int(min(select(at >= F(0), at, F(0)), F(float(most))));
  };
  const I column = whole(x, width_ - 1), row = whole(y, height_);
  const Place<F> place{column, row, min(x - to_float(column), F(1)), y - to_float(row)};
  return value<F>(corners<F, is_compensated>(column, row), place, sin_theta);
}

template <class F>
Envmap::Sample<F> Envmap::sample(const Vec2<UInt<F>>& u) const {
  return floor_luminance_ > 0 ? sample_by<F, true>(u) : sample_by<F, false>(u);
}

template <class F, bool is_compensated>
Envmap::Sample<F> Envmap::sample_by(const Vec2<UInt<F>>& u) const {
  using I = Int<F>;
  const InversionSample<F> row = sample_by_inversion<F>(row_shares_.data(), I(0), height_ + 1, u.y);
  const InversionSample<F> column =
      sample_by_inversion<F>(column_shares_.data(), row.index * I(width_ + 1), width_, u.x);
  const Corners<F> c = corners<F, is_compensated>(column.index, row.index);
  Place<F> place{column.index, row.index, F(0), F(0)};
  place.t = sample_linear(row.u_left, c.weight[0] + c.weight[1], c.weight[2] + c.weight[3]);
  const F t0 = F(1) - place.t;
  place.s = sample_linear(column.u_left, c.weight[0] * t0 + c.weight[2] * place.t,
                          c.weight[1] * t0 + c.weight[3] * place.t);

  F sin_theta, cos_theta, sin_phi, cos_phi;
  const F v = (to_float(place.row) + place.t - F(0.5f)) * F(1 / float(height_));
  sincos_turns(max(v, F(0)) * F(0.5f), sin_theta, cos_theta);
  // In the caps t runs evenly in cos(theta), down from the north pole and on to the south pole.
  const Mask<F> is_north = equal(place.row, I(0)), is_polar = is_cap<F>(place.row);
  const F from_pole = select(is_north, place.t, F(1) - place.t) * F(float(cap_one_minus_cos_));
  sin_theta = select(is_polar, sqrt(from_pole * (F(2) - from_pole)), sin_theta);
  cos_theta = select(is_polar, select(is_north, F(1) - from_pole, from_pole - F(1)), cos_theta);

  const F u_turn = (to_float(place.column) + place.s + F(0.5f)) * F(1 / float(width_));
  sincos_turns(select(u_turn >= F(1), u_turn - F(1), u_turn), sin_phi, cos_phi);
  Sample<F> sample;
  sample.direction = {sin_phi * sin_theta, cos_theta, -(cos_phi * sin_theta)};
  sample.value = value<F>(c, place, sin_theta);
  sample.piece = to_int(to_float(place.row) * F(4 / float(height_ + 1))) * I(4) +
                 to_int(to_float(place.column) * F(4 / float(width_)));
  return sample;
}

}  // namespace etendue

// The table of wide functions; built once for each instruction set, like the kernels.
#include "wide/wide_functions.h"

#include "base/error_function.h"
#include "base/frame.h"
#include "base/split_unit.h"
#include "base/warp.h"
#include "bsdf/bsdf.h"
#include "geometry/surface_uv.h"
#include "integrator/weights.h"
#include "light/polygon_table.h"
#include "light/projected_cap.h"
#include "light/projected_polygon.h"
#include "light/spherical_ellipse.h"
#include "light/spherical_polygon.h"
#include "lightsampler/light_importance.h"
#include "lightsampler/light_sampler.h"
#include "scene/scene.h"

#include <array>
#include <iterator>

namespace etendue {

namespace {

using F = NativeLanes;
using I = Int<F>;
using U = UInt<F>;
using M = Mask<F>;

/// One packet: the inputs as they are taken, one after the other, and the outputs likewise.
class Packet {
 public:
  Packet(const std::uint32_t* const* in, std::uint32_t* const* out, int i) : in_(in), out_(out), i_(i) {}

  U word() { return load_lanes<U>(*in_++ + i_); }
  F real() { return bits_as_float(word()); }
  Vec2<U> words() {
    const U x = word();
    return {x, word()};
  }
  Vec2<F> square() {
    const F x = real();
    return {x, real()};
  }
  Vec3<F> vec() {
    const F x = real(), y = real();
    return {x, y, real()};
  }

  void give(const U& v) { store_lanes(*out_++ + i_, v); }
  void give(const F& v) { give(float_as_bits(v)); }
  void give(const Vec2<F>& v) { give(v.x), give(v.y); }
  void give(const Vec3<F>& v) { give(v.x), give(v.y), give(v.z); }
  void give(const Color<F>& c) { give(c.r), give(c.g), give(c.b); }

 private:
  const std::uint32_t* const* in_;
  std::uint32_t* const* out_;
  int i_;
};

/// Body(scene, packet) for each packet.
template <auto body>
void run(const Scene& scene, const std::uint32_t* const* in, std::uint32_t* const* out, int count) {
  for (int i = 0; i < count; i += lane_count_v<F>) {
    Packet packet(in, out, i);
    body(scene, packet);
  }
}

M every_lane() { return less(I(-1), I(0)); }

template <SamplerKind kind>
void sample(const Scene&, Packet& p) {
  const U lo = p.word(), hi = p.word(), index = p.word();
  for (const std::uint32_t pair : {0u, 2u}) {
    const Vec2<U> u = sample_2d<F>(kind, lo, hi, index, pair);
    p.give(u.x), p.give(u.y);
  }
}

void word_multiply_high(const Scene&, Packet& p) {
  const U a = p.word(), b = p.word();
  p.give(mul_hi(a, b));
}
void word_less(const Scene&, Packet& p) {
  const U a = p.word(), b = p.word();
  p.give(as_uint(select(less(a, b), I(1), I(0))));
}
void word_hash(const Scene&, Packet& p) { p.give(hash32(p.word())); }
void unit_float(const Scene&, Packet& p) { p.give(to_unit_float(p.word())); }
void angle_of(const Scene&, Packet& p) {
  const F y = p.real(), x = p.real();
  p.give(etendue::atan2(y, x));
}
void truncation(const Scene&, Packet& p) { p.give(as_uint(to_int(p.real()))); }

void exponential(const Scene&, Packet& p) { p.give(etendue::exp(p.real())); }
void logarithm(const Scene&, Packet& p) { p.give(etendue::log(p.real())); }
void power(const Scene&, Packet& p) {
  const F x = p.real(), y = p.real();
  p.give(pow_positive(x, y));
}
void sine_and_cosine(const Scene&, Packet& p) {
  F sine, cosine;
  sincos_turns(p.real(), sine, cosine);
  p.give(sine), p.give(cosine);
}

void triangle(const Scene&, Packet& p) { p.give(square_to_triangle(p.square())); }
void cosine_hemisphere(const Scene&, Packet& p) { p.give(square_to_cosine_hemisphere(p.square())); }
void cosine_hemisphere_pdf(const Scene&, Packet& p) { p.give(cosine_hemisphere_pdf_solid_angle(p.real())); }
void power_cosine(const Scene&, Packet& p) {
  const Vec2<F> u = p.square();
  p.give(square_to_power_cosine(u, p.real()));
}
void power_cosine_pdf(const Scene&, Packet& p) {
  const F cosine = p.real();
  p.give(power_cosine_pdf_solid_angle(cosine, p.real()));
}
void uniform_cone(const Scene&, Packet& p) {
  const Vec2<F> u = p.square();
  p.give(square_to_uniform_cone(u, p.real()));
}
void uniform_cone_pdf(const Scene&, Packet& p) { p.give(uniform_cone_pdf_solid_angle(p.real())); }
void uniform_disk(const Scene&, Packet& p) { p.give(square_to_uniform_disk(p.square())); }
void uniform_sphere(const Scene&, Packet& p) { p.give(square_to_uniform_sphere(p.square())); }

void uv_of_sphere(const Scene&, Packet& p) {
  const auto ng = p.vec();
  p.give(sphere_uv(ng, p.real()));
}
void uv_of_disk(const Scene&, Packet& p) {
  const F x = p.real(), y = p.real();
  p.give(disk_uv(Vec2<F>{x, y}));
}

void frame(const Scene&, Packet& p) {
  const Frame<F> frame(p.vec());
  const Vec3<F> v = p.vec();
  p.give(frame.s), p.give(frame.t), p.give(frame.local_from_world(v)), p.give(frame.world_from_local(v));
}

void filter_offset(const Scene& scene, Packet& p) { p.give(scene.filter.sample_offset_px(p.real())); }
void signed_filter_offset(const Scene&, Packet& p) {
  static const PixelFilter filter = PixelFilter::mitchell();
  const Vec2<F> u = p.square();
  p.give(filter.sample_offset_px(u.x)), p.give(filter.sample_weight(u.x, u.y));
}
void camera_ray(const Scene& scene, Packet& p) {
  const Vec2<F> at = p.square();
  const CameraRay<F> ray = scene.camera.ray(at.x, at.y);
  p.give(ray.origin), p.give(ray.direction), p.give(ray.t_near), p.give(ray.t_far);
}
void lens_ray(const Scene& scene, Packet& p) {
  const Vec2<F> at = p.square();
  const CameraRay<F> ray = scene.camera.ray(at.x, at.y, p.square());
  p.give(ray.origin), p.give(ray.direction), p.give(ray.t_near), p.give(ray.t_far);
}
void smooth_normal(const Scene& scene, Packet& p) {
  const I geometry = as_int(p.word()), primitive = as_int(p.word());
  p.give(interpolate_normal<F>(scene.geometry, geometry, primitive, p.square(), every_lane()));
}

/// f(model), for the material of this index at uv = 0.
template <int material, class Function>
void visit_bsdf(const Scene& scene, Function&& f) {
  for_each_material<F>(scene.materials, I(material), Vec2<F>{F(0), F(0)}, every_lane(),
                       [&](const auto& bsdf, const M&) { f(bsdf); });
}
template <int material>
void bsdf_eval(const Scene& scene, Packet& p) {
  const Vec3<F> wo = p.vec(), wi = p.vec();
  visit_bsdf<material>(scene, [&](const auto& bsdf) { p.give(bsdf.eval(wo, wi)); });
}
template <int material>
void bsdf_pdf(const Scene& scene, Packet& p) {
  const Vec3<F> wo = p.vec(), wi = p.vec();
  visit_bsdf<material>(scene, [&](const auto& bsdf) { p.give(bsdf.pdf_solid_angle(wo, wi)); });
}
template <int material>
void bsdf_sample(const Scene& scene, Packet& p) {
  const Vec3<F> wo = p.vec();
  const Vec2<F> u_bsdf = p.square();
  visit_bsdf<material>(scene, [&](const auto& bsdf) { p.give(bsdf.sample(wo, u_bsdf).wi_local); });
}

void textures(const Scene& scene, Packet& p) {
  const Vec2<F> uv = p.square();
  for (std::int32_t id = 0; id < scene.materials.count(); ++id)
    if (has_texture(scene.materials[id]))
      p.give(std::get<Diffuse>(scene.materials[id]).at(uv, every_lane()).albedo);
}
void inverse_error_function(const Scene&, Packet& p) { p.give(inverse_erf(p.real())); }
void split(const Scene&, Packet& p) { p.give(split_unit(p.real())); }

Receiver<F> receiver_at(const Vec3<F>& position) {
  const Vec3<F> up{F(0), F(0), F(1)};
  return {position, up, up, I(lit_side::front)};
}
void give_sample(Packet& p, const LightSample<F>& sample) {
  const Vec3<F> none{F(0), F(0), F(0)};
  p.give(select(sample.is_there, sample.wi, none));
  p.give(select(sample.is_there, sample.radiance_over_pdf, Color<F>{F(0), F(0), F(0)}));
  p.give(select(sample.is_there, sample.pdf_solid_angle, F(0)));
}
void light_end(const Scene& scene, Packet& p) {
  const I light = as_int(p.word());
  const Receiver<F> receiver = receiver_at(p.vec());
  p.give(scene.lights.sample<F>(light, F(1), receiver, p.words(), every_lane()).end);
}
/// The density that a hit where a sample ends has, by the normal that sphere and planes have there.
void light_pdf(const Scene& scene, Packet& p) {
  const I light = as_int(p.word());
  const Receiver<F> receiver = receiver_at(p.vec());
  const LightSample<F> sample = scene.lights.sample<F>(light, F(1), receiver, p.words(), every_lane());
  const LightHit<F> hit{sample.end, -sample.wi, sample.wi, I(0)};
  p.give(select(sample.is_there, scene.lights.pdf_solid_angle<F>(light, F(1), receiver, hit, every_lane()),
                F(0)));
}
/// Of a pentagon and a triangle.
PolygonFan<F> polygon_seen(Packet& p) {
  static const PolygonTable table = [] {
    PolygonTable made;
    made.add(
        std::array<Vec3f, 5>{Vec3f{0, 0, 2}, {-0.5f, 0.8f, 2}, {0.3f, 1.5f, 2}, {1.2f, 1, 2}, {1, 0, 2}});
    made.add(std::array<Vec3f, 3>{Vec3f{0, 0, 2}, {0.3f, 1.5f, 2.2f}, {1, 0, 2}});
    return made;
  }();
  const I row = as_int(p.word());
  return table.seen_from<F>(p.vec(), row, every_lane());
}
void spherical_polygon(const Scene&, Packet& p) {
  const PolygonFan<F> fan = polygon_seen(p);
  const SphericalPolygon<F> polygon(fan);
  p.give(polygon.solid_angle()), p.give(polygon.sample(p.square()));
}
void projected_polygon(const Scene&, Packet& p) {
  const PolygonFan<F> fan = polygon_seen(p);
  const ProjectedPolygon<F> polygon(fan, Frame<F>(Vec3<F>{F(0), F(0), F(1)}));
  p.give(polygon.projected_solid_angle()), p.give(polygon.sample(p.square()));
}
void is_projected_accurate(const Scene&, Packet& p) {
  const Frame<F> frame(p.vec());
  const PolygonFan<F> fan = polygon_seen(p);
  p.give(select(ProjectedPolygon<F>(fan, frame).is_accurate(), F(1), F(0)));
}
void spherical_ellipse(const Scene&, Packet& p) {
  const Vec3<F> center = p.vec();
  const SphericalEllipse<F> ellipse({center.x, center.y, center.z, p.real()});
  const Vec2<F> u = p.square();
  const auto sample = ellipse.sample(u);
  p.give(sample.on_disk), p.give(sample.pdf);
  // Next to the axis rounding decides in which wedge a point is.
  const F off_axis = max(abs(u.x - F(0.5f)), abs(u.y - F(0.5f)));
  p.give(select(off_axis > F(1e-3f), ellipse.pdf(sample.on_disk), F(0)));
}
void projected_cap(const Scene&, Packet& p) {
  const Vec3<F> axis = p.vec(), normal = p.vec();
  const CapOverHorizon<F> over_horizon(axis, p.real(), normal);
  const ProjectedCap<F> cap(over_horizon);
  F pdf;
  const Vec2<F> u = p.square();
  const CapDirection<F> direction = cap.sample(u, pdf);
  const auto where = [&](const F& value) { return select(cap.is_accurate(), value, F(0)); };
  p.give(where(direction.up)), p.give(where(direction.across)), p.give(where(direction.axis));
  // At the ends of a cut cap's slices the density is a quotient of what vanishes.
  const Mask<F> is_inside = mask_and(u.x > F(1e-3f), u.x<F(1 - 1e-3f), u.y> F(1e-3f), u.y < F(1 - 1e-3f));
  p.give(where(direction.cos_theta)), p.give(where(select(is_inside, pdf, F(0))));
}

template <class Sampler>
void lights_sample(const Scene& scene, Packet& p) {
  const Receiver<F> receiver = receiver_at(p.vec());
  const Vec2<U> u = p.words();
  const LightChoice<F> choice = Sampler(scene.lights).template choose<F>(receiver, u.x, 0);
  give_sample(p,
              scene.lights.sample<F>(choice.light, choice.pmf, receiver, {choice.u_left, u.y}, every_lane()));
}

/// Of a cluster to a receiver at the origin that is lit from the front.
void light_importance(const Scene&, Packet& p) {
  const Vec3<F> axis = p.vec();
  const Vec3<F> normal = p.vec();
  const Vec3<F> center = p.vec();
  const F radius_sq = p.real(), cos_normals = p.real();
  const Receiver<F> receiver{{F(0), F(0), F(0)}, normal, normal, I(lit_side::front)};
  const Importance<F> of = importance<F>({center, axis, radius_sq, cos_normals, F(1)}, receiver);
  p.give(of.value), p.give(of.spread_sq), p.give(of.wi);
}

void environment(const Scene& scene, Packet& p) {
  const Vec3<F> direction = p.vec();
  const Vec3<F> normal{F(0), F(0), F(1)};
  const Receiver<F> receiver{{F(0), F(0), F(0)}, normal, normal, I(lit_side::front)};
  Color<F> radiance{F(0), F(0), F(0)};
  F pdf(0);
  for (std::int32_t k = 0; k < scene.lights.infinite_count(); ++k) {
    radiance = radiance + scene.lights.infinite_radiance<F>(k, direction, every_lane());
    for (const LightTechnique technique : {LightTechnique::area, LightTechnique::automatic})
      pdf = pdf + scene.lights.infinite_pdf_solid_angle<F>(k, receiver, direction, every_lane(), technique);
  }
  p.give(radiance), p.give(pdf);
}

template <Heuristic heuristic>
void weight(const Scene&, Packet& p) {
  const F own = p.real(), other = p.real();
  p.give(mis_weight(heuristic, own, other));
}

constexpr WideFunction functions[]{
    {"sample_2d independent", 3, 4, Words::integers, run<sample<SamplerKind::independent>>},
    {"sample_2d sobol", 3, 4, Words::integers, run<sample<SamplerKind::sobol>>},
    {"mul_hi", 2, 1, Words::integers, run<word_multiply_high>},
    {"less", 2, 1, Words::integers, run<word_less>},
    {"hash32", 1, 1, Words::integers, run<word_hash>},
    {"to_unit_float", 1, 1, Words::integers, run<unit_float>},
    {"to_int", 1, 1, Words::integers, run<truncation>},
    {"exp", 1, 1, Words::floats, run<exponential>},
    {"log", 1, 1, Words::floats, run<logarithm>},
    {"pow_positive", 2, 1, Words::floats, run<power>},
    {"sincos_turns", 1, 2, Words::floats, run<sine_and_cosine>},
    {"atan2", 2, 1, Words::floats, run<angle_of>},
    {"square_to_triangle", 2, 2, Words::floats, run<triangle>},
    {"square_to_cosine_hemisphere", 2, 3, Words::floats, run<cosine_hemisphere>},
    {"cosine_hemisphere_pdf", 1, 1, Words::floats, run<cosine_hemisphere_pdf>},
    {"square_to_power_cosine", 3, 3, Words::floats, run<power_cosine>},
    {"power_cosine_pdf", 2, 1, Words::floats, run<power_cosine_pdf>},
    {"square_to_uniform_cone", 3, 3, Words::floats, run<uniform_cone>},
    {"uniform_cone_pdf", 1, 1, Words::floats, run<uniform_cone_pdf>},
    {"square_to_uniform_disk", 2, 2, Words::floats, run<uniform_disk>},
    {"square_to_uniform_sphere", 2, 3, Words::floats, run<uniform_sphere>},
    {"sphere_uv", 4, 2, Words::floats, run<uv_of_sphere>},
    {"disk_uv", 2, 2, Words::floats, run<uv_of_disk>},
    {"Frame", 6, 12, Words::floats, run<frame>},
    {"sample_offset_px", 1, 1, Words::floats, run<filter_offset>},
    {"sample_offset_px, sample_weight", 2, 2, Words::floats, run<signed_filter_offset>},
    {"Camera::ray", 2, 8, Words::floats, run<camera_ray>},
    {"Camera::ray, lens", 4, 8, Words::floats, run<lens_ray>},
    {"interpolate_normal", 4, 3, Words::floats, run<smooth_normal>},
    {"Diffuse::eval", 6, 3, Words::floats, run<bsdf_eval<0>>},
    {"Diffuse::pdf_solid_angle", 6, 1, Words::floats, run<bsdf_pdf<0>>},
    {"Diffuse::sample", 5, 3, Words::floats, run<bsdf_sample<0>>},
    {"Phong::eval", 6, 3, Words::floats, run<bsdf_eval<1>>},
    {"Phong::pdf_solid_angle", 6, 1, Words::floats, run<bsdf_pdf<1>>},
    {"Phong::sample", 5, 3, Words::floats, run<bsdf_sample<1>>},
    {"Microfacet::eval", 6, 3, Words::floats, run<bsdf_eval<3>>},
    {"Microfacet::pdf_solid_angle", 6, 1, Words::floats, run<bsdf_pdf<3>>},
    {"Microfacet::sample", 5, 3, Words::floats, run<bsdf_sample<3>>},
    {"RoughConductor ggx::eval", 6, 3, Words::floats, run<bsdf_eval<4>>},
    {"RoughConductor ggx::pdf_solid_angle", 6, 1, Words::floats, run<bsdf_pdf<4>>},
    {"RoughConductor ggx::sample", 5, 3, Words::floats, run<bsdf_sample<4>>},
    {"RoughConductor beckmann::eval", 6, 3, Words::floats, run<bsdf_eval<5>>},
    {"RoughConductor beckmann::pdf_solid_angle", 6, 1, Words::floats, run<bsdf_pdf<5>>},
    {"RoughConductor beckmann::sample", 5, 3, Words::floats, run<bsdf_sample<5>>},
    {"RoughDielectric ggx::eval", 6, 3, Words::floats, run<bsdf_eval<6>>},
    {"RoughDielectric ggx::pdf_solid_angle", 6, 1, Words::floats, run<bsdf_pdf<6>>},
    {"RoughDielectric ggx::sample", 5, 3, Words::floats, run<bsdf_sample<6>>},
    {"RoughDielectric beckmann::eval", 6, 3, Words::floats, run<bsdf_eval<7>>},
    {"RoughDielectric beckmann::pdf_solid_angle", 6, 1, Words::floats, run<bsdf_pdf<7>>},
    {"RoughDielectric beckmann::sample", 5, 3, Words::floats, run<bsdf_sample<7>>},
    {"Dielectric::sample", 5, 3, Words::floats, run<bsdf_sample<8>>},
    {"textures", 2, 9, Words::floats, run<textures>},
    {"inverse_erf", 1, 1, Words::floats, run<inverse_error_function>},
    {"split_unit", 1, 2, Words::integers, run<split>},
    {"Lights::sample end", 6, 3, Words::floats, run<light_end>},
    {"Lights::pdf_solid_angle", 6, 1, Words::floats, run<light_pdf>},
    {"SphericalPolygon", 6, 4, Words::floats, run<spherical_polygon>},
    {"ProjectedPolygon", 6, 4, Words::floats, run<projected_polygon>},
    {"ProjectedPolygon::is_accurate", 7, 1, Words::floats, run<is_projected_accurate>},
    {"SphericalEllipse", 6, 4, Words::floats, run<spherical_ellipse>},
    {"ProjectedCap", 9, 5, Words::floats, run<projected_cap>},
    {"sample of a uniform light", 5, 7, Words::floats, run<lights_sample<UniformLights>>},
    {"sample of a light by power", 5, 7, Words::floats, run<lights_sample<PowerLights>>},
    {"importance of lights", 11, 5, Words::floats, run<light_importance>},
    {"environment", 3, 4, Words::floats, run<environment>},
    {"mis_weight balance", 2, 1, Words::floats, run<weight<Heuristic::balance>>},
    {"mis_weight power", 2, 1, Words::floats, run<weight<Heuristic::power>>},
};

}  // namespace

}  // namespace etendue

extern "C" __attribute__((visibility("default"))) etendue::WideFunctions etendue_wide_functions();
etendue::WideFunctions etendue_wide_functions() {
  return {etendue::functions, std::size(etendue::functions)};
}

// The BSDF stages: sample a direction at every vertex, decide which paths go on, and follow those.
#pragma once

#include "base/frame.h"
#include "integrator/block_receiver.h"
#include "integrator/camera_stage.h"
#include "integrator/contribution.h"
#include "integrator/path_rules.h"
#include "integrator/vertex.h"

#include <limits>

namespace etendue {

/// Paths are ended at random from this vertex on.
inline constexpr int first_roulette_vertex = 2;
/// No path goes on for certain, so that light between perfect mirrors comes to an end.
inline constexpr float most_survival = 0.99f;

/// The probability that Russian roulette lets a path go on: min(factor max(throughput) eta^2, 0.99). The
/// throughput of radiance falls by eta^2 on the way into a denser medium, and rises again on the way out:
/// that is no reason to end it. \param factor PathRules::roulette_factor()
template <class F>
F survival(const Color<F>& throughput, const F& eta, float factor) {
  return min(max(max(throughput.r, throughput.g), throughput.b) * eta * eta * F(factor), F(most_survival));
}

/// For each path: a direction from the BSDF (or phase function) at its vertex, the ray along it, and the
/// path's throughput and density with it.
template <class F>
[[gnu::noinline]] void sample_bsdf(const Scene& scene, SampleBlock& block, const PathRules& rules,
                                   int vertex_number) {
  PathColumns& path = block.path;
  const int several = rules.bsdf_samples(vertex_number);
  const F infinity(std::numeric_limits<float>::infinity());
  for (int i = 0; i < path.padded_count; i += lane_count_v<F>) {
    const Vertex<F> vertex(scene, load_ray<F>(path.ray, i), load_hit<F>(path.hit, i));
    if (!any(vertex.is_there)) {
      store_lanes(&block.next_ray.is_active[i], Int<F>(0));
      continue;
    }
    const Vec2<F> u_bsdf = to_unit_floats<F>(
        sample_bits<F>(scene, path, i, dimension::at_vertex(dimension::bsdf, vertex_number)));
    const Frame<F> frame(vertex.ns);
    const Vec3<F> wo_local = frame.local_from_world(vertex.wo);
    BsdfSample<F> sample{{F(0), F(0), F(1)}, black<F>(), F(0), F(1)};
    for_each_scatterer<F>(scene, vertex, vertex.is_there, [&](const auto& bsdf, const Mask<F>& lanes) {
      sample = select(lanes, bsdf.sample(wo_local, u_bsdf), sample);
    });
    // Made unit: a frame about a direction that is not gives one that is less so, and errors would grow with
    // each vertex.
    const F size_sq = length_sq(sample.wi_local);
    const Vec3<F> wi = normalize(frame.world_from_local(sample.wi_local));
    const Mask<F> is_dirac = sample.pdf_solid_angle == infinity;
    Color<F> throughput = load_lanes<F>(path.throughput, i) * sample.weight;
    if (several > 1) throughput = throughput * F(1 / float(several));
    const F eta = load_lanes<F>(&path.eta[i]) * sample.eta;
    const Mask<F> is_number = mask_and(
        is_finite_nonnegative(throughput.r), is_finite_nonnegative(throughput.g),
        is_finite_nonnegative(throughput.b), sample.pdf_solid_angle >= F(0), abs(size_sq - F(1)) < F(1e-3f));
    const Mask<F> is_lost = mask_and(vertex.is_there, mask_not(is_number));
    // What is not a number must reach the sum, where it is reported.
    if (any(is_lost)) {
      const F nan(std::numeric_limits<float>::quiet_NaN());
      add_radiance<F>(block, i, is_lost, Color<F>{nan, nan, nan});
    }
    Mask<F> goes_on =
        mask_and(vertex.is_there, is_number, sample.pdf_solid_angle > F(0), mask_not(is_black(throughput)),
                 mask_or(is_dirac, vertex.is_consistent(wo_local.z, sample.wi_local.z, wi)));
    const Mask<F> is_alone =
        rules.is_shared_only_where_glossy() ? vertex.leaves_direct_light_to_lights(scene) : F(1) < F(0);
    if (rules.length() == PathLength::one_vertex) goes_on = mask_and(goes_on, mask_not(is_alone));
    if (rules.is_dirac_only()) goes_on = mask_and(goes_on, is_dirac);
    if (vertex_number >= first_roulette_vertex) {
      const F probability = survival(throughput, eta, rules.roulette_factor());
      const F u_roulette = to_unit_float(
          sample_bits<F>(scene, path, i, dimension::at_vertex(dimension::choice, vertex_number)).x);
      goes_on = mask_and(goes_on, u_roulette < probability);
      throughput = throughput * (F(1) / probability);
    }
    store_mask<F>(&block.next_ray.is_active[i], goes_on);
    store_lanes(block.next_ray.origin, i, vertex.origin_of_ray(wi));
    store_lanes(block.next_ray.direction, i, wi);
    store_lanes(path.throughput, i, throughput);
    store_lanes(&path.pdf[i], select(is_alone, F(0), sample.pdf_solid_angle));
    store_lanes(&path.eta[i], eta);
    if (rules.needs_both_pdfs())
      store_receiver(path.receiver, i, receiver_at<F>(scene, block, i, vertex, vertex_number));
  }
  block.clock.finish(Stage::bsdf_samples);
}

/// Leaves out the paths that have ended: the others move up, in their order, so that packets stay full, and
/// their next ray becomes the one that arrives. \param keeps_receivers their vertices too, for weights
template <class F>
[[gnu::noinline]] void follow_paths(SampleBlock& block, bool keeps_receivers) {
  PathColumns& path = block.path;
  Column<std::int32_t>& kept = block.kept;
  int count = 0;
  for (int i = 0; i < path.count; ++i) {
    kept[std::size_t(count)] = i;
    count -= block.next_ray.is_active[i];
  }
  path.count = count;
  path.padded_count = (count + widest_lanes - 1) / widest_lanes * widest_lanes;
  for (int k = count; k < path.padded_count; ++k) kept[std::size_t(k)] = kept[std::size_t(count - 1)];

  // In place, because a row never moves down and is read before its place is taken.
  for (int k = 0; k < path.padded_count; k += lane_count_v<F>) {
    const Int<F> from = load_lanes<Int<F>>(&kept[k]);
    const auto move = [&](auto& column) { store_lanes(&column[k], gather(column.data(), from)); };
    const auto move_from = [&](auto& column, const auto& source) {
      store_lanes(&column[k], gather(source.data(), from));
    };
    move(path.sample);
    move(path.stream_lo);
    move(path.stream_hi);
    move(path.index);
    move(path.throughput.r);
    move(path.throughput.g);
    move(path.throughput.b);
    move(path.pdf);
    move(path.eta);
    if (keeps_receivers) {
      ReceiverColumns& receiver = path.receiver;
      const auto move_vector = [&](Vec3Column& v) { move(v.x), move(v.y), move(v.z); };
      for (Vec3Column* v : {&receiver.position, &receiver.ng, &receiver.ns}) move_vector(*v);
      move(receiver.lit_sides);
      move(receiver.cut);
      if (receiver.lobes) move(receiver.material), move_vector(receiver.wo);
    }
    move_from(path.ray.origin.x, block.next_ray.origin.x);
    move_from(path.ray.origin.y, block.next_ray.origin.y);
    move_from(path.ray.origin.z, block.next_ray.origin.z);
    move_from(path.ray.direction.x, block.next_ray.direction.x);
    move_from(path.ray.direction.y, block.next_ray.direction.y);
    move_from(path.ray.direction.z, block.next_ray.direction.z);
    store_lanes(&path.ray.t_near[k], F(0));
    store_lanes(&path.ray.t_far[k], F(std::numeric_limits<float>::infinity()));
    store_lanes(&path.ray.is_active[k], Int<F>(-1));
  }
  for (int k = count; k < path.padded_count; ++k) path.ray.is_active[k] = 0;
  block.is_in_sample_order = block.is_in_sample_order && count == block.count;
  block.counts.bsdf_rays += count;
  block.clock.finish(Stage::following);
}

}  // namespace etendue

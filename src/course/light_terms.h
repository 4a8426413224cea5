// What one sample of a light is worth at a receiver, term by term: right, and as a mistake would have it.
#pragma once

#include "base/color.h"
#include "base/vec.h"

namespace etendue {

/// A point on a light, as a receiver sees it.
struct LightPointFacts {
  int light = 0;  ///< In the order of Scene::getLuminaires.
  Colorf radiance{0, 0, 0};
  double choice_probability = 1;  ///< Of this light; alike for all, unless the choices say otherwise.
  double points_per_sample = 1;   ///< How many points it takes a sample.
  double area = 1, first_triangle_area = 1, triangle_count = 1;  ///< Areas in m^2.
  double distance = 1;                                           ///< m
  double cos_receiver = 0, cos_receiver_geometric = 0, cos_light = 0, cos_light_shading = 0, cos_view = 0;
  Vec3<double> direction{0, 0, 1};  ///< To the light, world.
  /// 1/sr; the others with directions of the world, with the one to the light above the surface, and in the
  /// frame of the geometric normal.
  Colorf bsdf{0, 0, 0}, bsdf_of_world{0, 0, 0}, bsdf_mirrored{0, 0, 0}, bsdf_geometric{0, 0, 0};
  bool is_visible = true, is_hidden_by_light_only = false;
  bool is_visible_to_student = true;  ///< By the first ray that was cast for this point.
};

/// The product of these is the sample.
struct LightTerms {
  Colorf bsdf, radiance;
  double visibility, cos_receiver, cos_light, inverse_distance_sq, area, inverse_choice, factor;

  Colorf value() const {
    const double all =
        visibility * cos_receiver * cos_light * inverse_distance_sq * area * inverse_choice * factor;
    return bsdf * radiance * float(all);
  }
};

LightTerms right_terms(const LightPointFacts& facts);

}  // namespace etendue

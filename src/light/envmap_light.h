// Lights that are environment maps.
#pragma once

#include "base/transform.h"
#include "light/envmap.h"
#include "light/light_table.h"
#include "scenefile/parameters.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace etendue {

/// Strength: a factor of the map's radiance.
class EnvmapLights {
 public:
  /// \param world_from_map a rotation, perhaps with a mirror image
  std::int32_t add(Envmap map, const Transform& world_from_map);

  static constexpr LightPlace place = LightPlace::infinity;

  /// Maps are few: the lanes of each are sampled in turn.
  template <class F>
  LightSample<F> sample(const LightRequest<F>& request) const {
    LightSample<F> result = no_light_sample<F>();
    for_each_unique<F>(request.row, request.lanes, [&](std::int32_t which, const Mask<F>& lanes) {
      const Placed& placed = maps_[std::size_t(which)];
      const Envmap::Sample<F> sample = placed.map.template sample<F>(request.u);
      const F pdf = sample.value.pdf_solid_angle;
      const Mask<F> is_there = mask_and(lanes, pdf > F(0));
      const Vec3<F> wi = placed.template world_from_map<F>(sample.direction);
      const F inv_pdf = F(1) / select(is_there, pdf, F(1));
      result = select(lanes,
                      light_sample_towards<F>(wi, beyond_scene(request, wi), sample.value.radiance * inv_pdf,
                                              pdf, is_there, request, sample.piece),
                      result);
    });
    return result;
  }

  double power(std::int32_t row, const Sphere& scene_bounds) const {
    return maps_[std::size_t(row)].map.mean_luminance() * 4 * double(pi) * cross_section(scene_bounds);
  }
  /// Of all maps: Envmap::compensate.
  void compensate() {
    for (Placed& placed : maps_) placed.map.compensate();
  }
  std::optional<LightBounds> bounds(std::int32_t /*row*/) const { return std::nullopt; }

  /// Per unit of strength, W/(m^2 sr).
  template <class F>
  Color<F> radiance(std::int32_t row, const Vec3<F>& direction, const Mask<F>& m) const {
    return value<F>(row, direction, m).radiance;
  }
  /// The density (1/sr) with which `sample` gives `direction`.
  template <class F>
  F pdf_solid_angle(std::int32_t row, const Receiver<F>& /*receiver*/, const Vec3<F>& direction,
                    LightTechnique /*technique*/, const Mask<F>& m) const {
    return value<F>(row, direction, m).pdf_solid_angle;
  }

 private:
  struct Placed {
    Envmap map;
    std::array<Vec3f, 3> axes;  ///< Of the map, in the world.

    template <class F>
    Vec3<F> world_from_map(const Vec3<F>& d) const {
      const auto axis = [&](std::size_t k) { return Vec3<F>{F(axes[k].x), F(axes[k].y), F(axes[k].z)}; };
      return axis(0) * d.x + axis(1) * d.y + axis(2) * d.z;
    }
  };

  template <class F>
  Envmap::Value<F> value(std::int32_t row, const Vec3<F>& direction, const Mask<F>& m) const {
    const Placed& placed = maps_[std::size_t(row)];
    const auto along = [&](std::size_t k) {
      const Vec3f& axis = placed.axes[k];
      return direction.x * F(axis.x) + direction.y * F(axis.y) + direction.z * F(axis.z);
    };
    return placed.map.template at<F>({along(0), along(1), along(2)}, m);
  }

  std::vector<Placed> maps_;
};

struct EnvmapLight {
  Envmap map;
  Transform world_from_map;  ///< A rotation, perhaps with a mirror image.
  float scale;
};
extern const Plugin envmap_plugin;
/// Throws InputError for an image that cannot be read, has no colour, or whose texels are all 0; for a NaN,
/// infinite, negative or huge texel with its place.
EnvmapLight make_envmap_light(const Object& description, const std::filesystem::path& directory,
                              std::vector<UnreadKey>& unread);

}  // namespace etendue

// The kinds of light, a table each, and which light is in which row of which table.
#pragma once

#include "base/lookup_table.h"
#include "light/directional_light.h"
#include "light/disk_light.h"
#include "light/distant_disk_light.h"
#include "light/envmap_light.h"
#include "light/light_table.h"
#include "light/mesh_light.h"
#include "light/point_light.h"
#include "light/rectangle_light.h"
#include "light/sphere_light.h"
#include "light/spot_light.h"
#include "light/textured_light_sampling.h"

#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace etendue {

/// All kinds.
using LightKinds = std::tuple<MeshLights, RectangleLights, SphereLights, DiskLights, PointLights, SpotLights,
                              DirectionalLights, DistantDiskLights, EnvmapLights, TexturedLights>;
inline constexpr std::size_t light_kind_count = std::tuple_size_v<LightKinds>;

/// Light tables by their number among the kinds.
class LightTables {
 public:
  template <class Table>
  const Table& table() const {
    return std::get<Table>(tables_);
  }

  std::int32_t count() const { return kind_.size(); }
  /// Lights at infinity that rays meet: distant disks and environment maps, k = 0 .. infinite_count() - 1.
  std::int32_t infinite_count() const { return std::int32_t(infinite_.size()); }
  std::int32_t infinite_light(std::int32_t k) const { return infinite_[std::size_t(k)]; }  ///< Its id.
  /// Points, spots and directions, which no ray can meet.
  std::int32_t dirac_count() const { return count() - surface_count_ - infinite_count(); }

 protected:
  template <class Table>
  static constexpr std::int32_t kind_of() {
    return []<std::size_t... k>(std::index_sequence<k...>) {
      return ((std::is_same_v<Table, std::tuple_element_t<k, LightKinds>> ? std::int32_t(k) : 0) + ...);
    }(std::make_index_sequence<light_kind_count>{});
  }

  /// f(table) for the table of this kind.
  template <class Function>
  void with_table(std::int32_t kind, Function&& f) const {
    [&]<std::size_t... k>(std::index_sequence<k...>) {
      ((kind == std::int32_t(k) ? f(std::get<k>(tables_)) : void()), ...);
    }(std::make_index_sequence<light_kind_count>{});
  }

  /// f(table, row, lanes) for each kind among the lights in the lanes of `m`; rows are valid in all lanes.
  template <class F, class Function>
  void for_each_kind(const Int<F>& light, const Mask<F>& m, Function&& f) const {
    const Int<F> safe = select(m, light, Int<F>(0));
    const Int<F> kinds = kind_.at(safe), rows = row_.at(safe);
    for_each_unique<F>(kinds, m, [&](std::int32_t kind, const Mask<F>& lanes) {
      with_table(kind, [&](const auto& table) {
        static_assert(LightTable<std::remove_cvref_t<decltype(table)>>, "see light/light_table.h");
        f(table, select(lanes, rows, Int<F>(0)), lanes);
      });
    });
  }

  /// f(table, row) for a light that rays meet at infinity.
  template <class Function>
  void with_infinite_table(std::int32_t light, Function&& f) const {
    with_table(kind_[light], [&](const auto& table) {
      if constexpr (InfiniteLightTable<std::remove_cvref_t<decltype(table)>>) f(table, row_[light]);
    });
  }

  LightKinds tables_;
  LookupTable<std::int32_t> kind_, row_;  ///< Of each light, by its id: which table, and the row in it.
  std::vector<std::int32_t> infinite_;    ///< Ids of the lights that rays meet at infinity.
  std::int32_t surface_count_ = 0;
};

}  // namespace etendue

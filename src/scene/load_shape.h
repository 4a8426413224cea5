// One shape of the file -> geometry, and a light where it shines.
#pragma once

#include "geometry/geometry.h"
#include "light/light.h"
#include "scene/load_light.h"
#include "scene/mesh_files.h"
#include "scenefile/parameters.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

bool is_bsdf(const Object& object);  ///< <bsdf> or <brdf>

const std::vector<Plugin>& shape_plugins();

/// Reads or makes the shape `object` and adds it to `geometry`, and to `lights` where it shines.
/// \param lift along its front, from where the file has it (m)
/// Throws InputError for an unknown shape, a file that cannot be read, a singular transform, a light without
/// area.
void add_shape_geometry(const Object& object, const std::filesystem::path& directory, SurfaceIds ids,
                        const std::optional<AreaLight>& light, float lift, MeshFiles& meshes,
                        Geometry& geometry, Lights& lights, std::vector<UnreadKey>& unread,
                        std::vector<std::string>& warnings);

}  // namespace etendue

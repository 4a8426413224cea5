// A student's image of a scene against that of the program's `light`.
#pragma once

#include "course/check_property.h"
#include "course/student_module.h"
#include "image/image_file.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace etendue {

struct SceneCheck {
  CheckedProperty property;
  Image students, lights,
      difference;  ///< R, G, B. The last: student's over light's, from blue over grey to red.
  double seconds_students = 0, seconds_lights = 0;  ///< Of the two renders.
};

/// At 96 pixels across, block by block (Welch's test, both noises estimated).
/// \param scenes how many of them share level_of_scenes
SceneCheck check_scene(const StudentModule& module, const std::string& integrator,
                       const std::filesystem::path& scene, std::uint64_t seed, int scenes);

}  // namespace etendue

// Modules of the course kit that the build has made of tests/course/NAME.cpp.
#pragma once

#include "course/student_integrator.h"
#include "scene/load_scene.h"

#include <memory>
#include <string>

namespace etendue::test {

inline StudentModule course_module(const std::string& name) {
  return StudentModule(ETENDUE_BINARY_DIR "/tests/libcourse_" + name + ".so");
}

/// Over a scene that must outlive it.
inline std::shared_ptr<const StudentIntegrator> student_integrator(const std::string& module,
                                                                   const LoadedScene& loaded) {
  return std::make_shared<const StudentIntegrator>(course_module(module), "", loaded.scene, loaded.places,
                                                   loaded.integrator);
}

}  // namespace etendue::test

// A student's integrator over a scene: one sample at a time, and as an integrator like any other.
#pragma once

#include "course/student_module.h"
#include "course/student_scene.h"
#include "integrator/integrator.h"

#include <memory>
#include <string_view>

namespace etendue {

class StudentIntegrator {
 public:
  /// \param scene must outlive it and stay where it is
  /// \param description what the scene file states of its integrator, where that is of this name
  /// Throws InputError with what the student's code throws.
  StudentIntegrator(const StudentModule& module, std::string_view name, const Scene& scene,
                    const ScenePlaces& places, const Object& description);

  /// Of the plugin's own text, which lives as long as the program.
  std::string_view name() const { return class_->name; }
  /// As of its module.
  const std::string& module_identity() const { return identity_; }
  const StudentScene& scene() const { return scene_; }

  /// One sample of the radiance (W/(m^2 sr)) along a ray, as the student's Li gives it. May be called from
  /// many threads, each with a sampler of its own. Throws InputError with what the student's code throws.
  Colorf radiance(const Ray<float>& ray, float t_near, float t_far, nori::Sampler& sampler) const;

 private:
  std::string file_, identity_;
  const nori::ClassOfModule* class_;
  StudentScene scene_;
  std::unique_ptr<nori::Integrator> integrator_;
};

/// To render with.
IntegratorSettings settings_of(std::shared_ptr<const StudentIntegrator> integrator, SamplerKind sampler);

}  // namespace etendue

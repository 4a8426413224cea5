#include "course/student_integrator.h"

#include "course/stream_sampler.h"
#include "course/student_words.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace etendue {

namespace {

/// f(), with what it throws as an InputError that names the file.
template <class Function>
auto told_of_errors(const std::string& file, Function&& f) {
  try {
    return f();
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  } catch (...) {
    throw InputError(fmt::format("{}: it threw something that is no std::exception", file));
  }
}

class StudentProperties final : public nori::PropertyList {
 public:
  explicit StudentProperties(const Object& description) : description_(description) {}

 private:
  template <class T>
  const T* find(const std::string& name) const {
    const auto property = std::find_if(description_.properties.begin(), description_.properties.end(),
                                       [&](const Property& one) { return one.name == name; });
    return property == description_.properties.end() ? nullptr : std::get_if<T>(&property->value);
  }
  template <class Value, class T>
  static std::optional<Value> maybe(const T* stated) {
    return stated ? std::optional<Value>(Value(*stated)) : std::nullopt;
  }

  std::optional<bool> boolean(const std::string& name) const override {
    return maybe<bool>(find<bool>(name));
  }
  std::optional<int> integer(const std::string& name) const override { return maybe<int>(find<int>(name)); }
  std::optional<float> real(const std::string& name) const override {
    const int* whole = find<int>(name);
    return whole ? float(*whole) : maybe<float>(find<double>(name));
  }
  std::optional<std::string> text(const std::string& name) const override {
    return maybe<std::string>(find<std::string>(name));
  }
  std::optional<nori::Color3f> color(const std::string& name) const override {
    const Colorf* stated = find<Colorf>(name);
    return stated ? std::optional(to_student(*stated)) : std::nullopt;
  }
  std::optional<nori::Vector3f> vector(const std::string& name) const override {
    const auto* stated = find<Vec3<double>>(name);
    return stated ? std::optional(nori::Vector3f(float(stated->x), float(stated->y), float(stated->z)))
                  : std::nullopt;
  }

  const Object& description_;
};

}  // namespace

StudentIntegrator::StudentIntegrator(const StudentModule& module, std::string_view name, const Scene& scene,
                                     const ScenePlaces& places, const Object& description)
    : file_(module.file()), identity_(module.identity()), class_(&module.find(name)), scene_(scene, places) {
  const Object nothing;
  const StudentProperties properties(description.type == class_->name ? description : nothing);
  told_of_errors(file_, [&] {
    integrator_.reset(class_->make(properties));
    integrator_->preprocess(&scene_);
  });
}

Colorf StudentIntegrator::radiance(const Ray<float>& ray, float t_near, float t_far,
                                   nori::Sampler& sampler) const {
  return told_of_errors(file_, [&] {
    return from_student(integrator_->Li(
        &scene_, &sampler, nori::Ray3f(to_student(ray.origin), to_student(ray.direction), t_near, t_far)));
  });
}

IntegratorSettings settings_of(std::shared_ptr<const StudentIntegrator> integrator, SamplerKind sampler) {
  const std::string_view name = integrator->name();
  const std::string plugin = integrator->module_identity();
  return {name, SingleRays{plugin, [integrator = std::move(integrator), sampler](const CameraSample& sample) {
                             StreamSampler numbers(sampler, sample.stream);
                             return integrator->radiance(sample.ray, sample.t_near, sample.t_far, numbers);
                           }}};
}

}  // namespace etendue

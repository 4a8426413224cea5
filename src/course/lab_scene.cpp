#include "course/lab_scene.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace etendue {

namespace {

template <class T>
T* value_to_change(Object& object, std::string_view name) {
  for (Property& property : object.properties)
    if (property.name == name) return std::get_if<T>(&property.value);
  return nullptr;
}

bool is_phong(const Object& object) { return object.family == "bsdf" && object.type == "phong"; }

void change_size(Object& mesh, Object& luminaire, double factor) {
  if (auto* to_world = value_to_change<Transform>(mesh, "toWorld"))
    *to_world = *to_world * scaling({factor, factor, factor});
  if (auto* radiance = value_to_change<Colorf>(luminaire, "radiance"))
    *radiance = *radiance * float(1 / (factor * factor));
}

void change_exponent(Object& phong, double factor) {
  if (auto* exponent = value_to_change<double>(phong, "n")) *exponent *= factor;
}

}  // namespace

SceneDesc changed_plates(SceneDesc description, const LabChange& change) {
  for (Object& child : description.root.children) {
    if (child.family == "sampler") child.type = "independent";
    if (child.family == "camera") {
      if (auto* width = value_to_change<int>(child, "width")) *width = change.width;
      if (auto* height = value_to_change<int>(child, "height")) *height = change.height;
    }
    for (Object& part : child.children) {
      if (part.family == "luminaire") change_size(child, part, change.size_factor);
      if (is_phong(part)) change_exponent(part, change.exponent_factor);
    }
  }
  return description;
}

std::vector<std::int32_t> plate_shapes(const SceneDesc& description) {
  std::vector<std::int32_t> plates;
  std::int32_t shape = 0;
  for (const Object& child : description.root.children) {
    if (child.family != "mesh") continue;
    if (std::any_of(child.children.begin(), child.children.end(), is_phong)) plates.push_back(shape);
    ++shape;
  }
  return plates;
}

}  // namespace etendue

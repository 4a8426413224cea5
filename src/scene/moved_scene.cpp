#include "scene/moved_scene.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <variant>

namespace etendue {

namespace {

constexpr std::string_view to_world_key = "toWorld";

bool has_place(const Object& object) {
  constexpr std::array families{"camera", "mesh", "shape", "medium"};
  constexpr std::array lights{"point", "spot"};
  return std::find(families.begin(), families.end(), object.family) != families.end() ||
         std::find(lights.begin(), lights.end(), object.type) != lights.end();
}

/// Of an object, const or not; null where it states none.
auto* transform_of(auto& object) {
  decltype(std::get_if<Transform>(&object.properties.front().value)) found = nullptr;
  for (auto& property : object.properties)
    if (property.name == to_world_key && !found) found = std::get_if<Transform>(&property.value);
  return found;
}

void move(Object& object, const Transform& by) {
  if (has_place(object)) {
    if (Transform* transform = transform_of(object))
      *transform = by * *transform;
    else
      object.properties.push_back(
          {std::string(to_world_key), "transform", by, object.location, object.location});
  }
  for (Object& child : object.children) move(child, by);
}

}  // namespace

bool is_far_from_origin(const Sphere& shapes) { return length(shapes.center) > 4 * shapes.radius; }

SceneDesc moved_to_origin(const SceneDesc& description, const Vec3<double>& origin) {
  SceneDesc moved = description;
  move(moved.root, translation(-origin));
  return moved;
}

Vec3<double> camera_place(const SceneDesc& description) {
  for (const Object& object : description.root.children)
    if (object.family == "camera")
      if (const Transform* transform = transform_of(object)) return transform_point(*transform, {0, 0, 0});
  return {0, 0, 0};
}

}  // namespace etendue

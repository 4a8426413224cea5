#include "scene/load_scene.h"

#include "base/clock.h"
#include "geometry/bounds.h"
#include "scene/load_light.h"
#include "scene/load_shape.h"
#include "scene/moved_scene.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace etendue {

namespace {

/// Equal for objects that say the same in the same order, wherever they stand.
std::string text_of_object(const Object& object) {
  std::string text;
  const auto add_bytes = [&](const auto& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto add = [&](const std::string& part) {
    add_bytes(part.size());
    text += part;
  };
  add(object.family);
  add(object.type);
  add(object.name);
  add_bytes(object.properties.size());
  for (const Property& property : object.properties) {
    add(property.name);
    add_bytes(property.value.index());
    std::visit(
        [&](const auto& value) {
          if constexpr (std::is_same_v<decltype(value), const std::string&>)
            add(value);
          else
            add_bytes(value);
        },
        property.value);
  }
  for (const Object& child : object.children) add(text_of_object(child));
  return text;
}

/// Null where the file does not state it.
const Property* property_of(const Object& object, std::string_view name) {
  for (const Property& property : object.properties)
    if (property.name == name) return &property;
  return nullptr;
}

/// Collects the parts of a scene as the file lists them.
class Loader {
 public:
  Loader(const SceneDesc& description, const LoadSettings& settings)
      : description_(description),
        settings_(settings),
        meshes_(description.root),
        textures_{description.directory} {}

  LoadedScene load() {
    const Clock::time_point start = Clock::now();
    const Object& root = description_.root;
    places_.scene = root.location;
    if (root.family != "scene")
      throw InputError(root.location, fmt::format("the root is <{}>, not <scene>", root.family));
    Parameters(root, scene_plugin(), unread_);
    for (const Object& child : root.children) add(child);
    if (!camera_)
      throw InputError(root.location, "the scene has no camera",
                       "add <camera type=\"perspective\"> with a toWorld transform");
    if (geometry_.count() == 0)
      throw InputError(
          root.location, "the scene has no shapes",
          "add <mesh type=\"obj\"> with a filename; an environment or a medium alone is not rendered");
    const Sphere bounds = bounding_sphere(geometry_);
    const Sphere whole = medium_ ? medium_->bounds_with(bounds) : bounds;
    set_default_clip_planes(whole);
    lights_.set_scene_bounds(whole);
    camera_->approach(whole);
    const Clock::time_point start_of_build = Clock::now();
    RayCaster rays(geometry_, settings_.edges);
    const double seconds_build = seconds_since(start_of_build);
    const PixelFilter filter = filter_ ? *filter_ : PixelFilter::gaussian();
    LampOutlines lamp_outlines(*camera_, filter, geometry_, lights_);
    return {Scene{{0, 0, 0},
                  *camera_,
                  filter,
                  std::move(geometry_),
                  std::move(rays),
                  Materials(std::move(materials_)),
                  std::move(lights_),
                  medium_,
                  sampler_,
                  std::move(lamp_outlines)},
            std::move(places_),
            integrator_ ? *integrator_ : Object{},
            samples_per_pixel_,
            warnings(),
            seconds_since(start) - seconds_build,
            seconds_build};
  }

 private:
  static const Plugin& scene_plugin() {
    static const Plugin plugin{
        "scene",
        "",
        "",
        {},
        {"integrator", "sampler", "camera", "mesh", "shape", "emitter", "luminaire", "medium", "rfilter"}};
    return plugin;
  }

  void add(const Object& child) {
    if (child.family == "camera") {
      once(camera_.has_value(), child);
      camera_ = make_camera(child, description_.dialect, unread_);
      places_.camera = child.location;
      if (const Property* stated = property_of(child, "farClip")) places_.far_clip = stated->value_location;
      has_near_clip_ = property_of(child, "nearClip") != nullptr;
      for (const Object& part : child.children) {
        if (part.family == "rfilter")
          add_filter(part);
        else
          add_sampler(part);
      }
    } else if (child.family == "rfilter") {
      add_filter(child);
    } else if (child.family == "sampler") {
      add_sampler(child);
    } else if (child.family == "integrator") {
      once(integrator_.has_value(), child);
      integrator_ = child;
    } else if (child.family == "medium") {
      once(medium_.has_value(), child);
      medium_ = make_medium(child, unread_);
    } else if (is_light(child)) {
      if (child.type == area_light_name)
        throw InputError(child.location, "an area light is a shape: it has no place inside <scene>",
                         "put it inside a <mesh> or <shape>, which then shines");
      add_light(child, description_.directory, lights_, unread_);
      note_light(child);
    } else {
      add_shape(child);
    }
  }

  void add_filter(const Object& child) {
    once(filter_.has_value(), child);
    filter_ = make_filter(child, unread_);
  }

  void add_sampler(const Object& child) {
    once(has_sampler_, child);
    has_sampler_ = true;
    const Plugin* plugin = nullptr;
    for (const Plugin& known : sampler_plugins())
      if (known.name == child.type) plugin = &known;
    if (!plugin) throw unknown_plugin(child, sampler_plugins());
    const Parameters parameters(child, *plugin, unread_);
    sampler_ = sampler_from_name(child.type);
    samples_per_pixel_ = parameters.integer("sampleCount");
    if (samples_per_pixel_ < 1)
      throw InputError(parameters.location("sampleCount"),
                       fmt::format("'sampleCount' is {}; it must be at least 1", samples_per_pixel_));
  }

  void add_shape(const Object& object) {
    const Object* bsdf = nullptr;
    const Object* light = nullptr;
    for (const Object& part : object.children) {
      if (is_bsdf(part)) {
        once(bsdf, part);
        bsdf = &part;
      } else if (is_light(part)) {
        once(light, part);
        light = &part;
      }
    }
    SurfaceIds ids{.material = material_id(bsdf, object)};
    std::optional<AreaLight> area;
    if (light && light->type == area_light_name) {
      area = make_area_light(*light, textures_, unread_);
      ids.light = lights_.count();
    } else if (light) {
      add_light(*light, description_.directory, lights_, unread_);
      note_light(*light);
    }
    const bool is_lifted = std::find(settings_.lifted.begin(), settings_.lifted.end(), geometry_.count()) !=
                           settings_.lifted.end();
    add_shape_geometry(object, description_.directory, ids, area, is_lifted ? settings_.lift : 0, meshes_,
                       geometry_, lights_, unread_, warnings_);
    if (area && area->is_twosided) lights_.set_twosided(ids.light);
    note_shapes(object);
    if (light) note_light(*light);
    if (has_texture(materials_[std::size_t(ids.material)]) && geometry_.triangles.back() > 0 &&
        geometry_.has_uvs.back() == 0)
      warnings_.push_back(format_message(
          object.location,
          "this mesh has no texture coordinates: each of its triangles shows the same half of the "
          "texture's unit square, as in Nori"));
  }

  /// Of the material that `bsdf` describes, diffuse where there is none. Shapes whose descriptions are alike
  /// share one; where the description has keys that nobody reads, each is made, and warned of, by itself.
  std::int32_t material_id(const Object* bsdf, const Object& shape) {
    const std::string description = bsdf ? text_of_object(*bsdf) : "";
    if (const auto known = material_ids_.find(description); known != material_ids_.end())
      return known->second;
    const auto id = std::int32_t(materials_.size());
    const std::size_t unread_before = unread_.size();
    materials_.push_back(bsdf ? make_material(*bsdf, textures_, unread_) : Material{Diffuse{}});
    places_.materials.push_back(bsdf ? bsdf->location : shape.location);
    if (unread_.size() == unread_before) material_ids_.emplace(description, id);
    return id;
  }

  /// Nori's defaults, which the camera has, are for scenes of common sizes.
  void set_default_clip_planes(const Sphere& bounds) {
    // Clip planes are in the camera's own units.
    const double unit =
        std::abs(dot(camera_->at_film_origin, normalize(cross(camera_->per_px_x, camera_->per_px_y))));
    const double farthest = (length(widen(bounds.center) - camera_->origin) + bounds.radius) / unit;
    if (!places_.far_clip) camera_->far_clip = std::max(camera_->far_clip, float(1.01 * farthest));
    if (!has_near_clip_) camera_->near_clip *= float(std::min(1.0, bounds.radius / unit));
  }

  /// Of the geometries that `object` has become.
  void note_shapes(const Object& object) {
    const Property* to_world = property_of(object, "toWorld");
    const auto* transform = to_world ? std::get_if<Transform>(&to_world->value) : nullptr;
    const Property* file = property_of(object, "filename");
    const bool is_turned_over =
        file && transform && determinant(*transform) < 0 && geometry_.has_normals.back() == 0;
    const auto* filename = file ? std::get_if<std::string>(&file->value) : nullptr;
    const std::string name = !object.name.empty() ? fmt::format("{} '{}'", object.type, object.name)
                             : filename           ? fmt::format("{} '{}'", object.type, *filename)
                                        : fmt::format("{} {}", object.type, places_.shapes.size() + 1);
    places_.shapes.resize(std::size_t(geometry_.count()), {object.location, name, is_turned_over});
  }

  void note_light(const Object& object) {
    while (places_.lights.size() < std::size_t(lights_.count()))
      places_.lights.push_back({object.location, lights_.name(std::int32_t(places_.lights.size()))});
  }

  static void once(bool is_there, const Object& object) {
    if (is_there)
      throw InputError(object.location,
                       fmt::format("a second <{}>; there can be only one here", object.family));
  }

  std::vector<std::string> warnings() const {
    std::vector<std::string> all = description_.warnings;
    // What is said of a file is said once, however many shapes use it.
    std::unordered_set<std::string_view> said;
    for (const std::string& warning : warnings_)
      if (said.insert(warning).second) all.push_back(warning);
    for (const UnreadKey& key : unread_) all.push_back(key.message);
    return all;
  }

  const SceneDesc& description_;
  const LoadSettings& settings_;
  MeshFiles meshes_;
  TextureFiles textures_;
  std::optional<Camera> camera_;
  std::optional<PixelFilter> filter_;
  std::optional<Object> integrator_;
  bool has_sampler_ = false, has_near_clip_ = false;
  SamplerKind sampler_ = SamplerKind::independent;
  int samples_per_pixel_ = 16;
  Geometry geometry_;
  std::vector<Material> materials_;
  std::unordered_map<std::string, std::int32_t>
      material_ids_;  ///< By what text_of_object() makes of the BSDF.
  Lights lights_;
  ScenePlaces places_;
  std::optional<HomogeneousMedium> medium_;
  std::vector<UnreadKey> unread_;
  std::vector<std::string> warnings_;
};

}  // namespace

LoadedScene load_scene(const SceneDesc& description, const LoadSettings& settings) {
  const auto load_about = [&](const Vec3<double>& origin) {
    const SceneDesc moved = moved_to_origin(description, origin);
    LoadedScene loaded = Loader(moved, settings).load();
    loaded.scene.origin = origin;
    return loaded;
  };
  const auto load_nearer = [&](LoadedScene loaded) {
    const Sphere shapes = bounding_sphere(loaded.scene.geometry);
    if (!is_far_from_origin(shapes)) return loaded;
    const Vec3<double>& origin = loaded.scene.origin;
    return load_about(origin + widen(shapes.center));
  };
  try {
    return load_nearer(Loader(description, settings).load());
  } catch (const PlaceError&) {
    // Floats may tell apart near the camera what they do not where the file has it.
    const Vec3<double> camera = camera_place(description);
    if (!(length_sq(camera) > 0)) throw;
    std::optional<LoadedScene> loaded;
    try {
      loaded = load_about(camera);
    } catch (const InputError&) {
    }
    if (!loaded) throw;
    return load_nearer(std::move(*loaded));
  }
}

void check_has_light(const SceneDesc& description, const Scene& scene) {
  if (scene.lights.count() > 0) return;
  throw InputError(description.root.location, "the scene has no light: its image would be black",
                   fmt::format("put <{} type=\"area\"> with a radiance inside a mesh or shape",
                               description.dialect == Dialect::nori_2012 ? "luminaire" : "emitter"));
}

}  // namespace etendue

// What a plugin accepts, stated once: it drives reading, checking, `etendue info` and the documentation test.
#pragma once

#include "scenefile/scene_desc.h"

#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// One parameter of a plugin.
struct Parameter {
  enum class Type { boolean, integer, real, text, color, point, vector, transform, point2 };
  std::string name;
  Type type;
  std::string default_value;  ///< As text, parsed like the file's, or "identity"; empty: there is none.
  std::string unit;           ///< "m", "deg", "W/(m^2 sr)", "" for pure numbers.
  std::string meaning;
  bool is_required = false;
  bool accepts_texture = false;  ///< A child <texture name="..."> may stand for it.
};

/// A plugin of one family, as the scene file and `etendue info` name it.
struct Plugin {
  std::string family;  ///< integrator, sampler, camera, filter, shape, bsdf, light.
  std::string name;
  std::string meaning;
  std::vector<Parameter> parameters;
  std::vector<std::string> child_families;  ///< Tags that may stand inside, e.g. bsdf and light in a mesh.
};

/// A key that the file states and the plugin does not know; the caller logs it, or throws where strict.
struct UnreadKey {
  std::string message;  ///< Complete, with place and nearest known names.
};

/// The values of one object, checked against its plugin: types right, required ones present, defaults filled.
/// Object and plugin must outlive it. To ask for what the plugin does not have is a std::logic_error, and so
/// is to ask for the value of a parameter that the file gives by a texture.
class Parameters {
 public:
  /// Throws InputError for a wrong type, a missing required parameter, one stated twice (as values, as
  /// textures, or as both), a texture for what takes none, or a child of another family. Keys that the plugin
  /// does not know are appended to `unread`.
  Parameters(const Object& object, const Plugin& plugin, std::vector<UnreadKey>& unread);

  bool is_stated(std::string_view name) const;  ///< The file has it, as a value or as a texture.
  bool has(std::string_view name) const;        ///< There is a value: stated or by default.
  bool boolean(std::string_view name) const;
  int integer(std::string_view name) const;
  double real(std::string_view name) const;  ///< Integers are accepted.
  std::string text(std::string_view name) const;
  Colorf color(std::string_view name) const;        ///< A single number is grey.
  Vec3<double> point(std::string_view name) const;  ///< Either of <point> and <vector> is accepted for both.
  Vec3<double> vector(std::string_view name) const;
  Transform transform(std::string_view name) const;
  Vec2<double> point2(std::string_view name) const;  ///< Two numbers, of a <point> or a <vector>.

  /// The child <texture> that stands for this parameter; nullptr where there is none.
  const Object* texture(std::string_view name) const;

  /// Where the value stands; where it was defaulted, where the object stands.
  Location location(std::string_view name) const;
  const Object& object() const { return *object_; }

 private:
  struct Entry {
    const Parameter* parameter;
    Property::Value value;   ///< Of the alternative that parameter->type names.
    const Property* stated;  ///< Null where defaulted.
  };
  void read_children(const Plugin& plugin);
  void add_texture(const Object& texture, const Plugin& plugin);
  const Entry* find(std::string_view name) const;
  const Property::Value& value(std::string_view name) const;
  const Object* object_;
  std::vector<Entry> entries_;
  std::vector<const Object*> textures_;
};

/// A colour parameter whose channels must be finite and >= 0 (reflectance, radiance); else throws InputError.
Colorf nonnegative_color(const Parameters& parameters, std::string_view name);

/// The error for an object whose type none of `known` has: its place, the known names nearest first.
InputError unknown_plugin(const Object& object, const std::vector<Plugin>& known);
/// The same for a name that comes from the command line.
InputError unknown_plugin(std::string_view family, std::string_view name, const std::vector<Plugin>& known);

}  // namespace etendue

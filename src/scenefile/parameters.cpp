#include "scenefile/parameters.h"

#include "scenefile/foreign_names.h"
#include "scenefile/value_text.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace etendue {
namespace {

using Type = Parameter::Type;

/// What a person reads, and the tag to write.
struct TypeNames {
  std::string_view phrase, tag;
};

TypeNames names_of(Type type) {
  switch (type) {
    case Type::boolean:
      return {"true or false", "boolean"};
    case Type::integer:
      return {"an integer", "integer"};
    case Type::real:
      return {"a number", "float"};
    case Type::text:
      return {"text", "string"};
    case Type::color:
      return {"a colour", "color"};
    case Type::point:
      return {"a point", "point"};
    case Type::vector:
      return {"a vector", "vector"};
    case Type::transform:
      return {"a transform", "transform"};
    case Type::point2:
      return {"two numbers", "point"};
  }
  throw std::logic_error("a parameter of no type");
}

std::string object_text(const Object& object) {
  return object.type.empty() ? object.family : fmt::format("{} '{}'", object.family, object.type);
}

std::string element_to_write(const Parameter& parameter) {
  return fmt::format("write <{} name=\"{}\" {}/>", names_of(parameter.type).tag, parameter.name,
                     parameter.type == Type::transform ? "..." : "value=\"...\"");
}

Property::Value parse_default(const Parameter& parameter) {
  const std::string& text = parameter.default_value;
  try {
    switch (parameter.type) {
      case Type::boolean:
        return parse_boolean(text, {});
      case Type::integer:
        return parse_integer(text, {});
      case Type::real:
        return parse_real(text, {});
      case Type::text:
        return text;
      case Type::color:
        return parse_color(text, {});
      case Type::transform:
        return text == "identity" ? Transform{} : parse_matrix(text, {});
      case Type::point:
      case Type::vector: {
        const std::vector<double> numbers = parse_reals(text, {}, {3});
        return Vec3<double>{numbers[0], numbers[1], numbers[2]};
      }
      case Type::point2: {
        const std::vector<double> numbers = parse_reals(text, {}, {2});
        return Vec2<double>{numbers[0], numbers[1]};
      }
    }
  } catch (const InputError& error) {
    throw std::logic_error(fmt::format("the default of '{}': {}", parameter.name, error.what()));
  }
  throw std::logic_error("a parameter of no type");
}

/// The number of a <float> or an <integer>.
const double* real_of(const Property::Value& value, double& storage) {
  if (const int* integer = std::get_if<int>(&value))
    storage = *integer;
  else if (const double* real = std::get_if<double>(&value))
    storage = *real;
  else
    return nullptr;
  return &storage;
}

/// The stated value as the type the plugin asks for.
Property::Value convert(const Property& property, const Parameter& parameter, const Object& object) {
  const Property::Value& value = property.value;
  double number = 0;
  switch (parameter.type) {
    case Type::boolean:
      if (std::holds_alternative<bool>(value)) return value;
      break;
    case Type::integer:
      if (std::holds_alternative<int>(value)) return value;
      break;
    case Type::real:
      if (real_of(value, number)) return number;
      break;
    case Type::text:
      if (std::holds_alternative<std::string>(value)) return value;
      break;
    case Type::color:
      if (std::holds_alternative<Colorf>(value)) return value;
      if (real_of(value, number)) {
        const auto grey = static_cast<float>(number);
        if (!std::isfinite(grey))
          throw InputError(property.value_location, "a colour channel is out of range for a 32-bit float");
        return Colorf{grey, grey, grey};
      }
      break;
    case Type::point:
    case Type::vector:
      if (std::holds_alternative<Vec3<double>>(value)) return value;
      if (std::holds_alternative<Vec2<double>>(value))
        throw InputError(property.value_location, fmt::format("'{}' of {} needs 3 numbers, found 2",
                                                              property.name, object_text(object)));
      break;
    case Type::transform:
      if (std::holds_alternative<Transform>(value)) return value;
      break;
    case Type::point2:
      if (std::holds_alternative<Vec2<double>>(value)) return value;
      if (std::holds_alternative<Vec3<double>>(value))
        throw InputError(property.value_location, fmt::format("'{}' of {} needs 2 numbers, found 3",
                                                              property.name, object_text(object)));
      break;
  }
  throw InputError(property.value_location,
                   fmt::format("'{}' of {} must be {}, not a <{}>", property.name, object_text(object),
                               names_of(parameter.type).phrase, property.tag),
                   element_to_write(parameter));
}

template <class T>
std::vector<std::string> names_of(const std::vector<T>& named) {
  std::vector<std::string> names;
  for (const T& item : named) names.push_back(item.name);
  return names;
}

}  // namespace

Parameters::Parameters(const Object& object, const Plugin& plugin, std::vector<UnreadKey>& unread)
    : object_(&object) {
  read_children(plugin);
  for (const Property& property : object.properties) {
    const auto parameter =
        std::find_if(plugin.parameters.begin(), plugin.parameters.end(),
                     [&](const Parameter& candidate) { return candidate.name == property.name; });
    if (parameter == plugin.parameters.end()) {
      const ForeignKey* foreign = find_foreign_key(plugin.family, object.type, property.name);
      if (foreign && foreign->is_refused)
        throw InputError(property.name_location,
                         fmt::format("'{}' of {} is not known here, and would change the image",
                                     property.name, object_text(object)),
                         foreign->hint);
      unread.push_back({format_message(
          property.name_location, fmt::format("unknown key '{}' of {}", property.name, object_text(object)),
          foreign                     ? std::string(foreign->hint)
          : plugin.parameters.empty() ? "it has no keys at all; was this meant for another element?"
                                      : known_names(property.name, names_of(plugin.parameters)))});
      continue;
    }
    if (is_stated(property.name))
      throw InputError(property.name_location,
                       texture(property.name)
                           ? fmt::format("'{}' of {} is stated twice: as a value and as a texture",
                                         property.name, object_text(object))
                           : fmt::format("'{}' of {} is stated twice", property.name, object_text(object)));
    entries_.push_back({&*parameter, convert(property, *parameter, object), &property});
  }
  for (const Parameter& parameter : plugin.parameters) {
    if (is_stated(parameter.name)) continue;
    if (parameter.is_required)
      throw InputError(
          object.location,
          fmt::format("{} lacks '{}': {}", object_text(object), parameter.name, parameter.meaning),
          element_to_write(parameter));
    if (!parameter.default_value.empty()) entries_.push_back({&parameter, parse_default(parameter), nullptr});
  }
}

void Parameters::read_children(const Plugin& plugin) {
  const bool takes_textures = std::any_of(plugin.parameters.begin(), plugin.parameters.end(),
                                          [](const Parameter& p) { return p.accepts_texture; });
  std::vector<std::string> families = plugin.child_families;
  if (takes_textures) families.emplace_back("texture");
  for (const Object& child : object_->children) {
    if (std::find(families.begin(), families.end(), child.family) == families.end()) {
      const std::string hint = foreign_tag_hint(child.family);
      throw InputError(child.location,
                       fmt::format("<{}> has no place inside <{}>", child.family, object_->family),
                       !hint.empty()      ? hint
                       : families.empty() ? "nothing may stand in there but its keys"
                                          : known_names(child.family, families));
    }
    if (takes_textures && child.family == "texture") add_texture(child, plugin);
  }
}

void Parameters::add_texture(const Object& texture, const Plugin& plugin) {
  std::vector<std::string> textured;
  for (const Parameter& parameter : plugin.parameters)
    if (parameter.accepts_texture) textured.push_back(parameter.name);
  if (texture.name.empty())
    throw InputError(texture.location, "this <texture> does not say which parameter it stands for",
                     fmt::format("write <texture type=\"{}\" name=\"{}\">", texture.type, textured.front()));
  if (std::find(textured.begin(), textured.end(), texture.name) == textured.end())
    throw InputError(
        texture.location,
        fmt::format("no parameter '{}' of {} takes a texture", texture.name, object_text(*object_)),
        known_names(texture.name, textured));
  if (is_stated(texture.name))
    throw InputError(texture.location,
                     fmt::format("a second texture for '{}' of {}", texture.name, object_text(*object_)));
  textures_.push_back(&texture);
}

const Parameters::Entry* Parameters::find(std::string_view name) const {
  for (const Entry& entry : entries_)
    if (entry.parameter->name == name) return &entry;
  return nullptr;
}

const Property::Value& Parameters::value(std::string_view name) const {
  if (const Entry* entry = find(name)) return entry->value;
  throw std::logic_error(fmt::format("{} has no value '{}'", object_text(*object_), name));
}

bool Parameters::is_stated(std::string_view name) const {
  return texture(name) || (find(name) && find(name)->stated);
}
bool Parameters::has(std::string_view name) const { return find(name) != nullptr; }
bool Parameters::boolean(std::string_view name) const { return std::get<bool>(value(name)); }
int Parameters::integer(std::string_view name) const { return std::get<int>(value(name)); }
double Parameters::real(std::string_view name) const { return std::get<double>(value(name)); }
std::string Parameters::text(std::string_view name) const { return std::get<std::string>(value(name)); }
Colorf Parameters::color(std::string_view name) const { return std::get<Colorf>(value(name)); }
Vec3<double> Parameters::point(std::string_view name) const { return std::get<Vec3<double>>(value(name)); }
Vec3<double> Parameters::vector(std::string_view name) const { return std::get<Vec3<double>>(value(name)); }
Transform Parameters::transform(std::string_view name) const { return std::get<Transform>(value(name)); }
Vec2<double> Parameters::point2(std::string_view name) const { return std::get<Vec2<double>>(value(name)); }

const Object* Parameters::texture(std::string_view name) const {
  for (const Object* texture : textures_)
    if (texture->name == name) return texture;
  return nullptr;
}

Location Parameters::location(std::string_view name) const {
  if (const Object* there = texture(name)) return there->location;
  return is_stated(name) ? find(name)->stated->value_location : object_->location;
}

Colorf nonnegative_color(const Parameters& parameters, std::string_view name) {
  const Colorf color = parameters.color(name);
  for (const float channel : {color.r, color.g, color.b})
    if (!(channel >= 0 && std::isfinite(channel)))
      throw InputError(parameters.location(name),
                       fmt::format("'{}' of {} has a channel of {}; it must be finite and not negative", name,
                                   object_text(parameters.object()), channel));
  return color;
}

InputError unknown_plugin(const Object& object, const std::vector<Plugin>& known) {
  const std::string hint = foreign_plugin_hint(object.family, object.type);
  return {object.type_location, fmt::format("unknown {} '{}'", object.family, object.type),
          (hint.empty() ? "" : hint + "; ") + known_names(object.type, names_of(known))};
}

InputError unknown_plugin(std::string_view family, std::string_view name, const std::vector<Plugin>& known) {
  return {Location{}, fmt::format("unknown {} '{}'", family, name), known_names(name, names_of(known))};
}

}  // namespace etendue

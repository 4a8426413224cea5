#include "scenefile/dialect.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace etendue {
namespace {

constexpr std::array<std::pair<std::string_view, Dialect>, 3> dialects{
    {{"nori-2012", Dialect::nori_2012}, {"nori-eth", Dialect::nori_eth}, {"nori", Dialect::nori}}};

/// A name that one generation has and the others do not. Empty parts match anything.
struct Mark {
  Dialect dialect;
  std::string_view family, type, property;
};

/// Looked for in this order. Left out are names that several have, such as <emitter>, <medium>, direct_ems,
/// or a camera's apertureRadius.
constexpr std::array marks{
    Mark{Dialect::nori_2012, "luminaire", "", ""},
    Mark{Dialect::nori_2012, "integrator", "mipath", ""},
    Mark{Dialect::nori_eth, "mesh", "sphere", ""},
    Mark{Dialect::nori_eth, "emitter", "distantdisk", ""},
    Mark{Dialect::nori_eth, "emitter", "point", "power"},
    Mark{Dialect::nori_eth, "integrator", "av", ""},
    Mark{Dialect::nori_eth, "integrator", "material", ""},
    Mark{Dialect::nori_eth, "texture", "checkerboard_color", ""},
    Mark{Dialect::nori_eth, "texture", "checkerboard_float", ""},
    Mark{Dialect::nori_eth, "texture", "constant_color", ""},
    Mark{Dialect::nori_eth, "texture", "constant_float", ""},
    Mark{Dialect::nori_eth, "texture", "uvtexture", ""},
    Mark{Dialect::nori_eth, "test", "ttest", "distances"},
};

bool has_property(const Object& object, std::string_view name) {
  return std::any_of(object.properties.begin(), object.properties.end(),
                     [&](const Property& property) { return property.name == name; });
}

/// The first object of the tree that bears the mark.
const Object* find_marked(const Object& object, const Mark& mark) {
  if (object.family == mark.family && (mark.type.empty() || object.type == mark.type) &&
      (mark.property.empty() || has_property(object, mark.property)))
    return &object;
  for (const Object& child : object.children)
    if (const Object* found = find_marked(child, mark)) return found;
  return nullptr;
}

std::string describe(const Mark& mark) {
  std::string text = fmt::format("<{}", mark.family);
  if (!mark.type.empty()) text += fmt::format(" type=\"{}\"", mark.type);
  text += ">";
  if (!mark.property.empty()) text += fmt::format(" with '{}'", mark.property);
  return text;
}

}  // namespace

std::vector<std::string> dialect_names() {
  std::vector<std::string> names;
  for (const auto& [name, dialect] : dialects) names.emplace_back(name);
  return names;
}

std::string_view dialect_name(Dialect dialect) {
  for (const auto& [name, known] : dialects)
    if (known == dialect) return name;
  throw std::logic_error("a dialect without a name");
}

std::optional<Dialect> find_dialect(std::string_view wanted) {
  for (const auto& [name, dialect] : dialects)
    if (name == wanted) return dialect;
  return std::nullopt;
}

Dialect dialect_from_name(std::string_view name) {
  if (const std::optional<Dialect> dialect = find_dialect(name)) return *dialect;
  throw InputError({}, fmt::format("unknown dialect '{}'", name), known_names(name, dialect_names()));
}

DialectGuess recognize_dialect(const Object& root) {
  for (const Mark& mark : marks)
    if (const Object* object = find_marked(root, mark))
      return {
          mark.dialect,
          fmt::format("{} in line {}: only {} that", describe(mark), line_and_column(object->location).line,
                      mark.dialect == Dialect::nori_2012 ? "the first generation has"
                                                         : "the forks of ETH and Tuebingen have")};
  return {Dialect::nori, "nothing in the file tells its generation, so it is read as the current one", false};
}

}  // namespace etendue

#include "scenefile/nori_xml.h"

#include "scenefile/file_format.h"
#include "scenefile/folder_settings.h"
#include "scenefile/foreign_names.h"
#include "scenefile/obj_materials.h"
#include "scenefile/text_file.h"
#include "scenefile/value_text.h"

#include <algorithm>
#include <fmt/format.h>
#include <pugixml.hpp>
#include <unordered_map>
#include <unordered_set>

namespace etendue {
namespace {

constexpr int most_levels = 64;

const std::vector<std::string> object_tags{"scene",   "test",      "integrator", "sampler", "camera",
                                           "rfilter", "mesh",      "shape",      "bsdf",    "brdf",
                                           "emitter", "luminaire", "phase",      "medium",  "texture"};
const std::vector<std::string> property_tags{"boolean", "integer", "float",  "string",
                                             "color",   "point",   "vector", "transform"};
const std::vector<std::string> operation_tags{"translate", "scale", "rotate", "lookat", "lookAt", "matrix"};

/// What may stand in an element, for messages.
std::vector<std::string> tags_inside(std::string_view tag) {
  std::vector<std::string> known = property_tags;
  const auto add = [&](const std::vector<std::string>& tags) {
    known.insert(known.end(), tags.begin(), tags.end());
  };
  if (tag == "scene" || tag == "test")
    add(object_tags);
  else if (tag == "mesh" || tag == "shape")
    add({"bsdf", "brdf", "emitter", "luminaire"});
  else if (tag == "bsdf" || tag == "brdf")
    add({"texture"});
  else if (tag == "camera")
    add({"sampler", "rfilter"});
  else if (tag == "medium")
    add({"phase"});
  return known;
}

/// What forks put into a scene to judge or show its image: nothing of it is in the image.
const std::vector<std::string> bystander_tags{"evaluator", "previewer", "denoiser"};

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_white_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// `name="value"` in a start tag.
struct Attribute {
  std::string name;
  std::string text;  ///< As written where that holds no '&'; otherwise with entities replaced.
  Location name_location, value_location;
};

/// An element whose attributes know their places: pugixml tells only where the tag is, so its start tag is
/// read again.
struct Element {
  pugi::xml_node node;
  std::string tag;
  Location location;
  std::vector<Attribute> attributes;

  const Attribute* find(std::string_view name) const {
    for (const Attribute& attribute : attributes)
      if (attribute.name == name) return &attribute;
    return nullptr;
  }

  const Attribute& get(std::string_view name) const {
    if (const Attribute* attribute = find(name)) return *attribute;
    throw InputError(location, fmt::format("<{}> lacks the attribute '{}'", tag, name),
                     fmt::format("write <{} {}=\"...\">", tag, name));
  }

  void allow_only(std::vector<std::string> names, std::string_view hint = {}) const {
    for (const Attribute& attribute : attributes)
      if (!contains(names, attribute.name))
        throw InputError(attribute.name_location,
                         fmt::format("unknown attribute '{}' of <{}>", attribute.name, tag),
                         hint.empty() ? known_names(attribute.name, std::move(names)) : std::string(hint));
  }
};

class NoriReader {
 public:
  explicit NoriReader(std::shared_ptr<const SourceFile> source) : source_(std::move(source)) {}

  SceneDesc read(std::optional<Dialect> dialect, const std::optional<FolderSettings>& folder);

 private:
  Location at(std::size_t offset, std::size_t length = 1) const { return {source_, offset, length}; }
  Location place_of(const pugi::xml_node& node) const;
  std::optional<Location> innermost_open(std::size_t limit) const;
  pugi::xml_node load_root();
  Element read_element(const pugi::xml_node& node) const;
  std::vector<pugi::xml_node> child_elements(const Element& element) const;
  void refuse_children(const Element& element) const;
  Object read_object(const Element& element, int level);
  Property read_property(const Element& element, std::string_view owner);
  Property::Value read_value(const Element& element, const Attribute& value) const;
  Transform read_operations(const Element& element, std::string_view owner);
  Transform read_operation(const Element& element, std::string_view owner);
  Transform read_lookat(const Element& element, std::string_view owner);
  Vec3<double> read_vector(const Attribute& attribute) const;

  std::shared_ptr<const SourceFile> source_;
  pugi::xml_document document_;
  std::vector<std::string> warnings_;
};

Location NoriReader::place_of(const pugi::xml_node& node) const {
  std::size_t offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
  if (node.type() == pugi::node_element) return at(offset, std::string_view(node.name()).size());
  const std::string_view text = source_->text;
  while (offset < text.size() && is_white_space(text[offset])) ++offset;
  const std::size_t end = text.find_first_of("\r\n<", offset);
  return at(offset, std::max<std::size_t>(std::min(end, text.size()) - offset, 1));
}

/// The tag of the element that is open at the offset `limit`, up to which the text is well-formed.
std::optional<Location> NoriReader::innermost_open(std::size_t limit) const {
  const std::string_view text = source_->text;
  std::vector<Location> open;
  const auto behind = [&](std::string_view end, std::size_t from) {
    const std::size_t found = text.find(end, from);
    return found == std::string_view::npos ? limit : found + end.size();
  };
  for (std::size_t offset = text.find('<'); offset < limit; offset = text.find('<', offset)) {
    const std::string_view rest = text.substr(offset);
    if (rest.starts_with("<!--")) {
      offset = behind("-->", offset);
    } else if (rest.starts_with("<![CDATA[")) {
      offset = behind("]]>", offset);
    } else if (rest.starts_with("<?")) {
      offset = behind("?>", offset);
    } else if (rest.starts_with("</")) {
      offset = behind(">", offset);
      if (offset <= limit && !open.empty()) open.pop_back();
    } else {
      const std::size_t name = offset + 1;
      open.push_back(at(name, std::min(text.find_first_of(" \t\r\n/>", name), text.size()) - name));
      for (offset = name; offset < limit && text[offset] != '>'; ++offset)
        if (text[offset] == '"' || text[offset] == '\'')
          offset = behind(text.substr(offset, 1), offset + 1) - 1;
      if (offset < limit && text[offset - 1] == '/') open.pop_back();
    }
  }
  return open.empty() ? std::nullopt : std::optional(open.back());
}

pugi::xml_node NoriReader::load_root() {
  // parse_fragment keeps text and elements beside the root, which would otherwise vanish without a word.
  constexpr unsigned int options = pugi::parse_cdata | pugi::parse_escapes | pugi::parse_wconv_attribute |
                                   pugi::parse_eol | pugi::parse_doctype | pugi::parse_fragment;
  const pugi::xml_parse_result result =
      document_.load_buffer(source_->text.data(), source_->text.size(), options, pugi::encoding_utf8);
  constexpr std::string_view doctype_problem =
      "document type and entity definitions (DOCTYPE) are not accepted";
  for (const pugi::xml_node& node : document_.children())
    if (node.type() == pugi::node_doctype)
      throw InputError(place_of(node), doctype_problem, "remove them and write the values out");
  if (!result) {
    const Location where = at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)));
    if (result.status == pugi::status_bad_doctype) throw InputError(where, doctype_problem);
    if (result.status == pugi::status_end_element_mismatch)
      if (const std::optional<Location> open = innermost_open(where.offset))
        throw InputError(where, fmt::format("expected </{}>, the end of the element of line {}",
                                            source_->text.substr(open->offset, open->length),
                                            line_and_column(*open).line));
    throw InputError(where, fmt::format("not well-formed XML: {}", result.description()),
                     result.status == pugi::status_bad_attribute
                         ? "is a quote missing, here or in the line before? write name=\"value\""
                         : "");
  }
  pugi::xml_node root;
  for (const pugi::xml_node& node : document_.children()) {
    if (node.type() != pugi::node_element)
      throw InputError(place_of(node), "text outside of the root element",
                       "expected XML with all in one <scene> or <test>");
    if (root)
      throw InputError(place_of(node), "a second root element", "a file holds one <scene> or one <test>");
    root = node;
  }
  if (!root) throw InputError(at(0), "the file has no element", "expected <scene> or <test>");
  return root;
}

Element NoriReader::read_element(const pugi::xml_node& node) const {
  Element element{node, node.name(), place_of(node), {}};
  const std::string_view text = source_->text;
  std::size_t offset = element.location.offset + element.tag.size();
  const auto skip_white_space = [&] {
    while (offset < text.size() && is_white_space(text[offset])) ++offset;
  };
  const auto check = [&](bool is_as_parsed) {
    if (!is_as_parsed)
      throw InputError(element.location, fmt::format("malformed start tag <{}>", element.tag));
  };
  std::unordered_set<std::string_view> seen;
  for (const pugi::xml_attribute& parsed : node.attributes()) {
    const std::string_view name = parsed.name();
    skip_white_space();
    check(text.substr(offset, name.size()) == name);
    const Location name_location = at(offset, name.size());
    offset += name.size();
    skip_white_space();
    check(offset < text.size() && text[offset] == '=');
    ++offset;
    skip_white_space();
    check(offset < text.size() && (text[offset] == '"' || text[offset] == '\''));
    const std::size_t begin = offset + 1;
    const std::size_t end = text.find(text[offset], begin);
    check(end != std::string_view::npos);
    offset = end + 1;
    if (element.find(name))
      throw InputError(name_location, fmt::format("the attribute '{}' is given twice", name));
    const std::string_view written = text.substr(begin, end - begin);
    const bool has_entity = written.find('&') != std::string_view::npos;
    element.attributes.push_back({std::string(name), has_entity ? parsed.value() : std::string(written),
                                  name_location, at(begin, std::max<std::size_t>(end - begin, 1))});
  }
  return element;
}

std::vector<pugi::xml_node> NoriReader::child_elements(const Element& element) const {
  std::vector<pugi::xml_node> elements;
  for (const pugi::xml_node& child : element.node.children()) {
    if (child.type() != pugi::node_element)
      throw InputError(place_of(child),
                       fmt::format("text inside <{}>, where only elements may stand", element.tag));
    elements.push_back(child);
  }
  return elements;
}

void NoriReader::refuse_children(const Element& element) const {
  for (const pugi::xml_node& child : child_elements(element))
    throw InputError(place_of(child),
                     fmt::format("<{}> inside <{}>, where nothing may stand", child.name(), element.tag));
}

Vec3<double> NoriReader::read_vector(const Attribute& attribute) const {
  const std::vector<double> numbers = parse_reals(attribute.text, attribute.value_location, {3});
  return {numbers[0], numbers[1], numbers[2]};
}

Transform NoriReader::read_lookat(const Element& element, std::string_view owner) {
  element.allow_only({"origin", "target", "up"});
  const Vec3<double> origin = read_vector(element.get("origin")), target = read_vector(element.get("target"));
  const Vec3<double> up = read_vector(element.get("up"));
  if (origin == target)
    throw InputError(element.get("target").value_location,
                     "target and origin are the same point: no direction");
  const Transform frame = look_at(origin, target, up);
  if (is_invertible(frame)) return frame;
  const Location& where = element.get("up").value_location;
  if (owner != "camera" || !is_projection_to_z(frame) || up == Vec3<double>{0, 0, 0})
    throw InputError(where, "up is 0 or parallel to the direction from origin to target");
  // Nori's own columns, of which a course's test has its reference.
  warnings_.push_back(format_message(
      where, "up is parallel to the direction from origin to target",
      "as in Nori, every ray of this camera runs along its axis, and the whole image shows one point; for a "
      "picture choose another up"));
  return frame;
}

Transform NoriReader::read_operation(const Element& element, std::string_view owner) {
  if (!contains(operation_tags, element.tag))
    throw InputError(element.location, fmt::format("<{}> is not a part of a transform", element.tag),
                     known_names(element.tag, operation_tags));
  refuse_children(element);
  if (element.tag == "translate") {
    element.allow_only({"value"});
    return translation(read_vector(element.get("value")));
  }
  if (element.tag == "scale") {
    element.allow_only({"value"});
    const Attribute& value = element.get("value");
    const std::vector<double> factors = parse_reals(value.text, value.value_location, {1, 3});
    if (std::find(factors.begin(), factors.end(), 0.0) != factors.end())
      throw InputError(value.value_location, "a scale factor is 0: the transform cannot be inverted");
    return scaling({factors.front(), factors[factors.size() / 2], factors.back()});
  }
  if (element.tag == "rotate") {
    element.allow_only({"axis", "angle"});
    const Attribute& angle = element.get("angle");
    const Vec3<double> axis = read_vector(element.get("axis"));
    if (axis == Vec3<double>{0, 0, 0})
      throw InputError(element.get("axis").value_location, "the axis of a rotation has length 0");
    return rotation(axis, parse_real(angle.text, angle.value_location));
  }
  if (element.tag == "matrix") {
    element.allow_only({"value"});
    return parse_matrix(element.get("value").text, element.get("value").value_location);
  }
  return read_lookat(element, owner);
}

Transform NoriReader::read_operations(const Element& element, std::string_view owner) {
  Transform transform;
  // Nori: what is written later acts later, so it stands on the left.
  for (const pugi::xml_node& child : child_elements(element))
    transform = read_operation(read_element(child), owner) * transform;
  return transform;
}

Property::Value NoriReader::read_value(const Element& element, const Attribute& value) const {
  const std::string& text = value.text;
  const Location& where = value.value_location;
  if (element.tag == "boolean") return parse_boolean(text, where);
  if (element.tag == "integer") return parse_integer(text, where);
  if (element.tag == "float") return parse_real(text, where);
  if (element.tag == "string") return std::string(element.node.attribute("value").value());
  if (element.tag == "color") return parse_color(text, where);
  if (element.tag == "transform") return parse_matrix(text, where);
  const std::vector<double> numbers = parse_reals(text, where, {2, 3});
  if (numbers.size() == 2) return Vec2<double>{numbers[0], numbers[1]};
  return Vec3<double>{numbers[0], numbers[1], numbers[2]};
}

Property NoriReader::read_property(const Element& element, std::string_view owner) {
  element.allow_only({"name", "value"});
  const Attribute& name = element.get("name");
  if (name.text.empty())
    throw InputError(name.value_location, fmt::format("the name of <{}> is empty", element.tag));
  const Attribute* value = element.find("value");
  Property property{name.text, element.tag, {}, name.value_location, element.location};
  if (element.tag == "transform" && !value) {
    property.value = read_operations(element, owner);
  } else {
    if (element.tag == "transform" && !child_elements(element).empty())
      throw InputError(place_of(child_elements(element).front()),
                       "a transform has either a matrix as its value or operations inside, not both");
    refuse_children(element);
    property.value_location = element.get("value").value_location;
    property.value = read_value(element, element.get("value"));
  }
  if (const auto* transform = std::get_if<Transform>(&property.value);
      transform && !is_invertible(*transform) && !(owner == "camera" && is_projection_to_z(*transform)))
    throw InputError(
        property.value_location, fmt::format("the transform '{}' cannot be inverted", property.name),
        "check it for a scale of 0, for equal rows or columns, and for numbers too large or too small");
  return property;
}

Object NoriReader::read_object(const Element& element, int level) {
  if (level > most_levels)
    throw InputError(element.location, fmt::format("elements are nested more than {} deep", most_levels));
  std::vector<std::string> attributes{"type", "name"};
  if (level == 1) attributes.emplace_back("dialect");
  std::string_view hint;
  if (level == 1 && element.find("version"))
    hint = "this seems to be a Mitsuba scene; read here are the formats of the Nori family";
  if (level > 1 && element.find("dialect"))
    hint = "the dialect is stated once, on the root element of the file";
  element.allow_only(attributes, hint);
  Object object{element.tag, {}, {}, element.location, element.location, {}, {}};
  if (const Attribute* name = element.find("name")) object.name = name->text;
  if (element.tag != "scene" || element.find("type")) {
    object.type = element.get("type").text;
    object.type_location = element.get("type").value_location;
    if (object.type.empty())
      throw InputError(object.type_location, fmt::format("the type of <{}> is empty", element.tag));
  }

  std::unordered_map<std::string, Location> stated;
  const std::vector<pugi::xml_node> nodes = child_elements(element);
  object.children.reserve(std::size_t(std::count_if(
      nodes.begin(), nodes.end(), [](const auto& node) { return contains(object_tags, node.name()); })));
  pugi::xml_node parent = element.node;
  for (const pugi::xml_node& node : nodes) {
    const Element child = read_element(node);
    if (contains(property_tags, child.tag)) {
      Property property = read_property(child, element.tag);
      const auto [first, is_new] = stated.emplace(property.name, property.name_location);
      if (!is_new)
        throw InputError(property.name_location,
                         fmt::format("'{}' is stated twice in this <{}>, first in line {}", property.name,
                                     element.tag, line_and_column(first->second).line));
      object.properties.push_back(std::move(property));
    } else if (element.tag == "scene" && contains(bystander_tags, child.tag)) {
      warnings_.push_back(format_message(
          child.location, fmt::format("<{}> is ignored: it has no part in the image", child.tag)));
    } else if (child.find("type") || contains(object_tags, child.tag)) {
      object.children.push_back(read_object(child, level + 1));
    } else if (contains(operation_tags, child.tag)) {
      throw InputError(child.location, fmt::format("<{}> may stand only inside <transform>", child.tag));
    } else {
      const std::string hint = foreign_tag_hint(child.tag);
      throw InputError(child.location, fmt::format("unknown tag <{}>", child.tag),
                       hint.empty() ? known_names(child.tag, tags_inside(element.tag)) : hint);
    }
    // What is read goes at once: for small shapes the nodes are larger than the objects made of them.
    parent.remove_child(node);
  }
  return object;
}

SceneDesc NoriReader::read(std::optional<Dialect> dialect, const std::optional<FolderSettings>& folder) {
  const Element root = read_element(load_root());
  if (root.tag != "scene" && root.tag != "test")
    throw InputError(root.location, fmt::format("the root element is <{}>", root.tag),
                     "expected <scene> or <test>");
  SceneDesc scene;
  scene.root = read_object(root, 1);

  const Attribute* stated = root.find("dialect");
  if (stated && !find_dialect(stated->text))
    throw InputError(stated->value_location, fmt::format("unknown dialect '{}'", stated->text),
                     known_names(stated->text, dialect_names()));
  if (dialect) {
    scene.dialect = *dialect;
    scene.dialect_reason = "asked for by --dialect";
  } else if (stated) {
    scene.dialect = *find_dialect(stated->text);
    scene.dialect_reason =
        fmt::format("stated by the root element, line {}", line_and_column(stated->value_location).line);
  } else if (folder && folder->dialect) {
    scene.dialect = *folder->dialect;
    scene.dialect_reason = fmt::format("stated by {}", folder->file.string());
  } else {
    const DialectGuess guess = recognize_dialect(scene.root);
    scene.dialect = guess.dialect;
    scene.dialect_reason = guess.reason;
    scene.is_dialect_told = guess.is_told;
  }
  scene.warnings = std::move(warnings_);
  return scene;
}

}  // namespace

SceneDesc read_nori_xml(const std::filesystem::path& file, std::optional<Dialect> dialect) {
  const std::optional<FolderSettings> folder = folder_settings_of(file);
  SceneDesc scene = NoriReader(read_text_file(file)).read(dialect, folder);
  if (folder) scene.settings_file = folder->file;
  scene.directory = file.parent_path();
  split_by_materials(scene);
  return scene;
}

}  // namespace etendue

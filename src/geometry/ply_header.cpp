#include "geometry/ply_header.h"

#include "geometry/mesh_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <string_view>
#include <unordered_set>
#include <utility>

namespace etendue {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> type_names{{{"char", PlyType::int8},
                                                                           {"int8", PlyType::int8},
                                                                           {"uchar", PlyType::uint8},
                                                                           {"uint8", PlyType::uint8},
                                                                           {"short", PlyType::int16},
                                                                           {"int16", PlyType::int16},
                                                                           {"ushort", PlyType::uint16},
                                                                           {"uint16", PlyType::uint16},
                                                                           {"int", PlyType::int32},
                                                                           {"int32", PlyType::int32},
                                                                           {"uint", PlyType::uint32},
                                                                           {"uint32", PlyType::uint32},
                                                                           {"float", PlyType::float32},
                                                                           {"float32", PlyType::float32},
                                                                           {"double", PlyType::float64},
                                                                           {"float64", PlyType::float64}}};

constexpr std::array<std::pair<std::string_view, PlyFormat>, 3> format_names{
    {{"ascii", PlyFormat::ascii},
     {"binary_little_endian", PlyFormat::little_endian},
     {"binary_big_endian", PlyFormat::big_endian}}};

template <class Names>
auto find_name(const Names& names, std::string_view wanted) {
  return std::find_if(names.begin(), names.end(), [&](const auto& known) { return known.first == wanted; });
}

template <class Names>
std::vector<std::string> list_of(const Names& names) {
  std::vector<std::string> list;
  for (const auto& [name, value] : names) list.emplace_back(name);
  return list;
}

class HeaderParser {
 public:
  explicit HeaderParser(const std::shared_ptr<const SourceFile>& source)
      : source_(source), text_(source->text) {}

  PlyHeader parse() {
    if (!text_.starts_with("ply") || text_.size() < 4 || std::string_view("\r\n \t").find(text_[3]) > 3)
      throw InputError(Location{source_}, "not a PLY file", "expected 'ply' in the first line");
    // Binary data may begin with any byte, so the end of the header is the end of line that the file uses.
    const std::size_t first_end = text_.find_first_of("\r\n");
    line_end_ = first_end == std::string_view::npos    ? "\n"
                : text_[first_end] == '\n'             ? "\n"
                : text_.substr(first_end, 2) == "\r\n" ? "\r\n"
                                                       : "\r";
    next_line();
    while (next_line()) {
      const std::string_view word = take_word();
      if (word == "end_header") return finish();
      if (word == "format")
        read_format();
      else if (word == "element")
        read_element();
      else if (word == "property")
        read_property();
      else if (word != "comment" && word != "obj_info" && !word.empty())
        throw InputError(
            at(word), fmt::format("{} is not a statement of a PLY header", quoted(word)),
            known_names(word, {"format", "comment", "obj_info", "element", "property", "end_header"}));
    }
    throw InputError(at(text_.substr(text_.size())), "the file ends within its header",
                     "expected a line 'end_header'");
  }

 private:
  Location at(std::string_view part) const {
    return {source_, static_cast<std::size_t>(part.data() - text_.data()),
            std::max<std::size_t>(part.size(), 1)};
  }

  bool next_line() {
    if (next_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find(line_end_, next_), text_.size());
    line_ = text_.substr(next_, end - next_);
    rest_ = line_;
    next_ = end + line_end_.size();
    return true;
  }

  /// Empty at the end of the line.
  std::string_view take_word() {
    constexpr std::string_view blank = " \t\r";
    rest_.remove_prefix(std::min(rest_.find_first_not_of(blank), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(blank));
    rest_.remove_prefix(word.size());
    return word;
  }

  void expect_line_end(std::string_view hint) {
    const std::string_view word = take_word();
    if (!word.empty()) throw InputError(at(word), fmt::format("{} is too much", quoted(word)), hint);
  }

  void read_format() {
    constexpr std::string_view hint =
        "expected 'format ascii 1.0', or binary_little_endian or binary_big_endian";
    if (has_format_) throw InputError(at(line_), "a second format");
    const std::string_view name = take_word(), version = take_word();
    const auto known = find_name(format_names, name);
    if (known == format_names.end())
      throw InputError(at(name), fmt::format("{} is not a format of PLY", quoted(name)),
                       known_names(name, list_of(format_names)));
    if (version != "1.0")
      throw InputError(at(version), fmt::format("PLY version {} is not known", quoted(version)), hint);
    expect_line_end(hint);
    header_.format = known->second;
    has_format_ = true;
  }

  void read_element() {
    constexpr std::string_view hint = "expected something like 'element vertex 8'";
    const std::string_view name = take_word(), number = take_word();
    std::uint64_t count = 0;
    const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), count);
    if (name.empty() || error != std::errc() || stop != number.data() + number.size())
      throw InputError(at(number), fmt::format("{} is not a number of elements", quoted(number)), hint);
    expect_line_end(hint);
    if (!element_names_.emplace(name).second)
      throw InputError(at(name), fmt::format("a second element {}", quoted(name)));
    property_names_.clear();
    header_.elements.push_back({std::string(name), count, {}, at(line_)});
  }

  PlyType read_type() {
    const std::string_view name = take_word();
    const auto known = find_name(type_names, name);
    if (known == type_names.end())
      throw InputError(at(name), fmt::format("{} is not a type of PLY", quoted(name)),
                       known_names(name, list_of(type_names)));
    return known->second;
  }

  void read_property() {
    constexpr std::string_view hint =
        "expected something like 'property float x' or 'property list uchar int vertex_indices'";
    if (header_.elements.empty()) throw InputError(at(line_), "a property before the first element");
    PlyProperty property{{}, PlyType::float32, {}, at(line_)};
    const std::string_view before = rest_;
    if (take_word() == "list") {
      const std::string_view count = rest_;
      property.count_type = read_type();
      if (*property.count_type == PlyType::float32 || *property.count_type == PlyType::float64)
        throw InputError(at(count), "the length of a list must be a whole number", hint);
    } else {
      rest_ = before;
    }
    property.type = read_type();
    const std::string_view name = take_word();
    if (name.empty()) throw InputError(at(line_), "a property without a name", hint);
    expect_line_end(hint);
    if (!property_names_.emplace(name).second)
      throw InputError(at(name), fmt::format("a second property {}", quoted(name)));
    property.name = name;
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyHeader finish() {
    expect_line_end("nothing follows 'end_header' in its line");
    if (!has_format_)
      throw InputError(at(line_), "the header states no format", "expected a line like 'format ascii 1.0'");
    header_.end = at(line_);
    header_.body_offset = std::min(next_, text_.size());
    return std::move(header_);
  }

  std::shared_ptr<const SourceFile> source_;
  std::string_view text_, line_end_ = "\n", line_, rest_;
  std::size_t next_ = 0;
  PlyHeader header_{};
  bool has_format_ = false;
  std::unordered_set<std::string_view> element_names_, property_names_;
};

}  // namespace

std::size_t ply_type_bytes(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 0;
}

const PlyProperty* PlyElement::find(std::string_view property) const {
  for (const PlyProperty& p : properties)
    if (p.name == property) return &p;
  return nullptr;
}

std::size_t PlyElement::least_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& p : properties) bytes += ply_type_bytes(p.count_type.value_or(p.type));
  return bytes;
}

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& p) { return p.count_type.has_value(); });
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  for (const PlyElement& e : elements)
    if (e.name == element) return &e;
  return nullptr;
}

PlyHeader read_ply_header(const std::shared_ptr<const SourceFile>& source) {
  return HeaderParser(source).parse();
}

}  // namespace etendue

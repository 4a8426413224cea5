#include "geometry/ply_reader.h"

#include "geometry/mesh_builder.h"
#include "geometry/mesh_text.h"
#include "geometry/ply_header.h"
#include "scenefile/file_format.h"
#include "scenefile/whole_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <string_view>
#include <utility>

namespace etendue {
namespace {

/// What a row of the vertex element gives, and where it stands in the row's numbers.
enum Slot : std::size_t { x, y, z, nx, ny, nz, u, v, slot_count };

/// Which property of the vertex element fills which slot; those of no slot are skipped.
struct VertexLayout {
  std::vector<std::size_t> slot_of_property;
  bool has_normals = false, has_uvs = false;
};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

/// Rows of an ASCII body: a line each, blank lines apart.
class TextRows {
 public:
  TextRows(std::shared_ptr<const SourceFile> source, std::size_t offset)
      : source_(std::move(source)),
        at_(source_->text.data() + offset),
        end_(source_->text.data() + source_->text.size()) {}

  std::size_t offset() const { return static_cast<std::size_t>(at_ - source_->text.data()); }

  /// A row is two bytes a property at least, a digit and what ends it.
  std::size_t most_rows(const PlyElement& element) const {
    return static_cast<std::size_t>(end_ - at_) / std::max<std::size_t>(2 * element.properties.size(), 2) + 1;
  }

  void begin_row(const PlyElement& element, std::uint64_t row) {
    element_ = &element;
    row_ = row;
    while (at_ != end_ && (is_blank(*at_) || is_line_end(*at_))) ++at_;
    if (at_ == end_)
      throw InputError(
          Location{source_, source_->text.size()},
          fmt::format("the file ends after {} of {} rows of element '{}'", row, element.count, element.name),
          "it is cut short, or its header is wrong");
  }

  double scalar(PlyType) {
    const std::string_view token = take_token();
    if (const auto number = finite_number(token)) return *number;
    const auto [problem, hint] = number_problem(token);
    throw error_at(token, problem, hint);
  }
  void skip_scalar(PlyType) { take_token(); }

  std::uint64_t list_length(const PlyProperty&) {
    const std::string_view token = take_token();
    const auto number = finite_number(token);
    if (!number || !(*number >= 0 && *number < 0x1p32) || *number != std::floor(*number))
      throw error_at(token, fmt::format("{} is not the length of a list", quoted(token)),
                     "expected a whole number that is not negative");
    return static_cast<std::uint64_t>(*number);
  }
  void skip_list(const PlyProperty&, std::uint64_t length) {
    for (std::uint64_t i = 0; i < length; ++i) take_token();
  }

  void end_row() {
    skip_blanks();
    if (at_ != end_ && !is_line_end(*at_)) {
      const std::string_view token = take_token();
      throw error_at(token, fmt::format("{} is a value too many for this line", quoted(token)),
                     "the header says which values a line has; is it that of another file?");
    }
  }

  void skip_rows(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (std::uint64_t row = 0; row < element.count; ++row) {
      begin_row(element, row);
      while (at_ != end_ && !is_line_end(*at_)) ++at_;
    }
  }

  void expect_end() {
    while (at_ != end_ && (is_blank(*at_) || is_line_end(*at_))) ++at_;
    if (at_ == end_) return;
    const std::string_view token = take_token();
    throw InputError(
        Location{source_, static_cast<std::size_t>(token.data() - source_->text.data()), token.size()},
        "the file goes on after all rows that its header counts",
        "correct the numbers of elements in the header");
  }

 private:
  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }

  std::string_view take_token() {
    skip_blanks();
    const char* first = at_;
    while (at_ != end_ && !is_blank(*at_) && !is_line_end(*at_)) ++at_;
    if (at_ == first)
      throw error_at({first, 0}, "this line has too few values",
                     "the header says which values a line has; is it that of another file?");
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  InputError error_at(std::string_view token, std::string_view problem, std::string_view hint) const {
    return InputError(Location{source_, static_cast<std::size_t>(token.data() - source_->text.data()),
                               std::max<std::size_t>(token.size(), 1)},
                      fmt::format("{} {}: {}", element_->name, row_, problem), hint);
  }

  std::shared_ptr<const SourceFile> source_;
  const char *at_, *end_;
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

/// Rows of a binary body.
template <std::endian order>
class BinaryRows {
 public:
  BinaryRows(std::shared_ptr<const SourceFile> source, std::size_t offset)
      : source_(std::move(source)),
        at_(source_->text.data() + offset),
        end_(source_->text.data() + source_->text.size()) {}

  std::size_t offset() const { return static_cast<std::size_t>(at_ - source_->text.data()); }

  std::size_t most_rows(const PlyElement& element) const { return left() / element.least_bytes(); }

  void begin_row(const PlyElement& element, std::uint64_t row) {
    element_ = &element;
    row_ = row;
  }

  double scalar(PlyType type) {
    require(ply_type_bytes(type));
    const double value = load(type);
    if (!std::isfinite(value))
      throw error(fmt::format("{} is not a finite number", value),
                  "the program that wrote this file made an error; export the mesh anew");
    return value;
  }
  void skip_scalar(PlyType type) {
    require(ply_type_bytes(type));
    at_ += ply_type_bytes(type);
  }

  std::uint64_t list_length(const PlyProperty& property) {
    require(ply_type_bytes(*property.count_type));
    const double length = load(*property.count_type);
    if (length < 0)
      throw error(fmt::format("a list of {} entries", length), "the file is damaged, or its header is wrong");
    const auto entries = static_cast<std::uint64_t>(length);
    require(entries * ply_type_bytes(property.type));
    return entries;
  }
  void skip_list(const PlyProperty& property, std::uint64_t length) {
    at_ += length * ply_type_bytes(property.type);
  }

  void end_row() {}

  void skip_rows(const PlyElement& element) {
    if (!element.has_lists()) {
      const std::size_t bytes = element.least_bytes();
      begin_row(element, 0);
      if (bytes > 0 && element.count > left() / bytes) {
        row_ = left() / bytes;
        require(std::numeric_limits<std::size_t>::max());
      }
      at_ += element.count * bytes;
      return;
    }
    for (std::uint64_t row = 0; row < element.count; ++row) {
      begin_row(element, row);
      for (const PlyProperty& property : element.properties)
        if (property.count_type)
          skip_list(property, list_length(property));
        else
          skip_scalar(property.type);
    }
  }

  void expect_end() {
    // Some programs end a binary file with a line end, too.
    while (at_ != end_ && (is_blank(*at_) || is_line_end(*at_))) ++at_;
    if (at_ != end_)
      throw InputError(whole_file(*source_),
                       fmt::format("{} bytes are left after all that the header counts", left()),
                       "correct the numbers of elements or the types in the header");
  }

 private:
  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }

  InputError error(std::string_view problem, std::string_view hint) const {
    return InputError(whole_file(*source_), fmt::format("{} {}: {}", element_->name, row_, problem), hint);
  }

  void require(std::size_t bytes) const {
    if (bytes > left())
      throw InputError(whole_file(*source_),
                       fmt::format("the file ends after {} of {} rows of element '{}'", row_, element_->count,
                                   element_->name),
                       "it is cut short, or its header is wrong");
  }

  template <class T>
  double load_as() {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at_, sizeof(T));
    at_ += sizeof(T);
    if constexpr (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return static_cast<double>(std::bit_cast<T>(bytes));
  }

  double load(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return load_as<std::int8_t>();
      case PlyType::uint8:
        return load_as<std::uint8_t>();
      case PlyType::int16:
        return load_as<std::int16_t>();
      case PlyType::uint16:
        return load_as<std::uint16_t>();
      case PlyType::int32:
        return load_as<std::int32_t>();
      case PlyType::uint32:
        return load_as<std::uint32_t>();
      case PlyType::float32:
        return load_as<float>();
      case PlyType::float64:
        return load_as<double>();
    }
    return 0;
  }

  std::shared_ptr<const SourceFile> source_;
  const char *at_, *end_;
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

VertexLayout layout_of(const PlyElement& vertex) {
  VertexLayout layout{std::vector<std::size_t>(vertex.properties.size(), slot_count)};
  const auto place = [&](std::string_view name, Slot slot) {
    const PlyProperty* property = vertex.find(name);
    if (!property) return false;
    if (property->count_type)
      throw InputError(property->location, fmt::format("'{}' of a vertex is a list", name),
                       "expected one number");
    layout.slot_of_property[static_cast<std::size_t>(property - vertex.properties.data())] = slot;
    return true;
  };
  for (const auto& [name, slot] : {std::pair{"x", x}, {"y", y}, {"z", z}})
    if (!place(name, slot))
      throw InputError(vertex.location, fmt::format("the vertices have no {}", name),
                       fmt::format("expected a line like 'property float {}'", name));
  const bool has_nx = place("nx", nx), has_ny = place("ny", ny), has_nz = place("nz", nz);
  if (has_nx != has_ny || has_ny != has_nz)
    throw InputError(vertex.location, "the vertices have only part of a normal", "expected nx, ny and nz");
  layout.has_normals = has_nx;
  for (const auto& [first, second] : {std::pair{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}})
    if (!layout.has_uvs && vertex.find(first) && vertex.find(second))
      layout.has_uvs = place(first, u) && place(second, v);
  return layout;
}

/// The property of a face that lists its vertices.
std::size_t index_list_of(const PlyElement& face) {
  for (const char* name : {"vertex_indices", "vertex_index"})
    if (const PlyProperty* property = face.find(name)) {
      if (!property->count_type)
        throw InputError(property->location, fmt::format("'{}' of a face is not a list", name),
                         fmt::format("expected a line like 'property list uchar int {}'", name));
      return static_cast<std::size_t>(property - face.properties.data());
    }
  throw InputError(face.location, "the faces do not list their vertices",
                   "expected a line like 'property list uchar int vertex_indices'");
}

class PlyReader {
 public:
  explicit PlyReader(std::shared_ptr<const SourceFile> source)
      : source_(std::move(source)),
        header_(read_ply_header(source_)),
        vertex_(header_.find("vertex")),
        face_(header_.find("face")) {
    for (const PlyElement& element : header_.elements)
      if (element.name == "tristrips" && element.count > 0)
        throw InputError(element.location, "triangle strips cannot be read",
                         "export the mesh with faces, each a list of vertices");
    if (!vertex_)
      throw InputError(header_.end, "no element 'vertex'", "expected a line like 'element vertex 8'");
    if (!face_ || face_->count == 0)
      throw InputError(face_ ? face_->location : header_.end, "no face",
                       "expected an element 'face'; points alone cannot be rendered");
    layout_ = layout_of(*vertex_);
    index_list_ = index_list_of(*face_);
    if (vertex_->count >= Corner::none)
      throw InputError(vertex_->location, "more than 4294967294 vertices", "split the mesh");
  }

  void read() {
    switch (header_.format) {
      case PlyFormat::ascii:
        return read_body<TextRows>();
      case PlyFormat::little_endian:
        return read_body<BinaryRows<std::endian::little>>();
      case PlyFormat::big_endian:
        return read_body<BinaryRows<std::endian::big>>();
    }
  }

  Mesh build(const Transform& world_from_object) const {
    const auto at_face = [this](std::size_t face, std::string_view problem, std::string_view hint) {
      return error(*face_, faces_offset_, face, problem, hint);
    };
    const auto at_normal = [this](std::size_t normal, std::string_view problem, std::string_view hint) {
      return error(*vertex_, vertices_offset_, normal, fmt::format("its normal {}", problem), hint);
    };
    const auto at_position = [this](std::size_t row, std::string_view problem, std::string_view hint) {
      return error(*vertex_, vertices_offset_, row, problem, hint);
    };
    MeshBuilder builder(source_->path, parts_, world_from_object, layout_.has_uvs, layout_.has_normals,
                        {at_face, at_position, at_normal});
    builder.reserve_triangles(corners_.size() - 2 * face_sizes_.size());
    std::vector<Corner> face;
    std::size_t first = 0;
    for (std::size_t f = 0; f < face_sizes_.size(); ++f) {
      face.clear();
      for (std::size_t k = 0; k < face_sizes_[f]; ++k) {
        const std::uint32_t vertex = corners_[first + k];
        face.push_back(
            {vertex, layout_.has_uvs ? vertex : Corner::none, layout_.has_normals ? vertex : Corner::none});
      }
      builder.add_face(f, face);
      first += face_sizes_[f];
    }
    return std::move(builder).finish();
  }

 private:
  template <class Rows>
  void read_body() {
    Rows rows(source_, header_.body_offset);
    for (const PlyElement& element : header_.elements) {
      if (&element == vertex_) {
        vertices_offset_ = rows.offset();
        read_vertices(rows);
      } else if (&element == face_) {
        faces_offset_ = rows.offset();
        read_faces(rows);
      } else {
        rows.skip_rows(element);
      }
    }
    rows.expect_end();
  }

  template <class Rows>
  void read_vertices(Rows& rows) {
    const auto expected =
        static_cast<std::size_t>(std::min<std::uint64_t>(vertex_->count, rows.most_rows(*vertex_)));
    parts_.positions.reserve(expected);
    if (layout_.has_normals) parts_.normals.reserve(expected);
    if (layout_.has_uvs) parts_.uvs.reserve(expected);
    for (std::uint64_t row = 0; row < vertex_->count; ++row) {
      std::array<double, slot_count> value{};
      rows.begin_row(*vertex_, row);
      for (std::size_t i = 0; i < vertex_->properties.size(); ++i) {
        const PlyProperty& property = vertex_->properties[i];
        if (const std::size_t slot = layout_.slot_of_property[i]; slot != slot_count)
          value[slot] = rows.scalar(property.type);
        else if (property.count_type)
          rows.skip_list(property, rows.list_length(property));
        else
          rows.skip_scalar(property.type);
      }
      rows.end_row();
      parts_.positions.push_back({value[x], value[y], value[z]});
      if (layout_.has_normals) parts_.normals.push_back({value[nx], value[ny], value[nz]});
      if (layout_.has_uvs) parts_.uvs.push_back({narrow(value[u], row), narrow(value[v], row)});
    }
  }

  float narrow(double value, std::uint64_t row) const {
    const auto narrowed = static_cast<float>(value);
    if (!std::isfinite(narrowed))
      throw error(*vertex_, vertices_offset_, row, fmt::format("{:g} does not fit a float", value),
                  "expected coordinates, in world space, below 3e38");
    return narrowed;
  }

  template <class Rows>
  void read_faces(Rows& rows) {
    const auto expected =
        static_cast<std::size_t>(std::min<std::uint64_t>(face_->count, rows.most_rows(*face_)));
    face_sizes_.reserve(expected);
    corners_.reserve(3 * expected);
    for (std::uint64_t row = 0; row < face_->count; ++row) {
      rows.begin_row(*face_, row);
      for (std::size_t i = 0; i < face_->properties.size(); ++i) {
        const PlyProperty& property = face_->properties[i];
        if (!property.count_type) {
          rows.skip_scalar(property.type);
          continue;
        }
        const std::uint64_t length = rows.list_length(property);
        if (i == index_list_)
          read_corners(rows, property, row, length);
        else
          rows.skip_list(property, length);
      }
      rows.end_row();
    }
    if (corners_.size() - 2 * face_sizes_.size() >= Corner::none / 3)
      throw InputError(face_->location, "more than 1431655764 triangles", "split the mesh");
  }

  template <class Rows>
  void read_corners(Rows& rows, const PlyProperty& property, std::uint64_t row, std::uint64_t length) {
    if (length < 3)
      throw error(*face_, faces_offset_, row,
                  fmt::format("a face of {} {}", length, length == 1 ? "vertex" : "vertices"),
                  "expected three or more");
    for (std::uint64_t k = 0; k < length; ++k) {
      const double index = rows.scalar(property.type);
      if (!(index >= 0 && index < static_cast<double>(vertex_->count)) || index != std::floor(index))
        throw error(*face_, faces_offset_, row, fmt::format("vertex {} does not exist", index),
                    fmt::format("the file has {} vertices, counted from 0", vertex_->count));
      corners_.push_back(static_cast<std::uint32_t>(index));
    }
    face_sizes_.push_back(static_cast<std::uint32_t>(length));
  }

  /// With the line, which is looked for anew, where the body is text; else with the row's number.
  InputError error(const PlyElement& element, std::size_t offset, std::uint64_t row, std::string_view problem,
                   std::string_view hint) const {
    const std::string with_row = fmt::format("{} {}: {}", element.name, row, problem);
    if (header_.format != PlyFormat::ascii) return InputError(whole_file(*source_), with_row, hint);
    const std::string& text = source_->text;
    std::size_t begin = offset, end = offset;
    for (std::uint64_t r = 0; r <= row; ++r) {
      begin = std::min(text.find_first_not_of(" \t\v\f\r\n", end), text.size());
      end = std::min(text.find_first_of("\r\n", begin), text.size());
    }
    return InputError(Location{source_, begin, std::max<std::size_t>(end - begin, 1)}, with_row, hint);
  }

  std::shared_ptr<const SourceFile> source_;
  PlyHeader header_;
  const PlyElement *vertex_, *face_;
  VertexLayout layout_;
  std::size_t index_list_ = 0;
  std::size_t vertices_offset_ = 0, faces_offset_ = 0;
  ObjectParts parts_;
  std::vector<std::uint32_t> corners_, face_sizes_;
};

}  // namespace

MeshFile read_ply_file(const std::filesystem::path& file) {
  const auto source = read_whole_file(file, "a PLY mesh");
  if (source->text.empty()) throw InputError(Location{source}, "the file is empty", "expected a PLY mesh");
  if (format_of_content(source->text) == "an OBJ mesh")
    throw InputError(whole_file(*source), "this is an OBJ mesh, not a PLY mesh",
                     "write type=\"obj\" in the scene");
  const auto reader = std::make_shared<PlyReader>(source);
  reader->read();
  return [reader](const Transform& world_from_object, const std::optional<std::string>& /*usemtl*/) {
    return reader->build(world_from_object);
  };
}

Mesh read_ply(const std::filesystem::path& file, const Transform& world_from_object) {
  return read_ply_file(file)(world_from_object, {});
}

}  // namespace etendue

#include "geometry/obj_reader.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

namespace etendue {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// What one corner of a face names: indices from 0 into the file's v, vt, vn, or `none`.
struct Corner {
  std::uint32_t position, uv, normal;
  friend bool operator==(const Corner&, const Corner&) = default;
};

struct Face {
  std::size_t offset;  ///< Of the statement's first byte.
  std::size_t first_corner;
};

/// A normal without direction: an error only where a triangle uses it.
struct ZeroNormal {
  std::uint32_t index;
  std::size_t offset;
};

/// The statements of a file, positions and normals already in world space.
struct Statements {
  std::vector<Vec3f> positions;
  std::vector<Vec2f> uvs;
  std::vector<Vec3f> normals;
  std::vector<ZeroNormal> zero_normals;
  std::vector<Face> faces;
  std::vector<Corner> corners;
};

std::shared_ptr<const SourceFile> read_source(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw InputError(fmt::format("{}: there is no such file", file.string()));
  if (!std::filesystem::is_regular_file(status))
    throw InputError(fmt::format("{}: not a regular file; expected an OBJ mesh", file.string()));
  const auto size = std::filesystem::file_size(file, error);
  auto source = std::make_shared<SourceFile>();
  source->path = file.string();
  std::ifstream stream(file, std::ios::binary);
  if (!error && stream) {
    source->text.resize(size);
    stream.read(source->text.data(), static_cast<std::streamsize>(size));
  }
  if (error || !stream) throw InputError(fmt::format("{}: cannot be read; is it permitted?", file.string()));
  return source;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

/// Walks the text by tokens. A backslash at a line's end joins it with the next line.
class Cursor {
 public:
  Cursor(const std::string& text, std::size_t offset)
      : begin_(text.data()), at_(begin_ + offset), end_(begin_ + text.size()) {}

  bool at_end() const { return at_ == end_; }
  bool at_statement_end() const { return at_ == end_ || is_line_end(*at_) || *at_ == '#'; }
  bool at_token_end() const {
    return at_ == end_ || is_blank(*at_) || is_line_end(*at_) || continuation() > 0;
  }
  std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
  const char* at() const { return at_; }
  const char* end() const { return end_; }
  void move_to(const char* at) { at_ = at; }

  void skip_blanks() {
    for (;;) {
      if (at_ != end_ && is_blank(*at_))
        ++at_;
      else if (const auto joined = continuation())
        at_ += joined;
      else
        return;
    }
  }

  /// Comments and statements that nobody reads are not continued: a path may end in a backslash.
  void skip_line() {
    while (at_ != end_ && !is_line_end(*at_)) ++at_;
    if (at_ != end_) ++at_;
  }

  /// True, and past it, where the next token is `word`.
  bool accept(std::string_view word) {
    if (!std::string_view(at_, static_cast<std::size_t>(end_ - at_)).starts_with(word)) return false;
    const auto before = at_;
    at_ += word.size();
    if (at_token_end()) return true;
    at_ = before;
    return false;
  }

  /// True, and past it, where the next character is `c`.
  bool accept(char c) {
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }

  std::string_view take_token() {
    const auto first = at_;
    while (!at_token_end()) ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

 private:
  std::ptrdiff_t continuation() const {
    if (at_ == end_ || *at_ != '\\' || end_ - at_ < 2) return 0;
    if (at_[1] == '\n') return 2;
    if (at_[1] != '\r') return 0;
    return end_ - at_ > 2 && at_[2] == '\n' ? 3 : 2;
  }

  const char* begin_;
  const char* at_;
  const char* end_;
};

/// Long garbage is cut, and bytes that are not printable ASCII are shown as '?'.
std::string quoted(std::string_view token) {
  constexpr std::size_t most = 40;
  std::string shown(token.substr(0, most));
  for (char& c : shown)
    if (c < 0x20 || c > 0x7e) c = '?';
  return fmt::format("'{}{}'", shown, token.size() > most ? "..." : "");
}

/// Unit, or zero where `n` has no direction that a double can hold.
Vec3f unit_or_zero(const Vec3<double>& n) {
  if (!std::isfinite(n.x) || !std::isfinite(n.y) || !std::isfinite(n.z)) return {0, 0, 0};
  const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
  if (largest == 0) return {0, 0, 0};
  const auto unit = normalize(n / largest);
  return {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
}

Vec3<double> to_double(const Vec3f& v) { return {v.x, v.y, v.z}; }

class Parser {
 public:
  Parser(std::shared_ptr<const SourceFile> source, const Transform& world_from_object)
      : source_(std::move(source)), world_from_object_(world_from_object), cursor_(source_->text, 0) {}

  Statements parse() {
    cursor_.accept('\xEF') && cursor_.accept('\xBB') && cursor_.accept('\xBF');  // the byte order mark
    while (!cursor_.at_end()) {
      cursor_.skip_blanks();
      const auto start = cursor_.offset();
      if (cursor_.accept("v"))
        read_position();
      else if (cursor_.accept("vn"))
        read_normal(start);
      else if (cursor_.accept("vt"))
        read_uv();
      else if (cursor_.accept("f"))
        read_face(start);
      cursor_.skip_line();
    }
    const auto index_count = 3 * (read_.corners.size() - 2 * read_.faces.size());
    if (std::max({read_.positions.size(), read_.uvs.size(), read_.normals.size(), index_count}) >= none)
      throw InputError(
          fmt::format("{}: more than 4294967294 vertices or corners; split the mesh", source_->path));
    return std::move(read_);
  }

 private:
  [[noreturn]] void fail(std::size_t offset, std::size_t length, std::string_view problem,
                         std::string_view hint = {}) const {
    throw InputError(Location{source_, offset, std::max<std::size_t>(length, 1)}, problem, hint);
  }

  /// "vertex 12": as the file counts.
  static std::string label(std::string_view what, std::size_t count_before) {
    return fmt::format("{} {}", what, count_before + 1);
  }

  double read_number(std::string_view what, std::size_t count_before) {
    const auto start = cursor_.offset();
    const bool has_two_signs = cursor_.accept('+') && cursor_.at() != cursor_.end() && *cursor_.at() == '-';
    double value = 0;
    const auto [stop, error] = std::from_chars(cursor_.at(), cursor_.end(), value);
    cursor_.move_to(stop);
    if (error == std::errc() && cursor_.at_token_end() && std::isfinite(value) && !has_two_signs)
      return value;
    cursor_ = Cursor(source_->text, start);
    const auto token = cursor_.take_token();
    const auto which = label(what, count_before);
    if (error == std::errc::result_out_of_range)
      fail(start, token.size(), fmt::format("{}: {} is out of range", which, quoted(token)),
           "expected a number that fits a float");
    if (!std::isfinite(value))
      fail(start, token.size(), fmt::format("{}: {} is not a finite number", which, quoted(token)),
           "the program that wrote this file made an error; export the mesh anew, or repair the vertex by "
           "hand");
    fail(start, token.size(), fmt::format("{}: {} is not a number", which, quoted(token)),
         "expected something like -1.5 or 2e-3");
  }

  float narrow(double value, std::size_t start, std::string_view what, std::size_t count_before) const {
    const auto narrowed = static_cast<float>(value);
    if (!std::isfinite(narrowed))
      fail(start, cursor_.offset() - start,
           fmt::format("{}: {:g} does not fit a float", label(what, count_before), value),
           "expected coordinates, in world space, below 3e38");
    return narrowed;
  }

  /// Reads all numbers of the statement, `least` of them at least, and hands out the first three (0 where
  /// absent).
  Vec3<double> read_numbers(std::string_view what, std::size_t count_before, int least) {
    std::array<double, 3> numbers{};
    int count = 0;
    for (cursor_.skip_blanks(); !cursor_.at_statement_end(); cursor_.skip_blanks(), ++count) {
      const double number = read_number(what, count_before);
      if (count < 3) numbers[static_cast<std::size_t>(count)] = number;
    }
    if (count < least)
      fail(cursor_.offset(), 1,
           fmt::format("{} has {} number{}", label(what, count_before), count, count == 1 ? "" : "s"),
           fmt::format("expected {} here", least == 1 ? "u, or u and v" : "x, y and z"));
    return {numbers[0], numbers[1], numbers[2]};
  }

  void read_position() {
    constexpr std::string_view what = "vertex";
    const auto count = read_.positions.size();
    cursor_.skip_blanks();
    const auto start = cursor_.offset();
    const auto p = transform_point(world_from_object_, read_numbers(what, count, 3));
    read_.positions.push_back(
        {narrow(p.x, start, what, count), narrow(p.y, start, what, count), narrow(p.z, start, what, count)});
  }

  void read_uv() {
    constexpr std::string_view what = "texture vertex";
    const auto count = read_.uvs.size();
    cursor_.skip_blanks();
    const auto start = cursor_.offset();
    const auto uv = read_numbers(what, count, 1);
    read_.uvs.push_back({narrow(uv.x, start, what, count), narrow(uv.y, start, what, count)});
  }

  void read_normal(std::size_t start) {
    const auto count = read_.normals.size();
    const auto object_normal = read_numbers("normal", count, 3);
    const auto normal = unit_or_zero(transform_normal(world_from_object_, object_normal));
    if (normal == Vec3f{0, 0, 0}) read_.zero_normals.push_back({static_cast<std::uint32_t>(count), start});
    read_.normals.push_back(normal);
  }

  /// One index of a corner, where one is written; whether a positive one exists is known at the end of the
  /// file.
  std::uint32_t read_index(std::size_t corner_start, std::size_t count_so_far) {
    std::int64_t written = 0;
    const auto start = cursor_.offset();
    const auto [stop, error] = std::from_chars(cursor_.at(), cursor_.end(), written);
    if (error == std::errc::invalid_argument) {
      if (cursor_.at_token_end() || *cursor_.at() == '/') return none;
      fail_at_corner(corner_start);
    }
    cursor_.move_to(stop);
    const auto length = cursor_.offset() - start;
    if (error == std::errc() && written > 0 && written < none) return static_cast<std::uint32_t>(written - 1);
    if (error == std::errc() && written < 0 && static_cast<std::uint64_t>(-(written + 1)) < count_so_far)
      return static_cast<std::uint32_t>(count_so_far - static_cast<std::uint64_t>(-(written + 1)) - 1);
    const auto shown = std::string_view(source_->text).substr(start, length);
    if (error == std::errc() && written == 0)
      fail(start, length, "index 0", "indices count from 1, or back from -1");
    fail(start, length, fmt::format("index {} is out of range", quoted(shown)),
         shown.front() == '-' ? fmt::format("{} such statements precede this face", count_so_far) : "");
  }

  [[noreturn]] void fail_at_corner(std::size_t corner_start) const {
    const auto token = Cursor(source_->text, corner_start).take_token();
    fail(corner_start, token.size(), fmt::format("{} is not a face vertex", quoted(token)),
         "expected v, v/vt, v//vn or v/vt/vn with whole numbers");
  }

  void read_face(std::size_t face_start) {
    const auto first_corner = read_.corners.size();
    for (cursor_.skip_blanks(); !cursor_.at_statement_end(); cursor_.skip_blanks()) {
      const auto start = cursor_.offset();
      Corner corner{none, none, none};
      corner.position = read_index(start, read_.positions.size());
      if (cursor_.accept('/')) corner.uv = read_index(start, read_.uvs.size());
      if (cursor_.accept('/')) corner.normal = read_index(start, read_.normals.size());
      if (corner.position == none || !cursor_.at_token_end()) fail_at_corner(start);
      read_.corners.push_back(corner);
    }
    const auto count = read_.corners.size() - first_corner;
    if (count < 3)
      fail(face_start, cursor_.offset() - face_start,
           fmt::format("a face of {} {}", count, count == 1 ? "vertex" : "vertices"),
           "expected three or more");
    read_.faces.push_back({face_start, first_corner});
  }

  std::shared_ptr<const SourceFile> source_;
  Transform world_from_object_;
  Cursor cursor_;
  Statements read_;
};

/// Gives each distinct corner a vertex of the mesh. Most positions have one uv and one normal, so the first
/// vertex of each position is found by index; only further ones go through a hash table (open addressing,
/// linear probing).
class VertexTable {
 public:
  explicit VertexTable(std::size_t position_count) : first_of_position_(position_count, none) {}

  /// The corner's vertex, and its corner kept as number `size() - 1` where it is new.
  std::uint32_t find_or_add(const Corner& corner) {
    auto& first = first_of_position_[corner.position];
    if (first == none) return first = add(corner);
    if (corners_[first] == corner) return first;
    if (2 * (split_count_ + 1) > slots_.size()) grow();
    const auto slot = find_slot(corner);
    if (slots_[slot] == none) {
      slots_[slot] = add(corner);
      ++split_count_;
    }
    return slots_[slot];
  }

  std::size_t size() const { return corners_.size(); }

 private:
  std::uint32_t add(const Corner& corner) {
    corners_.push_back(corner);
    return static_cast<std::uint32_t>(corners_.size() - 1);
  }

  std::size_t find_slot(const Corner& c) const {
    std::uint64_t hash = (std::uint64_t{c.position} << 32 | c.normal) * 0x9E3779B97F4A7C15u;
    hash = (hash ^ hash >> 32 ^ c.uv) * 0xD6E8FEB86659FD93u;
    auto slot = (hash ^ hash >> 32) & (slots_.size() - 1);
    while (slots_[slot] != none && corners_[slots_[slot]] != c) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  void grow() {
    const auto old =
        std::exchange(slots_, std::vector<std::uint32_t>(std::max<std::size_t>(64, 2 * slots_.size()), none));
    for (const auto vertex : old)
      if (vertex != none) slots_[find_slot(corners_[vertex])] = vertex;
  }

  std::vector<Corner> corners_;
  std::vector<std::uint32_t> first_of_position_;
  std::vector<std::uint32_t> slots_;
  std::size_t split_count_ = 0;
};

class MeshBuilder {
 public:
  MeshBuilder(std::shared_ptr<const SourceFile> source, Statements read)
      : source_(std::move(source)), read_(std::move(read)), vertices_(read_.positions.size()) {
    for (const auto& corner : read_.corners) {
      has_uvs_ |= corner.uv != none;
      has_normals_ |= corner.normal != none;
    }
    mesh_.name = source_->path;
  }

  Mesh build() {
    mesh_.indices.reserve(3 * (read_.corners.size() - 2 * read_.faces.size()));
    mesh_.positions.reserve(read_.positions.size());
    for (std::size_t f = 0; f < read_.faces.size(); ++f) add_face(f);
    if (mesh_.indices.empty())
      fail(read_.faces.front().offset, "no triangle has an area",
           "the mesh, or the transform it is given, is flat; check its scale");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(std::size_t offset, std::string_view problem, std::string_view hint) const {
    auto end = source_->text.find_first_of("\r\n", offset);
    if (end == std::string::npos) end = source_->text.size();
    throw InputError(Location{source_, offset, end - offset}, problem, hint);
  }

  void check_range(std::size_t face, std::size_t corner, std::uint32_t index, std::size_t count,
                   std::string_view statement) const {
    if (index == none || index < count) return;
    Cursor cursor(source_->text, read_.faces[face].offset);
    cursor.take_token();
    for (std::size_t k = read_.faces[face].first_corner; k < corner; ++k) {
      cursor.skip_blanks();
      cursor.take_token();
    }
    cursor.skip_blanks();
    const auto start = cursor.offset();
    throw InputError(Location{source_, start, cursor.take_token().size()},
                     fmt::format("{} {} does not exist", statement, std::uint64_t{index} + 1),
                     fmt::format("the file has {} {} statement{}", count, statement, count == 1 ? "" : "s"));
  }

  void add_face(std::size_t face) {
    const auto first = read_.faces[face].first_corner;
    const auto last =
        face + 1 < read_.faces.size() ? read_.faces[face + 1].first_corner : read_.corners.size();
    for (auto k = first; k < last; ++k) {
      const auto corner = read_.corners[k];
      check_range(face, k, corner.position, read_.positions.size(), "v");
      check_range(face, k, corner.uv, read_.uvs.size(), "vt");
      check_range(face, k, corner.normal, file_normal_count_, "vn");
    }
    const auto& c = read_.corners;
    if (last - first == 4) {
      add_triangle(face, {c[first], c[first + 1], c[first + 2]});
      add_triangle(face, {c[first + 3], c[first], c[first + 2]});
    } else {
      for (auto k = first + 1; k + 1 < last; ++k) add_triangle(face, {c[first], c[k], c[k + 1]});
    }
  }

  void add_triangle(std::size_t face, std::array<Corner, 3> corners) {
    const auto p0 = to_double(read_.positions[corners[0].position]);
    const auto p1 = to_double(read_.positions[corners[1].position]);
    const auto p2 = to_double(read_.positions[corners[2].position]);
    const auto double_area_normal = cross(p1 - p0, p2 - p0);
    const double double_area_sq = length_sq(double_area_normal);
    const double longest_sq = std::max({length_sq(p1 - p0), length_sq(p2 - p1), length_sq(p0 - p2)});
    constexpr double rounding = 0x1p-21;
    if (double_area_sq <= rounding * rounding * longest_sq * longest_sq ||
        double_area_sq < std::numeric_limits<float>::min()) {
      ++mesh_.dropped_triangles;
      return;
    }
    if (double_area_sq > std::numeric_limits<float>::max())
      fail(read_.faces[face].offset, "a triangle too large for single precision",
           "scale the scene down, so that no area exceeds 1e18 square metres");
    if (has_normals_) give_normals(corners, double_area_normal);
    for (const auto& corner : corners) {
      const auto vertex = vertices_.find_or_add(corner);
      if (vertices_.size() > mesh_.positions.size()) add_vertex(corner);
      mesh_.indices.push_back(vertex);
    }
  }

  /// Flat where a corner lacks a normal; else turned to the side of the normals.
  void give_normals(std::array<Corner, 3>& corners, const Vec3<double>& double_area_normal) {
    if (std::any_of(corners.begin(), corners.end(), [](const Corner& c) { return c.normal == none; })) {
      for (auto& corner : corners) corner.normal = static_cast<std::uint32_t>(read_.normals.size());
      read_.normals.push_back(unit_or_zero(double_area_normal));
      return;
    }
    Vec3<double> sum{0, 0, 0};
    for (const auto& corner : corners) {
      const auto& normal = read_.normals[corner.normal];
      if (normal == Vec3f{0, 0, 0}) fail_at_zero_normal(corner.normal);
      sum = sum + to_double(normal);
    }
    if (dot(double_area_normal, sum) < 0) std::swap(corners[1], corners[2]);
  }

  [[noreturn]] void fail_at_zero_normal(std::uint32_t index) const {
    const auto zero = std::find_if(read_.zero_normals.begin(), read_.zero_normals.end(),
                                   [&](const ZeroNormal& n) { return n.index == index; });
    fail(zero->offset, fmt::format("normal {} has no direction", index + 1),
         "the file or the transform makes it zero; export the mesh without normals, or write one that is not "
         "zero");
  }

  void add_vertex(const Corner& corner) {
    mesh_.positions.push_back(read_.positions[corner.position]);
    if (has_normals_) mesh_.normals.push_back(read_.normals[corner.normal]);
    if (has_uvs_) mesh_.uvs.push_back(corner.uv == none ? Vec2f{0, 0} : read_.uvs[corner.uv]);
  }

  std::shared_ptr<const SourceFile> source_;
  Statements read_;
  std::size_t file_normal_count_ = read_.normals.size();
  VertexTable vertices_;
  Mesh mesh_;
  bool has_uvs_ = false;
  bool has_normals_ = false;
};

}  // namespace

Mesh read_obj(const std::filesystem::path& file, const Transform& world_from_object) {
  const auto source = read_source(file);
  if (source->text.empty())
    throw InputError(Location{source}, "the file is empty", "expected an OBJ mesh: v and f statements");
  auto read = Parser(source, world_from_object).parse();
  if (read.faces.empty())
    throw InputError(Location{source}, "no face",
                     "expected an OBJ mesh with f statements; points and lines alone cannot be rendered");
  return MeshBuilder(source, std::move(read)).build();
}

}  // namespace etendue

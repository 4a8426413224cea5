#include "geometry/obj_reader.h"

#include "geometry/mesh_builder.h"
#include "geometry/mesh_text.h"
#include "scenefile/file_format.h"
#include "scenefile/obj_cursor.h"
#include "scenefile/text_file.h"
#include "scenefile/whole_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <set>
#include <span>
#include <string_view>
#include <utility>

namespace etendue {
namespace {

constexpr std::uint32_t none = Corner::none;

struct Face {
  std::size_t offset;  ///< Of the statement's first byte.
  std::size_t first_corner;
};

/// Faces of one material, up to those of the next run.
struct MaterialRun {
  std::string material;  ///< Empty before the first usemtl.
  std::size_t first_face;
};

/// The statements of a file.
struct ObjStatements : ObjectParts {
  std::vector<Face> faces;
  std::vector<Corner> corners;
  std::vector<MaterialRun> runs{{{}, 0}};
  std::size_t first_material = 0;  ///< Where the first is given; 0 where none is.
};

class Parser {
 public:
  explicit Parser(std::shared_ptr<const SourceFile> source)
      : source_(std::move(source)), cursor_(source_->text, 0) {}

  ObjStatements parse() {
    cursor_.accept('\xEF') && cursor_.accept('\xBB') && cursor_.accept('\xBF');  // the byte order mark
    while (!cursor_.at_end()) {
      cursor_.skip_blanks();
      const auto start = cursor_.offset();
      if (cursor_.accept("v"))
        read_position();
      else if (cursor_.accept("vn"))
        read_normal();
      else if (cursor_.accept("vt"))
        read_uv();
      else if (cursor_.accept("f"))
        read_face(start);
      else if (cursor_.accept("usemtl"))
        read_material(start);
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
    const auto token = cursor_.take_token();
    if (const auto number = finite_number(token)) return *number;
    const auto [problem, hint] = number_problem(token);
    fail(start, token.size(), fmt::format("{}: {}", label(what, count_before), problem), hint);
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

  void read_position() { read_.positions.push_back(read_numbers("vertex", read_.positions.size(), 3)); }

  void read_uv() {
    constexpr std::string_view what = "texture vertex";
    const auto count = read_.uvs.size();
    cursor_.skip_blanks();
    const auto start = cursor_.offset();
    const auto uv = read_numbers(what, count, 1);
    read_.uvs.push_back({narrow(uv.x, start, what, count), narrow(uv.y, start, what, count)});
  }

  void read_material(std::size_t start) {
    if (read_.runs.size() == 1) read_.first_material = start;
    cursor_.skip_blanks();
    read_.runs.push_back({as_utf8(cursor_.take_rest()), read_.faces.size()});
  }

  void read_normal() { read_.normals.push_back(read_numbers("normal", read_.normals.size(), 3)); }

  /// What index 0 means: Cinema 4D writes it for a uv or normal that is not there.
  enum class Zero { is_wrong, is_none };

  /// One index of a corner, where one is written; whether a positive one exists is known at the end of the
  /// file.
  std::uint32_t read_index(std::size_t corner_start, std::size_t count_so_far, Zero zero) {
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
    if (error == std::errc() && written == 0 && zero == Zero::is_none) return none;
    if (error == std::errc() && written == 0)
      fail(start, length, "index 0", "indices count from 1, or back from -1");
    fail(start, length, fmt::format("index {} is out of range", quoted(shown)),
         shown.front() == '-' ? fmt::format("{} such statements precede this face", count_so_far) : "");
  }

  [[noreturn]] void fail_at_corner(std::size_t corner_start) const {
    const auto token = ObjCursor(source_->text, corner_start).take_token();
    fail(corner_start, token.size(), fmt::format("{} is not a face vertex", quoted(token)),
         "expected v, v/vt, v//vn or v/vt/vn with whole numbers");
  }

  void read_face(std::size_t face_start) {
    const auto first_corner = read_.corners.size();
    for (cursor_.skip_blanks(); !cursor_.at_statement_end(); cursor_.skip_blanks()) {
      const auto start = cursor_.offset();
      Corner corner{none, none, none};
      corner.position = read_index(start, read_.positions.size(), Zero::is_wrong);
      if (cursor_.accept('/')) corner.uv = read_index(start, read_.uvs.size(), Zero::is_none);
      if (cursor_.accept('/')) corner.normal = read_index(start, read_.normals.size(), Zero::is_none);
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
  ObjCursor cursor_;
  ObjStatements read_;
};

/// Numbers anew, from 0 and in the order of their first use, some of what a file lists.
class Numbering {
 public:
  explicit Numbering(std::size_t count_in_file) : number_(count_in_file, none) {}
  std::uint32_t number(std::uint32_t in_file) {
    if (in_file == none) return none;
    if (number_[in_file] == none) {
      number_[in_file] = static_cast<std::uint32_t>(in_file_.size());
      in_file_.push_back(in_file);
    }
    return number_[in_file];
  }
  std::size_t in_file(std::size_t number) const { return in_file_[number]; }

  template <class T>
  std::vector<T> taken_from(const std::vector<T>& all) const {
    std::vector<T> taken;
    taken.reserve(in_file_.size());
    for (const std::uint32_t i : in_file_) taken.push_back(all[i]);
    return taken;
  }

 private:
  std::vector<std::uint32_t> number_, in_file_;
};

struct FaceRange {
  std::size_t begin, end;
};

/// What some faces use of a file.
struct UsedParts {
  Numbering positions, uvs, normals;
  ObjectParts parts;

  explicit UsedParts(const ObjectParts& all)
      : positions(all.positions.size()), uvs(all.uvs.size()), normals(all.normals.size()) {}
  Corner number(const Corner& corner) {
    return {positions.number(corner.position), uvs.number(corner.uv), normals.number(corner.normal)};
  }
  void take(const ObjectParts& all) {
    parts.positions = positions.taken_from(all.positions);
    parts.uvs = uvs.taken_from(all.uvs);
    parts.normals = normals.taken_from(all.normals);
  }
};

/// Puts the faces together, once it is known what the file has.
class Assembler {
 public:
  Assembler(std::shared_ptr<const SourceFile> source, ObjStatements read)
      : source_(std::move(source)), read_(std::move(read)) {
    for (const auto& corner : read_.corners) {
      has_uvs_ |= corner.uv != none;
      has_normals_ |= corner.normal != none;
    }
    for (std::size_t f = 0; f < read_.faces.size(); ++f) check_face(f);
    for (std::size_t r = 1; r < read_.runs.size(); ++r) materials_.insert(read_.runs[r].material);
  }

  Mesh build(const Transform& world_from_object, const std::optional<std::string>& usemtl) const {
    const std::vector<FaceRange> ranges = ranges_of(usemtl);
    // Of a part of the file, what the other parts use is left alone.
    std::optional<UsedParts> used;
    if (usemtl) used = parts_used_by(ranges);
    const auto fail_at_face = [this](std::size_t face, std::string_view problem, std::string_view hint) {
      return error(read_.faces[face].offset, problem, hint);
    };
    const auto fail_at_position = [&](std::size_t index, std::string_view problem, std::string_view hint) {
      if (used) index = used->positions.in_file(index);
      ObjCursor cursor = find_statement("v", index);
      cursor.accept("v");
      cursor.skip_blanks();
      return error(cursor.offset(), fmt::format("vertex {}: {}", index + 1, problem), hint);
    };
    const auto fail_at_normal = [&](std::size_t index, std::string_view problem, std::string_view hint) {
      if (used) index = used->normals.in_file(index);
      return error(find_statement("vn", index).offset(), fmt::format("normal {} {}", index + 1, problem),
                   hint);
    };
    const ObjectParts& whole = read_;
    const ObjectParts& parts = used ? used->parts : whole;
    MeshBuilder builder(source_->path, parts, world_from_object, has_uvs_, has_normals_,
                        {fail_at_face, fail_at_position, fail_at_normal});
    std::size_t triangles = 0;
    for (const FaceRange& range : ranges)
      triangles += first_corner(range.end) - first_corner(range.begin) - 2 * (range.end - range.begin);
    builder.reserve_triangles(triangles);
    std::vector<Corner> renumbered;
    for (const FaceRange& range : ranges)
      for (std::size_t f = range.begin; f < range.end; ++f) {
        std::span<const Corner> corners = corners_of(f);
        if (used) {
          renumbered.clear();
          for (const Corner& corner : corners) renumbered.push_back(used->number(corner));
          corners = renumbered;
        }
        builder.add_face(f, corners);
      }
    Mesh mesh = std::move(builder).finish();
    mesh.materials = materials_.size();
    if (mesh.materials > 0)
      mesh.materials_passed_over =
          error(
              read_.first_material, "the materials of this file are passed over",
              "all of the mesh has the bsdf and emitter that the scene file gives it (a mesh without bsdf is "
              "diffuse grey); <boolean name=\"materials\" value=\"true\"/> in the mesh takes those of the "
              "file")
              .what();
    return mesh;
  }

 private:
  InputError error(std::size_t offset, std::string_view problem, std::string_view hint) const {
    auto end = source_->text.find_first_of("\r\n", offset);
    if (end == std::string::npos) end = source_->text.size();
    return InputError(Location{source_, offset, end - offset}, problem, hint);
  }

  /// Number `index`, from 0, of the statements that begin with `word`; no place is kept for each.
  ObjCursor find_statement(std::string_view word, std::size_t index) const {
    for (ObjCursor cursor(source_->text, 0);; cursor.skip_line()) {
      cursor.skip_blanks();
      ObjCursor inside = cursor;
      if (!inside.accept(word)) continue;
      if (index-- == 0) return cursor;
      // Past lines that continue it.
      for (inside.skip_blanks(); !inside.at_statement_end(); inside.skip_blanks()) inside.take_token();
      cursor = inside;
    }
  }

  /// Throws where there is none.
  std::vector<FaceRange> ranges_of(const std::optional<std::string>& usemtl) const {
    std::vector<FaceRange> ranges;
    for (std::size_t r = 0; r < read_.runs.size(); ++r) {
      if (usemtl && read_.runs[r].material != *usemtl) continue;
      const std::size_t begin = read_.runs[r].first_face,
                        end = r + 1 < read_.runs.size() ? read_.runs[r + 1].first_face : read_.faces.size();
      if (begin < end) ranges.push_back({begin, end});
    }
    if (ranges.empty())
      throw InputError(whole_file(*source_), fmt::format("no face has the material '{}'", *usemtl),
                       known_names(*usemtl, {materials_.begin(), materials_.end()}));
    return ranges;
  }

  UsedParts parts_used_by(const std::vector<FaceRange>& ranges) const {
    UsedParts used(read_);
    for (const FaceRange& range : ranges)
      for (std::size_t k = first_corner(range.begin); k < first_corner(range.end); ++k)
        used.number(read_.corners[k]);
    used.take(read_);
    return used;
  }

  std::span<const Corner> corners_of(std::size_t face) const {
    return std::span(read_.corners).subspan(first_corner(face), first_corner(face + 1) - first_corner(face));
  }

  std::size_t first_corner(std::size_t face) const {
    return face < read_.faces.size() ? read_.faces[face].first_corner : read_.corners.size();
  }

  void check_face(std::size_t face) const {
    for (auto k = first_corner(face); k < first_corner(face + 1); ++k) {
      const auto& corner = read_.corners[k];
      check_range(face, k, corner.position, read_.positions.size(), "v");
      check_range(face, k, corner.uv, read_.uvs.size(), "vt");
      check_range(face, k, corner.normal, read_.normals.size(), "vn");
    }
  }

  void check_range(std::size_t face, std::size_t corner, std::uint32_t index, std::size_t count,
                   std::string_view statement) const {
    if (index == none || index < count) return;
    ObjCursor cursor(source_->text, read_.faces[face].offset);
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

  std::shared_ptr<const SourceFile> source_;
  ObjStatements read_;
  std::set<std::string> materials_;  ///< That are named, with faces or without.
  bool has_uvs_ = false, has_normals_ = false;
};

}  // namespace

MeshFile read_obj_file(const std::filesystem::path& file) {
  const auto source = read_whole_file(file, "an OBJ mesh");
  if (source->text.empty())
    throw InputError(Location{source}, "the file is empty", "expected an OBJ mesh: v and f statements");
  if (const std::string_view format = format_of_content(source->text);
      !format.empty() && format != "an OBJ mesh" && source->text.front() != '#')
    throw InputError(whole_file(*source), fmt::format("this is {}, not an OBJ mesh", format),
                     format == "a PLY mesh" ? "write type=\"ply\" in the scene" : "");
  auto read = Parser(source).parse();
  if (read.faces.empty())
    throw InputError(Location{source}, "no face",
                     "expected an OBJ mesh with f statements; points and lines alone cannot be rendered");
  return [all = std::make_shared<const Assembler>(source, std::move(read))](
             const Transform& world_from_object, const std::optional<std::string>& usemtl) {
    return all->build(world_from_object, usemtl);
  };
}

Mesh read_obj(const std::filesystem::path& file, const Transform& world_from_object) {
  return read_obj_file(file)(world_from_object, {});
}

}  // namespace etendue

// The PLY reader: each rule of its header in all three formats, each error, and files written by others.
#include "geometry/ply_reader.h"

#include "base/error.h"
#include "support/data_folder.h"
#include "support/error_of.h"
#include "support/memory_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::filesystem::path write_ply(const std::string& bytes) {
  const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  const auto path = std::filesystem::path(::testing::TempDir()) / ("etendue_" + test + ".ply");
  std::filesystem::remove(path);  // Filling an old file anew makes some file systems wait for the disk.
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

Mesh read_bytes(const std::string& bytes, const Transform& world_from_object = {}) {
  return read_ply(write_ply(bytes), world_from_object);
}

std::string error_of_ply(const std::string& bytes, const Transform& world_from_object = {}) {
  return test::error_of([&] { read_bytes(bytes, world_from_object); });
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string list = "property list uchar int vertex_indices\n";

std::string ascii(const std::string& elements, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}
std::string ply_square(const std::string& faces, int count) {
  return ascii("element vertex 4\n" + xyz + "element face " + std::to_string(count) + "\n" + list,
               "0 0 0\n1 0 0\n1 1 0\n0 1 0\n" + faces);
}

/// Writes values as a type of PLY, in either byte order.
class Bytes {
 public:
  explicit Bytes(std::endian order) : order_(order) {}
  template <class T>
  Bytes& add(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (order_ != std::endian::native) std::reverse(bytes, bytes + sizeof(T));
    text.append(bytes, sizeof(T));
    return *this;
  }
  Bytes& operator<<(const std::string& plain) {
    text += plain;
    return *this;
  }
  std::string text;

 private:
  std::endian order_;
};

std::string binary_format(std::endian order) {
  return order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
}

/// All types, properties in odd orders, elements and lists that nobody knows, faces in front.
std::string everything(std::endian order) {
  Bytes file(order);
  file << "ply\nformat " + binary_format(order) +
              " 1.0\ncomment made by hand\nobj_info none\n"
              "element thing 2\nproperty ushort a\nproperty list uint double b\n"
              "element face 2\nproperty uchar red\nproperty list ushort uint vertex_index\n"
              "property list char short extra\n"
              "element vertex 4\nproperty short t\nproperty double z\nproperty char y\nproperty float nz\n"
              "property list uchar uchar colours\nproperty ushort s\nproperty float nx\nproperty double ny\n"
              "property int32 x\n"
              "element nothing 4000000000\n"
              "element tail 3\nproperty float64 c\nend_header\n";
  file.add(std::uint16_t(7)).add(std::uint32_t(2)).add(1.0).add(std::nan(""));
  file.add(std::uint16_t(7)).add(std::uint32_t(0));
  file.add('r').add(std::uint16_t(3)).add(0u).add(1u).add(2u).add(std::int8_t(1)).add(std::int16_t(-1));
  file.add('r').add(std::uint16_t(4)).add(0u).add(1u).add(2u).add(3u).add(std::int8_t(0));
  const int corners[4][2] = {{0, 0}, {100, 0}, {100, 100}, {0, 100}};
  for (const auto& c : corners) {
    file.add(std::int16_t(-c[1])).add(5.0).add(std::int8_t(c[1])).add(2.0f);
    file.add(std::uint8_t(3)) << "rgb";
    file.add(std::uint16_t(c[0])).add(0.0f).add(0.0).add(std::int32_t(c[0]));
  }
  file.add(1.0).add(2.0).add(3.0);
  return file.text;
}

TEST(PlyReader, ascii_triangle) {
  const auto mesh = read_bytes(ply_square("3 0 1 2\n", 1));
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}));
  EXPECT_THAT(mesh.indices, ElementsAre(0, 1, 2));
  EXPECT_THAT(mesh.normals, IsEmpty());
  EXPECT_THAT(mesh.uvs, IsEmpty());
  EXPECT_THAT(mesh.name, HasSubstr("etendue_ascii_triangle.ply"));
}

TEST(PlyReader, both_byte_orders_all_types_any_order_and_unknown_parts) {
  for (const auto order : {std::endian::little, std::endian::big}) {
    const auto mesh = read_bytes(everything(order));
    EXPECT_THAT(mesh.positions,
                ElementsAre(Vec3f{0, 0, 5}, Vec3f{100, 0, 5}, Vec3f{100, 100, 5}, Vec3f{0, 100, 5}));
    EXPECT_THAT(mesh.indices, ElementsAre(0, 1, 2, 0, 1, 2, 3, 0, 2));
    EXPECT_THAT(mesh.uvs, ElementsAre(Vec2f{0, 0}, Vec2f{100, 0}, Vec2f{100, -100}, Vec2f{0, -100}));
    for (const auto& n : mesh.normals) EXPECT_EQ(n, (Vec3f{0, 0, 1}));
    EXPECT_EQ(mesh.normals.size(), 4u);
  }
}

TEST(PlyReader, names_of_uv) {
  for (const auto& [first, second] :
       {std::pair{"u", "v"}, std::pair{"s", "t"}, std::pair{"texture_u", "texture_v"}}) {
    const std::string elements = std::string("element vertex 3\nproperty float ") + second + "\n" + xyz +
                                 "property float " + first + "\nelement face 1\n" + list;
    EXPECT_THAT(read_bytes(ascii(elements, ".5 0 0 0 .25\n0 1 0 0 1\n1 0 1 0 0\n3 0 1 2\n")).uvs,
                ElementsAre(Vec2f{.25f, .5f}, Vec2f{1, 0}, Vec2f{0, 1}));
  }
  // Half a pair is something else; of two pairs the first of the list counts.
  const std::string both = "element vertex 3\nproperty float s\nproperty float t\nproperty float u\n";
  const std::string body = "9 8 7 0 0 0\n9 8 7 1 0 0\n9 8 7 0 1 0\n3 0 1 2\n";
  EXPECT_EQ(read_bytes(ascii(both + xyz + "element face 1\n" + list, body)).uvs[0], (Vec2f{9, 8}));
  EXPECT_EQ(read_bytes(ascii(both + "property float v\n" + xyz + "element face 1\n" + list,
                             "9 8 7 6 0 0 0\n9 8 7 6 1 0 0\n9 8 7 6 0 1 0\n3 0 1 2\n"))
                .uvs[0],
            (Vec2f{7, 6}));
}

TEST(PlyReader, quads_and_polygons_are_split_as_of_other_formats) {
  EXPECT_THAT(read_bytes(ply_square("4 0 1 2 3\n", 1)).indices, ElementsAre(0, 1, 2, 3, 0, 2));
  EXPECT_THAT(read_bytes(ascii("element vertex 5\n" + xyz + "element face 1\n" + list,
                               "0 0 0\n2 0 0\n3 1 0\n1 2 0\n-1 1 0\n5 0 1 2 3 4\n"))
                  .indices,
              ElementsAre(0, 1, 2, 0, 2, 3, 0, 3, 4));
}

TEST(PlyReader, vertices_that_no_triangle_uses_are_left_out_and_flat_triangles_counted) {
  const auto mesh = read_bytes(ply_square("3 3 1 2\n3 0 0 1\n", 2));
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{0, 1, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}));
  EXPECT_EQ(mesh.dropped_triangles, 1u);
}

TEST(PlyReader, line_ends_and_blanks) {
  const std::string unix_text = ply_square("3 0 1 2\n", 1);
  std::string dos, mac, wide;
  for (const char c : unix_text) {
    dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
    mac += c == '\n' ? '\r' : c;
    wide += c == '\n' ? std::string(" \t \n") : std::string(1, c);
  }
  for (const auto& text : {dos, mac, wide, unix_text + "\n \n", unix_text.substr(0, unix_text.size() - 1)})
    EXPECT_THAT(read_bytes(text).indices, ElementsAre(0, 1, 2)) << text;
}

TEST(PlyReader, binary_after_a_header_of_each_line_end) {
  // The first byte of the body is a line end itself: 10 as the low byte of x.
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    Bytes file(std::endian::little);
    for (const char* line : {"ply", "format binary_little_endian 1.0", "element vertex 3", "property short x",
                             "property short y", "property short z", "element face 1",
                             "property list uchar uchar vertex_indices", "end_header"})
      file << line + end;
    for (const std::int16_t k : {10, 0, 0, 20, 0, 0, 10, 13, 0}) file.add(k);
    file << std::string("\3\0\1\2", 4);
    EXPECT_EQ(read_bytes(file.text).positions[0], (Vec3f{10, 0, 0}));
    EXPECT_EQ(read_bytes(file.text + "\n").positions[2], (Vec3f{10, 13, 0})) << "a line end behind it all";
  }
}

TEST(PlyReader, transform_moves_positions_and_turns_normals) {
  const std::string elements = "element vertex 3\n" + xyz +
                               "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n" +
                               list;
  const auto mesh = read_bytes(ascii(elements, "0 0 0 3 3 0\n0 0 1 3 3 0\n1 -1 0 3 3 0\n3 0 1 2\n"),
                               translation({10, 0, 0}) * scaling({2, 1, 1}));
  EXPECT_EQ(mesh.positions[0], (Vec3f{10, 0, 0}));
  EXPECT_NEAR(mesh.normals[0].x, 1 / std::sqrt(5.0), 1e-7);
  EXPECT_NEAR(mesh.normals[0].y, 2 / std::sqrt(5.0), 1e-7);
}

TEST(PlyReaderError, header) {
  const auto with = [](const std::string& lines) { return error_of_ply("ply\n" + lines); };
  const std::string format = "format ascii 1.0\n";
  EXPECT_THAT(error_of_ply(""), HasSubstr("the file is empty"));
  for (const char* other : {"v 0 0 0\n", "p", "ply", "plyformat ascii 1.0\n"})
    EXPECT_THAT(error_of_ply(other), HasSubstr("not a PLY")) << other;
  EXPECT_THAT(with("format ascii 2.0\n"), AllOf(HasSubstr("header.ply:2:14: "), HasSubstr("version '2.0'")));
  EXPECT_THAT(with("format asci 1.0\n"), HasSubstr("did you mean 'ascii'?"));
  EXPECT_THAT(with(format + format), HasSubstr("a second format"));
  EXPECT_THAT(with(format + "elemnt vertex 3\n"),
              AllOf(HasSubstr("header.ply:3:1: "), HasSubstr("did you mean 'element'?")));
  EXPECT_THAT(with(format + "element vertex\n"), HasSubstr("'' is not a number of elements"));
  EXPECT_THAT(with(format + "element vertex -1\n"), HasSubstr("'-1' is not a number of elements"));
  EXPECT_THAT(with(format + "element vertex 99999999999999999999\n"), HasSubstr("not a number of elements"));
  EXPECT_THAT(with(format + "element vertex 3 4\n"), HasSubstr("'4' is too much"));
  EXPECT_THAT(with(format + "element a 3\nelement a 3\n"), HasSubstr("a second element 'a'"));
  EXPECT_THAT(with(format + "property float x\n"), HasSubstr("before the first element"));
  EXPECT_THAT(with(format + "element a 3\nproperty flaot x\n"), HasSubstr("did you mean 'float'?"));
  EXPECT_THAT(with(format + "element a 3\nproperty list float int x\n"), HasSubstr("a whole number"));
  EXPECT_THAT(with(format + "element a 3\nproperty float\n"), HasSubstr("without a name"));
  EXPECT_THAT(with(format + "element a 3\nproperty float x\nproperty int x\n"),
              HasSubstr("a second property 'x'"));
  EXPECT_THAT(with(format + "element vertex 3\n"), HasSubstr("the file ends within its header"));
  EXPECT_THAT(with("element vertex 3\n" + xyz + "end_header\n"), HasSubstr("states no format"));
}

TEST(PlyReaderError, elements) {
  const std::string vertex = "element vertex 3\n" + xyz;
  EXPECT_THAT(error_of_ply(ascii("", "")), HasSubstr("no element 'vertex'"));
  EXPECT_THAT(error_of_ply(ascii(vertex, "")), HasSubstr("no face"));
  EXPECT_THAT(error_of_ply(ascii(vertex + "element face 0\n" + list, "0 0 0\n1 0 0\n1 1 0\n")),
              HasSubstr("no face"));
  EXPECT_THAT(error_of_ply(ascii(vertex + "element tristrips 1\n" + list, "")),
              HasSubstr("triangle strips cannot be read"));
  EXPECT_THAT(error_of_ply(
                  ascii("element vertex 3\nproperty float x\nproperty float y\nelement face 1\n" + list, "")),
              HasSubstr("the vertices have no z"));
  EXPECT_THAT(error_of_ply(ascii("element vertex 3\nproperty list uchar int x\nelement face 1\n" + list, "")),
              HasSubstr("'x' of a vertex is a list"));
  EXPECT_THAT(error_of_ply(ascii(vertex + "property float nx\nelement face 1\n" + list, "")),
              HasSubstr("only part of a normal"));
  EXPECT_THAT(error_of_ply(ascii(vertex + "element face 1\nproperty int vertex_index\n", "")),
              HasSubstr("'vertex_index' of a face is not a list"));
  EXPECT_THAT(error_of_ply(ascii(vertex + "element face 1\nproperty int a\n", "")),
              HasSubstr("the faces do not list their vertices"));
}

TEST(PlyReader, concave_faces_are_filled_and_those_that_cross_themselves_told) {
  const Mesh mesh = read_bytes(ascii("element vertex 4\n" + xyz + "element face 2\n" + list,
                                     "0 1e-400 0\n2 -1 0\n0 2 0\n-2 -1 0\n4 0 1 2 3\n4 1 2 3 0\n"));
  for (std::size_t t = 0; t < 4; ++t) {
    const auto p = [&](std::size_t k) { return mesh.positions[mesh.indices[3 * t + k]]; };
    EXPECT_GT(cross(p(1) - p(0), p(2) - p(0)).z, 0) << t;
  }
  EXPECT_TRUE(mesh.warnings.empty());
  EXPECT_THAT(read_bytes(ply_square("4 0 1 2 3\n4 0 2 1 3\n", 2)).warnings,
              ::testing::ElementsAre(HasSubstr(".ply:15:1: face 1: this polygon crosses itself")));
}

TEST(PlyReaderError, rows_of_text) {
  const auto at = [](const char* place) { return HasSubstr(std::string("rows_of_text.ply:") + place); };
  const auto first_row = [](const std::string& row) {
    return error_of_ply(ascii("element vertex 4\n" + xyz + "element face 1\n" + list,
                              row + "\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"));
  };
  EXPECT_THAT(first_row("0 abc 0"), AllOf(at("10:3: "), HasSubstr("vertex 0: 'abc' is not a number")));
  EXPECT_THAT(first_row("0 0 nan"), AllOf(at("10:5: "), HasSubstr("'nan' is not a finite number")));
  EXPECT_THAT(first_row("0 0 1e999"), HasSubstr("'1e999' is out of range"));
  EXPECT_THAT(first_row("0 0 1e39"), AllOf(at("10:1: "), HasSubstr("vertex 0: 1e+39 does not fit a float")));
  EXPECT_THAT(first_row("0 0"), AllOf(at("10:4: "), HasSubstr("too few values")));
  EXPECT_THAT(first_row("0 0 0 7"), AllOf(at("10:7: "), HasSubstr("'7' is a value too many")));
  EXPECT_THAT(error_of_ply(ply_square("3 0 1 4\n", 1)),
              AllOf(at("14:1: "), HasSubstr("face 0: vertex 4 does not exist"), HasSubstr("4 vertices")));
  EXPECT_THAT(error_of_ply(ply_square("3 0 1 -1\n", 1)), HasSubstr("vertex -1 does not exist"));
  EXPECT_THAT(error_of_ply(ply_square("3 0 1 1.5\n", 1)), HasSubstr("vertex 1.5 does not exist"));
  EXPECT_THAT(error_of_ply(ply_square("2 0 1\n", 1)), HasSubstr("a face of 2 vertices"));
  EXPECT_THAT(error_of_ply(ply_square("-3 0 1 2\n", 1)), HasSubstr("'-3' is not the length of a list"));
  EXPECT_THAT(error_of_ply(ply_square("4000000000 0 1 2\n", 1)), HasSubstr("too few values"));
  EXPECT_THAT(error_of_ply(ply_square("3 0 1 2\n3 0 0 1\n", 3)),
              HasSubstr("the file ends after 2 of 3 rows of element 'face'"));
  EXPECT_THAT(error_of_ply(ply_square("3 0 1 2\n3 0 0 1\n", 1)),
              AllOf(at("15:1: "), HasSubstr("the file goes on")));
  EXPECT_THAT(error_of_ply(ply_square("3 0 1 1\n", 1)),
              AllOf(at("14:1: "), HasSubstr("no triangle has an area")));
  EXPECT_THAT(error_of_ply(ply_square("3 0 1 1\n3 0 1 2\n", 2), scaling({1e10, 1e10, 1})),
              AllOf(at("15:1: "), HasSubstr("face 1: a triangle too large")));
}

TEST(PlyReaderError, normals_without_direction) {
  const std::string elements = "element vertex 4\n" + xyz +
                               "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n" +
                               list;
  const std::string vertices = "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 0\n0 1 0 0 0 1\n";
  EXPECT_THAT(error_of_ply(ascii(elements, vertices + "3 0 1 2\n")),
              AllOf(HasSubstr("direction.ply:15:1: "), HasSubstr("vertex 2: its normal has no direction")));
  EXPECT_EQ(read_bytes(ascii(elements, vertices + "3 0 1 3\n")).triangle_count(), 1u);
}

/// Whether it is read, with a sound mesh; where not, the message names the file.
bool is_read(const std::string& bytes) {
  const test::MemoryFile file(bytes.data(), bytes.size());
  try {
    const auto mesh = read_ply(file.path(), {});
    for (const auto index : mesh.indices) EXPECT_LT(index, mesh.positions.size());
    for (const auto& p : mesh.positions)
      EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    return true;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(file.path().string()));
    return false;
  }
}

TEST(PlyReaderError, cut_anywhere) {
  const std::string files[] = {ply_square("3 0 1 2\n4 0 1 2 3\n", 2), everything(std::endian::little),
                               everything(std::endian::big)};
  for (const auto& file : files) {
    EXPECT_TRUE(is_read(file));
    for (std::size_t length = 0; length + 2 < file.size(); ++length)
      EXPECT_FALSE(is_read(file.substr(0, length))) << length;
  }
}

TEST(PlyReaderError, one_bit_wrong_anywhere) {
  for (auto file : {ply_square("3 0 1 2\n4 0 1 2 3\n", 2), everything(std::endian::little)})
    for (std::size_t k = 0; k < 8 * file.size(); ++k) {
      SCOPED_TRACE(k);
      file[k / 8] ^= char(1 << k % 8);
      is_read(file);
      file[k / 8] ^= char(1 << k % 8);
    }
}

TEST(PlyReaderError, claims_cost_no_memory) {
  const std::string vertex = "element vertex 4000000000\n" + xyz, faces = "element face 4000000000\n" + list;
  const std::string vertices = "element vertex 3\n" + xyz;
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::string start = "ply\nformat " + format + " 1.0\n";
    EXPECT_THAT(error_of_ply(start + vertex + faces + "end_header\n1 2 3\n"), HasSubstr("4000000000 rows"));
    EXPECT_THAT(error_of_ply(start + "element other 18446744073709551615\n" + xyz + vertex + faces +
                             "end_header\n1 2 3\n"),
                HasSubstr("18446744073709551615 rows"));
    EXPECT_THAT(error_of_ply(start + "element vertex 4294967295\n" + xyz + faces + "end_header\n"),
                HasSubstr("more than 4294967294 vertices"));
  }
  Bytes file(std::endian::little);
  file << "ply\nformat binary_little_endian 1.0\n" + vertices +
              "element face 1\nproperty list uint uint vertex_indices\nend_header\n" + std::string(36, '\0');
  file.add(4000000000u).add(0u).add(0u);
  EXPECT_THAT(error_of_ply(file.text), HasSubstr("the file ends after 0 of 1 rows of element 'face'"));
}

TEST(PlyReaderError, binary_rows) {
  Bytes file(std::endian::big);
  file << "ply\nformat binary_big_endian 1.0\nelement vertex 3\n" + xyz +
              "element face 1\nproperty list char int vertex_indices\nend_header\n";
  for (const float k : {0, 0, 0, 1, 0, 0, 0, 1, 0}) file.add(k);
  const auto face = [&](std::int8_t length, std::int32_t last) {
    Bytes with = file;
    with.add(length).add(0).add(1).add(last);
    return error_of_ply(with.text);
  };
  EXPECT_EQ(face(3, 2), "");
  EXPECT_THAT(face(3, 3), AllOf(HasSubstr("rows.ply: face 0: vertex 3 does not exist")));
  EXPECT_THAT(face(3, -1), HasSubstr("vertex -1 does not exist"));
  EXPECT_THAT(face(-3, 2), HasSubstr("a list of -3 entries"));
  Bytes endless = file;
  endless.add(std::int8_t(3)).add(0).add(1).add(2).add(7);
  EXPECT_THAT(error_of_ply(endless.text), HasSubstr("4 bytes are left"));
  const float infinite = INFINITY;
  Bytes bad(std::endian::big);
  bad << file.text.substr(0, file.text.size() - 4);
  bad.add(infinite).add(std::int8_t(3)).add(0).add(1).add(2);
  EXPECT_THAT(error_of_ply(bad.text), HasSubstr("vertex 2: inf is not a finite number"));
}

TEST(PlyReaderData, files_of_others) {
  const auto data = test::data_folder();
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is absent";
  std::size_t read = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    // Two are damaged: a face's list among the vertices, a line of the header without 'comment'.
    if (entry.path().filename() == "issue623.ply" || entry.path().filename() == "Wuson.ply") continue;
    if (entry.path().extension() != ".ply") continue;
    SCOPED_TRACE(entry.path());
    EXPECT_GT(read_ply(entry.path(), {}).triangle_count(), 0u);
    ++read;
  }
  EXPECT_GT(read, 5u);
}

}  // namespace
}  // namespace etendue

// The OBJ reader: each rule of its header, each error with its place, and files written by others.
#include "geometry/obj_reader.h"

#include "base/error.h"
#include "geometry/shapes.h"
#include "support/data_folder.h"
#include "support/error_of.h"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

namespace etendue {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::filesystem::path write_obj(const std::string& text) {
  const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  const auto path = std::filesystem::path(::testing::TempDir()) / ("etendue_" + test + ".obj");
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

Mesh read_text(const std::string& text, const Transform& world_from_object = {}) {
  return read_obj(write_obj(text), world_from_object);
}

std::string error_of_obj(const std::string& text, const Transform& world_from_object = {}) {
  return test::error_of([&] { read_text(text, world_from_object); });
}

Vec3f corner(const Mesh& mesh, std::size_t k) { return mesh.positions[mesh.indices[k]]; }

Vec3f geometric_normal(const Mesh& mesh, std::size_t triangle) {
  const auto p = corner(mesh, 3 * triangle);
  return cross(corner(mesh, 3 * triangle + 1) - p, corner(mesh, 3 * triangle + 2) - p);
}

TEST(ObjReader, triangle) {
  const auto mesh = read_text("v 1 2 3\nv 4 5 6\nv 7 8 10\nf 1 2 3\n");
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{1, 2, 3}, Vec3f{4, 5, 6}, Vec3f{7, 8, 10}));
  EXPECT_THAT(mesh.indices, ElementsAre(0, 1, 2));
  EXPECT_THAT(mesh.normals, IsEmpty());
  EXPECT_THAT(mesh.uvs, IsEmpty());
  EXPECT_EQ(mesh.dropped_triangles, 0u);
  EXPECT_THAT(mesh.name, HasSubstr("etendue_triangle.obj"));
}

TEST(ObjReader, quad_is_split_as_in_nori) {
  EXPECT_THAT(read_text(square + std::string("f 1 2 3 4\n")).indices, ElementsAre(0, 1, 2, 3, 0, 2));
}

TEST(ObjReader, polygon_is_a_fan) {
  const auto mesh = read_text("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv -1 1 0\nf 1 2 3 4 5\n");
  EXPECT_THAT(mesh.indices, ElementsAre(0, 1, 2, 0, 2, 3, 0, 3, 4));
}

TEST(ObjReader, concave_face_is_filled_not_its_hull) {
  const auto mesh = read_text("v 0 1 0\nv 2 0 0\nv 0 3 0\nv -2 0 0\nf 1 2 3 4\nf 2 3 4 1\n");
  for (std::size_t t = 0; t < 4; ++t) EXPECT_FLOAT_EQ(geometric_normal(mesh, t).z, 4) << t;
  EXPECT_THAT(mesh.warnings, IsEmpty());
}

TEST(ObjReader, faces_that_cross_themselves_are_told_with_the_first) {
  EXPECT_THAT(
      read_text(square + std::string("f 1 2 3 4\nf 1 3 2 4\nf 2 4 3 1\n")).warnings,
      ElementsAre(AllOf(HasSubstr(".obj:6:1: 2 polygons cross themselves, or are folded; the first"))));
  EXPECT_THAT(read_text("v 0 0 0\nv 2 0 0\nv 3 1 2\nv 1 2 -1\nv -1 1 0\nf 1 2 3 4 5\n").warnings,
              ElementsAre(HasSubstr(".obj:6:1: the corners of this polygon lie far from one plane")));
}

TEST(ObjReader, materials_are_counted_and_the_first_is_told) {
  const Mesh mesh = read_text("mtllib box.mtl\n" + std::string(square) +
                              "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\nusemtl a\nf 1 2 4\n");
  EXPECT_EQ(mesh.materials, 2u);
  EXPECT_THAT(mesh.materials_passed_over, HasSubstr(".obj:6:1: the materials of this file are passed over"));
  EXPECT_THAT(mesh.warnings, IsEmpty());
}

TEST(ObjReader, numbers_too_small_for_a_double_are_zero) {
  EXPECT_EQ(corner(read_text("v 1e-400 -1e-9999 4e-320\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), 0), (Vec3f{0, 0, 0}));
}

TEST(ObjReader, negative_indices_count_back_from_the_face) {
  const auto mesh = read_text(square + std::string("f -4 -3 -2\nv 9 9 9\nf -5 -4 -1\n"));
  EXPECT_EQ(corner(mesh, 0), (Vec3f{0, 0, 0}));
  EXPECT_EQ(corner(mesh, 2), (Vec3f{1, 1, 0}));
  EXPECT_EQ(corner(mesh, 3), (Vec3f{0, 0, 0}));
  EXPECT_EQ(corner(mesh, 5), (Vec3f{9, 9, 9}));
}

TEST(ObjReader, negative_uv_and_normal_indices_have_their_own_counts) {
  const auto mesh =
      read_text("vt .1 .2\nvn 0 0 1\n" + std::string(square) + "vn 1 0 1\nf -4/-1/-2 -3/-1/-2 -2/-1/-2\n");
  EXPECT_EQ(mesh.uvs[0], (Vec2f{.1f, .2f}));
  EXPECT_EQ(mesh.normals[0], (Vec3f{0, 0, 1}));
}

TEST(ObjReader, positive_index_may_name_a_later_vertex) {
  EXPECT_EQ(read_text("f 1 2 3\n" + std::string(square)).triangle_count(), 1u);
}

TEST(ObjReader, vertices_come_in_order_of_first_use_and_unused_ones_not_at_all) {
  const auto mesh = read_text(square + std::string("f 4 1 2\n"));
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{0, 1, 0}, Vec3f{0, 0, 0}, Vec3f{1, 0, 0}));
}

TEST(ObjReader, forms_of_a_corner) {
  const std::string head = square + std::string("vt 0 1\nvn 0 0 1\n");
  for (const char* face : {"f 1 2 3", "f 1/ 2/ 3/", "f 1// 2// 3//"}) {
    const auto mesh = read_text(head + face);
    EXPECT_THAT(mesh.normals, IsEmpty()) << face;
    EXPECT_THAT(mesh.uvs, IsEmpty()) << face;
  }
  for (const char* face : {"f 1/1 2/1 3/1", "f 1/1/ 2/1/ 3/1/"}) {
    const auto mesh = read_text(head + face);
    EXPECT_THAT(mesh.normals, IsEmpty()) << face;
    EXPECT_EQ(mesh.uvs.size(), 3u) << face;
  }
  const auto with_normals = read_text(head + "f 1//1 2//1 3//1");
  EXPECT_EQ(with_normals.normals.size(), 3u);
  EXPECT_THAT(with_normals.uvs, IsEmpty());
  const auto with_both = read_text(head + "f 1/1/1 2/1/1 3/1/1");
  EXPECT_EQ(with_both.normals.size(), 3u);
  EXPECT_EQ(with_both.uvs.size(), 3u);
}

TEST(ObjReader, position_with_two_uvs_or_normals_is_split) {
  const std::string head = square + std::string("vt 0 0\nvt 1 0\nvn 0 0 1\nvn 0 1 1\n");
  // 1/1/1 and 3/1/1 are shared; 1/2/1 and 3/1/2 are not.
  const auto mesh = read_text(head + "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/1/1\nf 1/2/1 3/1/2 4/1/1\n");
  EXPECT_THAT(mesh.indices, ElementsAre(0, 1, 2, 0, 2, 3, 4, 5, 3));
  EXPECT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.positions[4], mesh.positions[0]);
  EXPECT_EQ(mesh.uvs[4], (Vec2f{1, 0}));
  EXPECT_EQ(mesh.normals[4], mesh.normals[0]);
  EXPECT_EQ(mesh.uvs[5], mesh.uvs[2]);
  EXPECT_NE(mesh.normals[5], mesh.normals[2]);
}

TEST(ObjReader, many_splits_of_one_position_are_all_found_again) {
  std::ostringstream text;
  const int count = 5000;
  text << "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < count; ++i) text << "vt " << i << " 0\n";
  for (int repeat = 0; repeat < 2; ++repeat)
    for (int i = 1; i <= count; ++i) text << "f 1/" << i << " 2/1 3/1\n";
  const auto mesh = read_text(text.str());
  ASSERT_EQ(mesh.positions.size(), 2u + count);
  ASSERT_EQ(mesh.triangle_count(), 2u * count);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    ASSERT_EQ(mesh.uvs[mesh.indices[3 * t]].x, static_cast<float>(t % count));
}

TEST(ObjReader, uv_is_not_flipped_and_v_may_be_absent) {
  const auto mesh = read_text(square + std::string("vt 0.25 0.75\nvt 0.5\nvt 1 0 9\nf 1/1 2/2 3/3\n"));
  EXPECT_THAT(mesh.uvs, ElementsAre(Vec2f{0.25f, 0.75f}, Vec2f{0.5f, 0}, Vec2f{1, 0}));
}

TEST(ObjReader, weights_and_vertex_colours_are_ignored) {
  const auto mesh = read_text("v 0 0 0 0.5\nv 1 0 0 1 .5 .25\nv 0 1 0 2 1 .5 .25\nf 1 2 3\n");
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}));
}

TEST(ObjReader, forms_of_a_number) {
  const auto mesh = read_text("v +1 2. .5\nv -1e+2 2.E1 1e-50\nv 0 -.25 1e-2\nf 1 2 3\n");
  EXPECT_THAT(mesh.positions, ElementsAre(Vec3f{1, 2, .5f}, Vec3f{-100, 20, 0}, Vec3f{0, -.25f, .01f}));
}

TEST(ObjReader, line_ends_blanks_comments_and_continuations) {
  const auto expected = read_text(square + std::string("f 1 2 3\n"));
  const char* const same[] = {
      "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nf 1 2 3\r\n",
      "v 0 0 0\rv 1 0 0\rv 1 1 0\rf 1 2 3",
      "\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3",
      "  v\t0   0\v0 \n\n \t \n\tv 1 0 0\t\nv 1 1 0\n f\t1\t2  3  ",
      "# v 7 7 7\nv 0 0 0 # first\nv 1 0 0 #\nv 1 1 0\n#\nf 1 2 3 # 4\n#",
      "v 0 0 \\\n0\nv 1 \\\r\n 0 0\nv 1 1 0\\\n\nf 1 \\\n \\\n2 3\\\n",
      "# path C:\\dir\\\nv 0 0 0\nusemtl C:\\dir\\\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
      "mtllib a.mtl\no name\nv 0 0 0\ng vgroup f\nvp 1 2\nv 1 0 0\ns off\nv 1 1 0\nusemtl f\nf 1 2 3\nl 1",
  };
  for (const char* text : same) {
    const auto mesh = read_text(text);
    EXPECT_EQ(mesh.positions, expected.positions) << text;
    EXPECT_EQ(mesh.indices, expected.indices) << text;
  }
}

TEST(ObjReader, transform_moves_positions_and_turns_normals) {
  const auto world_from_object = translation({10, 0, 0}) * scaling({2, 1, 1});
  const auto mesh = read_text("v 0 0 0\nv 0 0 1\nv 1 -1 0\nvn 3 3 0\nf 1//1 2//1 3//1\n", world_from_object);
  EXPECT_EQ(mesh.positions[0], (Vec3f{10, 0, 0}));
  EXPECT_NEAR(mesh.normals[0].x, 1 / std::sqrt(5.0), 1e-7);
  EXPECT_NEAR(mesh.normals[0].y, 2 / std::sqrt(5.0), 1e-7);
  EXPECT_NEAR(dot(mesh.normals[0], corner(mesh, 1) - corner(mesh, 2)), 0, 1e-6)
      << "the normal stays a normal";
}

TEST(ObjReader, normals_of_any_finite_length_become_unit) {
  const auto mesh =
      read_text(square + std::string("vn 0 0 1e-200\nvn 0 1e200 1e200\nvn 1 0 2\nf 1//1 2//2 3//3\n"));
  for (const auto& n : mesh.normals) EXPECT_NEAR(length(n), 1, 1e-6);
  EXPECT_EQ(mesh.normals[0], (Vec3f{0, 0, 1}));
}

TEST(ObjReader, winding_follows_vertex_normals) {
  const std::string head = square + std::string("vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 -1\nvn 0 0 1\nvn 1 0 -.1\n");
  const auto turned = read_text(head + "f 1/1/1 2/2/1 3/3/1\n");
  EXPECT_LT(geometric_normal(turned, 0).z, 0);
  // What lies at a position stays there: uv = (x, y) in this file.
  for (std::size_t k = 0; k < turned.positions.size(); ++k)
    EXPECT_EQ(turned.uvs[k], (Vec2f{turned.positions[k].x, turned.positions[k].y}));
  EXPECT_GT(geometric_normal(read_text(head + "f 1//2 2//2 3//2\n"), 0).z, 0);
  EXPECT_GT(geometric_normal(read_text(head + "f 1//2 2//2 3//3\n"), 0).z, 0) << "the sum decides";
  EXPECT_GT(geometric_normal(read_text(head + "f 1//2 2//2 3//1\n"), 0).z, 0) << "the sum decides";
}

TEST(ObjReader, mirror_image_keeps_the_side_of_normals) {
  const std::string head = square + std::string("vn 0 0 1\n");
  const auto with = read_text(head + "f 1//1 2//1 3//1\n", scaling({-1, 1, 1}));
  EXPECT_EQ(with.normals[0], (Vec3f{0, 0, 1}));
  EXPECT_GT(geometric_normal(with, 0).z, 0);
  EXPECT_LT(geometric_normal(read_text(head + "f 1 2 3\n", scaling({-1, 1, 1})), 0).z, 0);
}

TEST(ObjReader, faces_without_normals_among_others_are_flat) {
  const auto mesh = read_text(square + std::string("vn 1 0 1\nf 1//1 2//1 3//1\nf 1//1 3//1 4\n"));
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.triangle_count(), 2u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(mesh.normals[mesh.indices[k]].x, 0.5f);
  for (std::size_t k = 3; k < 6; ++k) EXPECT_EQ(mesh.normals[mesh.indices[k]], (Vec3f{0, 0, 1}));
}

TEST(ObjReader, normals_that_no_face_uses_are_ignored) {
  const auto mesh = read_text("vn 0 0 0\n" + std::string(square) + "f 1 2 3\n");
  EXPECT_THAT(mesh.normals, IsEmpty());
}

TEST(ObjReader, corners_without_uv_among_others_get_zero) {
  const auto mesh = read_text(square + std::string("vt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4\n"));
  ASSERT_EQ(mesh.uvs.size(), 4u);
  EXPECT_EQ(mesh.uvs[mesh.indices[5]], (Vec2f{0, 0}));
}

TEST(ObjReader, uv_or_normal_zero_means_none) {
  const auto mesh = read_text(square + std::string("vt 1 1\nf 1/1/0 2/0/0 3/0\n"));
  EXPECT_THAT(mesh.normals, IsEmpty());
  EXPECT_THAT(mesh.uvs, ElementsAre(Vec2f{1, 1}, Vec2f{0, 0}, Vec2f{0, 0}));
}

TEST(ObjReader, triangles_without_area_are_dropped_and_counted) {
  const auto mesh =
      read_text(square + std::string("v 2 0 0\nf 1 2 3\nf 1 1 2\nf 1 2 5\nf 3 3 3\nf 1 2 3 3\n"));
  EXPECT_EQ(mesh.triangle_count(), 2u);
  EXPECT_EQ(mesh.dropped_triangles, 4u);
  // A height of 1e-3 on an edge of 1 stays, one of 1e-7 is rounding error, and small is not flat.
  EXPECT_EQ(read_text("v 0 0 0\nv 1 0 0\nv .5 1e-3 0\nv .5 1e-7 0\nf 1 2 3\nf 1 2 4\n").dropped_triangles,
            1u);
  EXPECT_EQ(read_text(square + std::string("f 1 2 3\n"), scaling({1e-9, 1e-9, 1e-9})).dropped_triangles, 0u);
}

TEST(ObjReader, zero_normal_of_a_dropped_triangle_is_no_error) {
  const auto mesh =
      read_text(square + std::string("vn 0 0 1\nvn 0 0 0\nf 1//1 2//1 3//1\nf 1//2 1//2 2//2\n"));
  EXPECT_EQ(mesh.triangle_count(), 1u);
  EXPECT_EQ(mesh.dropped_triangles, 1u);
}

TEST(ObjReaderError, file) {
  EXPECT_THROW(read_obj("no/such/mesh.obj", {}), InputError);
  EXPECT_THROW(read_obj(::testing::TempDir(), {}), InputError);
  try {
    read_obj("no/such/mesh.obj", {});
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no/such/mesh.obj: there is no such file"));
  }
  EXPECT_THAT(error_of_obj(""), AllOf(HasSubstr("file.obj"), HasSubstr("the file is empty")));
  EXPECT_THAT(error_of_obj("\n"), HasSubstr("no face"));
  EXPECT_THAT(error_of_obj(square), HasSubstr("no face"));
  EXPECT_THAT(error_of_obj("l 1 2\np 1\n"), HasSubstr("no face"));
}

TEST(ObjReaderError, numbers) {
  const auto at = [](const char* place) { return HasSubstr(std::string("numbers.obj:") + place); };
  EXPECT_THAT(error_of_obj("v 0 0 0\nv 1 abc 0\n"),
              AllOf(at("2:5: "), HasSubstr("vertex 2: 'abc' is not a number")));
  EXPECT_THAT(error_of_obj("v 0 nan 0\n"),
              AllOf(at("1:5: "), HasSubstr("vertex 1: 'nan' is not a finite number")));
  EXPECT_THAT(error_of_obj("v 0 0 -inf\n"), AllOf(at("1:7: "), HasSubstr("'-inf' is not a finite number")));
  EXPECT_THAT(error_of_obj("v 0 0 1e999\n"),
              AllOf(at("1:7: "), HasSubstr("vertex 1: '1e999' is out of range")));
  EXPECT_THAT(error_of_obj("v 0 0 1e39\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
              AllOf(at("1:3: "), HasSubstr("vertex 1: 1e+39 does not fit a float")));
  EXPECT_THAT(error_of_obj("v 0 0 1e38\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", scaling({1, 1, 100})),
              HasSubstr("does not fit a float"));
  for (const char* wrong : {"1.#IND", "1,5", "0x10", "1e", "--1", "+-1", "+", ".", "1.5f", "3.1+e2", "1/2"})
    EXPECT_THAT(error_of_obj(std::string("v 0 0 ") + wrong), AllOf(at("1:7: "), HasSubstr("is not a number")))
        << wrong;
  EXPECT_THAT(error_of_obj("v 0 0\nv 1 1 1\n"), AllOf(at("1:6: "), HasSubstr("vertex 1 has 2 numbers")));
  EXPECT_THAT(error_of_obj("v\n"), HasSubstr("vertex 1 has 0 numbers"));
  EXPECT_THAT(error_of_obj("vt\n"), HasSubstr("texture vertex 1 has 0 numbers"));
  EXPECT_THAT(error_of_obj("vt 0 1e300\n"), HasSubstr("texture vertex 1: 1e+300 does not fit a float"));
  EXPECT_THAT(error_of_obj("vn 0 1\n"), HasSubstr("normal 1 has 2 numbers"));
  EXPECT_THAT(error_of_obj("vn 0 1 x\n"), HasSubstr("normal 1: 'x' is not a number"));
  EXPECT_THAT(error_of_obj("v 1 2 3 v 4 5 6\n"), HasSubstr("'v' is not a number"));
  EXPECT_THAT(error_of_obj("v 0 \\\n0 x\n"), at("2:3: "));
}

TEST(ObjReaderError, indices) {
  const std::string head = square + std::string("vt 0 0\nvn 0 0 1\n");
  const auto at = [](const char* place) { return HasSubstr(std::string("indices.obj:") + place); };
  EXPECT_THAT(error_of_obj(head + "f 1 2 5\n"),
              AllOf(at("7:7: "), HasSubstr("v 5 does not exist"), HasSubstr("the file has 4 v statements")));
  EXPECT_THAT(
      error_of_obj(head + "f 1 2 3\nf 1/1 2/2 3/1\n"),
      AllOf(at("8:7: "), HasSubstr("vt 2 does not exist"), testing::EndsWith("the file has 1 vt statement")));
  EXPECT_THAT(error_of_obj(head + "f 1//1 \\\n 2//1 3//7\n"),
              AllOf(at("8:7: "), HasSubstr("vn 7 does not exist")));
  EXPECT_THAT(
      error_of_obj(square + std::string("f 1//1 2//1 3//1\n")),
      AllOf(at("5:3: "), HasSubstr("vn 1 does not exist"), HasSubstr("the file has 0 vn statements")));
  EXPECT_THAT(error_of_obj(head + "f 0 1 2\n"),
              AllOf(at("7:3: "), HasSubstr("index 0"), HasSubstr("count from 1")));
  EXPECT_THAT(error_of_obj(head + "f 1 2 -5\n"), AllOf(at("7:7: "), HasSubstr("'-5' is out of range")));
  EXPECT_THAT(error_of_obj("f -3 -2 -1\n" + head), HasSubstr("'-3' is out of range"));
  EXPECT_THAT(error_of_obj(head + "f 1 2 4294967295\n"), HasSubstr("out of range"));
  EXPECT_THAT(error_of_obj(head + "f 1 2 4294967294\n"), HasSubstr("v 4294967294 does not exist"));
  EXPECT_THAT(error_of_obj(head + "f 1 2 -9223372036854775808\n"), HasSubstr("out of range"));
  EXPECT_THAT(error_of_obj(head + "f 1 2 99999999999999999999999\n"), HasSubstr("out of range"));
  for (const char* wrong : {"x", "1.5", "1/x", "1/1/x", "1/1/1/1", "/1", "//", "1/1x", "+1"})
    EXPECT_THAT(error_of_obj(head + "f 1 2 " + wrong), AllOf(at("7:7: "), HasSubstr("is not a face vertex")))
        << wrong;
}

TEST(ObjReaderError, faces) {
  EXPECT_THAT(error_of_obj(square + std::string("f 1 2\n")),
              AllOf(HasSubstr("faces.obj:5:1: "), HasSubstr("a face of 2 vertices")));
  EXPECT_THAT(error_of_obj(square + std::string("f 1\n")), HasSubstr("a face of 1 vertex"));
  EXPECT_THAT(error_of_obj(square + std::string("f\n")), HasSubstr("a face of 0 vertices"));
  EXPECT_THAT(error_of_obj(square + std::string("f 1 1 2\n")),
              HasSubstr("faces.obj:5:1: no triangle has an area"));
  EXPECT_THAT(error_of_obj(square + std::string("f 1 2 3\n"), scaling({1, 0, 1})),
              HasSubstr("no triangle has an area"));
  EXPECT_THAT(error_of_obj(square + std::string("f 1 2 3\n"), scaling({1e10, 1e10, 1})),
              HasSubstr("faces.obj:5:1: a triangle too large"));
}

TEST(ObjReaderError, normals_without_direction) {
  const std::string head = square + std::string("vn 0 0 1\nvn 0 0 0\n");
  EXPECT_THAT(error_of_obj(head + "f 1//1 2//2 3//1\n"),
              AllOf(HasSubstr("direction.obj:6:1: "), HasSubstr("normal 2 has no direction")));
  EXPECT_THAT(error_of_obj(head + "f 1//1 2//1 3//1\n", scaling({1, 1, 0})),
              HasSubstr("normal 1 has no direction"));
}

TEST(ObjReaderError, garbage) {
  EXPECT_THAT(error_of_obj(std::string("f \0\x01\xff 2 3\n", 10)), HasSubstr("'?\?\?' is not a face vertex"));
  EXPECT_THAT(error_of_obj("f " + std::string(100000, 'x')),
              AllOf(HasSubstr("xxx...' is not"), testing::SizeIs(testing::Lt(1000u))));
  EXPECT_THAT(error_of_obj(std::string("\x7f"
                                       "ELF\0\0\0\\\\\r\n",
                                       12)),
              HasSubstr("no face"));
}

void expect_sound(const Mesh& mesh) {
  ASSERT_GT(mesh.triangle_count(), 0u);
  ASSERT_EQ(mesh.indices.size() % 3, 0u);
  ASSERT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  ASSERT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
  for (const auto index : mesh.indices) ASSERT_LT(index, mesh.positions.size());
  for (const auto& p : mesh.positions)
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  for (const auto& n : mesh.normals) ASSERT_NEAR(length(n), 1, 1e-5);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto ng = geometric_normal(mesh, t);
    ASSERT_GT(length_sq(ng), 0);
    if (mesh.normals.empty()) continue;
    Vec3f sum{0, 0, 0};
    for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) sum = sum + mesh.normals[mesh.indices[k]];
    ASSERT_GE(dot(ng, sum), -1e-5f * length(ng));
  }
}

/// Triangles that the `f` lines of a plain file ask for.
std::size_t count_triangles(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::size_t count = 0;
  for (std::string line, token; std::getline(stream, line);) {
    std::istringstream tokens(line);
    if (!(tokens >> token) || token != "f") continue;
    std::size_t corners = 0;
    while (tokens >> token) ++corners;
    count += corners - 2;
  }
  return count;
}

TEST(ObjReaderData, meshes_are_read_whole) {
  const auto folder = test::data_folder() / "meshes";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".obj") continue;
    SCOPED_TRACE(entry.path());
    const auto mesh = read_obj(entry.path(), {});
    expect_sound(mesh);
    EXPECT_EQ(mesh.triangle_count() + mesh.dropped_triangles, count_triangles(entry.path()));
  }
}

TEST(ObjReaderData, bad_files_give_a_mesh_or_an_error_with_a_line) {
  const auto folder = test::data_folder() / "badinput/obj";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path());
    try {
      expect_sound(read_obj(entry.path(), {}));
    } catch (const InputError& error) {
      const std::string place = entry.path().string() + (entry.file_size() > 0 ? ":[0-9]+:[0-9]+: " : ": ");
      EXPECT_THAT(error.what(), testing::ContainsRegex(place));
    }
  }
}

TEST(Rectangle, faces_plus_z_whatever_the_mirror) {
  const auto plain = make_rectangle({});
  ASSERT_EQ(plain.triangle_count(), 2u);
  EXPECT_EQ(geometric_normal(plain, 0), (Vec3f{0, 0, 4}));
  EXPECT_EQ(geometric_normal(plain, 1), (Vec3f{0, 0, 4}));
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& p = plain.positions[k];
    EXPECT_EQ(plain.uvs[k], (Vec2f{(p.x + 1) / 2, (p.y + 1) / 2}));
  }
  for (const auto& factors : {Vec3<double>{-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}})
    for (std::size_t t = 0; t < 2; ++t) EXPECT_GT(geometric_normal(make_rectangle(scaling(factors)), t).z, 0);
  EXPECT_LT(geometric_normal(make_rectangle(scaling({1, 1, -1})), 0).z, 0);
  EXPECT_EQ(make_rectangle(translation({5, 0, 0})).positions[0], (Vec3f{4, -1, 0}));
}

}  // namespace
}  // namespace etendue

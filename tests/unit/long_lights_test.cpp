// Lights that are much longer than wide, by the technique auto: what is small for its distance goes by
// length.
//
// Seen to fail when: only the area counts, of polygons, or of ellipses; polygons count as long whose square
// is twice as large.
#include "light/light.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

enum class Shape { rectangle, triangle, ellipse };

/// Flat at z = 0, shining downwards, around the origin.
Lights lamp(Shape shape, float length, float width) {
  Lights lights;
  if (shape == Shape::rectangle)
    lights.add<RectangleLights>({1, 1, 1}, "lamp", Vec3f{-length / 2, -width / 2, 0}, Vec3f{0, width, 0},
                                Vec3f{length, 0, 0});
  if (shape == Shape::ellipse)
    lights.add<DiskLights>({1, 1, 1}, "lamp",
                           Disk{{0, 0, 0}, {0, width / 2, 0}, {length / 2, 0, 0}, {0, 0, -1}});
  if (shape == Shape::triangle) {
    Mesh mesh;
    mesh.positions = {{-length / 2, -width / 2, 0}, {-length / 2, width / 2, 0}, {length / 2, 0, 0}};
    mesh.indices = {0, 1, 2};
    Geometry geometry;
    lights.add<MeshLights>({1, 1, 1}, "lamp", geometry, geometry.add_mesh(mesh, {0, 0}));
  }
  return lights;
}

/// Of the direction up, from a distance below the origin.
float density(const Lights& lights, float distance, LightTechnique technique) {
  const Vec3f up{0, 0, 1}, down{0, 0, -1};
  const Receiver<float> receiver{{0, 0, -distance}, up, up, lit_side::front};
  const LightHit<float> hit{{0, 0, 0}, down, up, 0, false, technique};
  return lights.pdf_solid_angle<float>(0, 1, receiver, hit, true);
}

/// Whether auto takes the technique solid_angle, not area.
bool is_by_solid_angle(const Lights& lights, float distance) {
  const float found = density(lights, distance, LightTechnique::automatic),
              solid_angle = density(lights, distance, LightTechnique::solid_angle);
  EXPECT_NE(solid_angle, density(lights, distance, LightTechnique::area)) << "they cannot be told apart";
  return found == solid_angle;
}

TEST(LongLights, GoByTheirLength) {
  for (const Shape shape : {Shape::rectangle, Shape::triangle, Shape::ellipse}) {
    const Lights tube = lamp(shape, 3, 0.002f);
    EXPECT_TRUE(is_by_solid_angle(tube, 1)) << int(shape);
    EXPECT_TRUE(is_by_solid_angle(tube, 6)) << int(shape);
    EXPECT_FALSE(is_by_solid_angle(tube, 12)) << int(shape);
  }
}

TEST(LongLights, AreThoseWhoseSquareIsFourTimesAsLarge) {
  // Four sides of a square as large as the first are 4.9 and 4.3 m, of one with the second's diagonal 7.1 m.
  for (const Shape shape : {Shape::rectangle, Shape::ellipse}) {
    EXPECT_FALSE(is_by_solid_angle(lamp(shape, 2.5f, 0.6f), 5.5f)) << int(shape);
    EXPECT_TRUE(is_by_solid_angle(lamp(shape, 2.5f, 0.2f), 5.5f)) << int(shape);
  }
}

}  // namespace
}  // namespace etendue

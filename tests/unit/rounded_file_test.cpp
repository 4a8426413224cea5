#include "geometry/rounded_file.h"

#include "geometry/obj_reader.h"
#include "support/memory_file.h"

#include <cmath>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace etendue {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A ring of 40 places of this radius around (far, 0, far / 3).
std::vector<Vec3<double>> ring(double far, double radius) {
  std::vector<Vec3<double>> places;
  for (int i = 0; i < 40; ++i)
    places.push_back({far + radius * std::cos(0.157 * i), radius * std::sin(0.157 * i), far / 3});
  return places;
}

std::vector<Vec3<double>> as_floats(std::vector<Vec3<double>> places) {
  for (Vec3<double>& p : places) p = {float(p.x), float(p.y), float(p.z)};
  return places;
}

TEST(RoundedFile, IsToldWithItsBound) {
  // Floats at 1e6 are 0.0625 apart.
  EXPECT_THAT(float_rounding_in_file(as_floats(ring(1e6, 1))),
              AllOf(HasSubstr("1e+06 from its origin"), HasSubstr("mesh 2.8 in size"),
                    HasSubstr("by up to 0.06, 2.1 % of the size")));
}

TEST(RoundedFile, IsNoneNearTheOriginOrOfALargeMesh) {
  EXPECT_EQ(float_rounding_in_file(as_floats(ring(1e6, 100))), "");
  EXPECT_EQ(float_rounding_in_file(as_floats(ring(10, 1e-3))), "");
  EXPECT_EQ(float_rounding_in_file(as_floats(ring(0, 1e-30))), "");
  EXPECT_EQ(float_rounding_in_file({}), "");
  EXPECT_EQ(float_rounding_in_file({{1e6, 0, 0}, {1e6, 0, 0}}), "");
}

TEST(RoundedFile, IsNoneWherePlacesAreFinerThanFloats) {
  EXPECT_EQ(float_rounding_in_file(ring(1e6, 1)), "");
}

TEST(RoundedFile, ShowsThroughDecimals) {
  std::string obj, exact;
  for (const Vec3<double>& p : as_floats(ring(3e6, 1)))
    obj += fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x, p.y, p.z);
  for (const Vec3<double>& p : ring(3e6, 1)) exact += fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x, p.y, p.z);
  const std::string face = "f 1 14 27\n";
  const auto warnings = [&](const std::string& text) {
    const test::MemoryFile file(text.data(), text.size());
    return read_obj(file.path(), translation({-3e6, 0, -1e6})).warnings;
  };
  EXPECT_THAT(warnings(obj + face), ElementsAre(HasSubstr("were rounded by up to 0.18, 6.3 % of the size")));
  EXPECT_THAT(warnings(exact + face), IsEmpty());
}

}  // namespace
}  // namespace etendue

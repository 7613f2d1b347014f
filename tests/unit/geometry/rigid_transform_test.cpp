// Proves that closest_rotation() gives the closest rotation of a matrix close to one, and rejects other matrices.
#include "blum/geometry/rigid_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"

namespace blum {
namespace {

Vec3d unit(const Vec3d& p) {
  return p / length(p);
}

/// A rotation around some axis.
Mat3 random_rotation(Random& random) {
  const auto any = [&] { return Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; };
  const Vec3d a = unit(any());
  const Vec3d p = any();
  const Vec3d b = unit(p - a * dot(p, a));
  return {{a, b, cross(a, b)}};
}

TEST(ClosestRotation, OfSinglePrecisionIsRigid) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    const Mat3 exact = random_rotation(random);
    Mat3 rounded = exact;
    for (Vec3d& column : rounded.columns) {
      for (std::size_t axis = 0; axis < 3; ++axis) column[axis] = static_cast<float>(column[axis]);
    }
    const RigidTransform found{closest_rotation(rounded), {}};
    EXPECT_LT(found.rotation_error(), 1e-14);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(length(found.rotation.columns[k] - exact.columns[k]), 1e-7);
  }
}

/// A rotation times a symmetric matrix has this rotation as the closest one.
TEST(ClosestRotation, AgreesWithThePolarDecomposition) {
  Random random(2);
  for (int round = 0; round < 200; ++round) {
    const Mat3 turn = random_rotation(random);
    const double x = random.uniform(-0.02, 0.02);
    const double y = random.uniform(-0.02, 0.02);
    const double z = random.uniform(-0.02, 0.02);
    const Mat3 stretch{{{1 + y, x, z}, {x, 1 + z, y}, {z, y, 1 + x}}};
    Mat3 product;
    for (std::size_t k = 0; k < 3; ++k) product.columns[k] = turn * stretch.columns[k];
    const Mat3 found = closest_rotation(product);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(length(found.columns[k] - turn.columns[k]), 1e-13);
  }
}

TEST(ClosestRotation, RejectsMatricesThatAreNotRotations) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Mat3& wrong : {Mat3{{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}}, Mat3{{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}},
                            Mat3{{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}}, Mat3{{{nan, 0, 0}, {0, 1, 0}, {0, 0, 1}}}}) {
    EXPECT_THROW(static_cast<void>(closest_rotation(wrong)), InvalidOption);
  }
}

}  // namespace
}  // namespace blum

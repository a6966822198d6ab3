// SPDX-License-Identifier: Apache-2.0
// Every map and Jacobian of rt/so3.hpp against its definition: at the identity, at 1e-8 tangents, at random and near
// pi.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "rt/so3.hpp"
#include "tests/support/property.hpp"

namespace lxd::rt_so3_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::check_property;
using test::uniform;

constexpr double kPi = std::numbers::pi;

// A rotation vector of the wanted length in a random direction.
Vector3d random_tangent(double length_rad) {
  const double z = uniform(-1, 1);
  const double azimuth = uniform(-kPi, kPi);
  const double r = std::sqrt(1 - z * z);
  return length_rad * Vector3d(r * std::cos(azimuth), r * std::sin(azimuth), z);
}

// Central difference of f: R^3 -> R^3 at zero, column by column. Step for an error of about 1e-10 in double.
template <typename F>
Matrix3d numeric_jacobian(F&& f) {
  constexpr double kStep = 1e-5;
  Matrix3d J;
  for (int i = 0; i < 3; ++i) J.col(i) = (f(kStep * Vector3d::Unit(i)) - f(-kStep * Vector3d::Unit(i))) / (2 * kStep);
  return J;
}

void expect_near(const Matrix3d& a, const Matrix3d& b, double tolerance, const Vector3d& at) {
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), tolerance) << "at " << at.transpose() << "\n" << a << "\nwanted\n" << b;
}

// The definition of the right Jacobian, without any formula of it.
Matrix3d numeric_right_jacobian(const Vector3d& theta) {
  const Matrix3d R = Exp(theta);
  return numeric_jacobian([&](const Vector3d& d) { return Log(R.transpose() * Exp(theta + d)); });
}

Matrix3d numeric_right_jacobian_inverse(const Vector3d& theta) {
  const Matrix3d R = Exp(theta);
  return numeric_jacobian([&](const Vector3d& d) { return Vector3d(Log(R * Exp(d))); });
}

// Lengths at which formulas change branch or lose digits.
std::vector<double> awkward_lengths_rad() {
  return {0.0, 1e-300, 1e-16, 1e-12, 1e-8, 1e-4, 0.0999999, 0.1, 0.1000001, 1.0, kPi / 2, 3.0, kPi - 1e-4};
}

TEST(So3, HatIsTheCrossProductAndVeeItsInverse) {
  check_property([] {
    const Vector3d a = random_tangent(2), b = random_tangent(3);
    RC_ASSERT((hat(a) * b - a.cross(b)).norm() < 1e-14);
    RC_ASSERT(vee(hat(a)) == a);
  });
}

TEST(So3, ExpAgreesWithTheAngleAxisOfEigen) {
  check_property([] {
    const Vector3d theta = random_tangent(uniform(1e-3, 3 * kPi));
    const Matrix3d wanted = Eigen::AngleAxisd(theta.norm(), theta.normalized()).toRotationMatrix();
    RC_ASSERT((Exp(theta) - wanted).norm() < 1e-14);
  });
}

TEST(So3, ExpIsARotationAtEveryAwkwardAngle) {
  for (const double length : awkward_lengths_rad()) {
    const Vector3d theta = length * Vector3d(1, -2, 2) / 3;
    const Matrix3d R = Exp(theta);
    expect_near(R.transpose() * R, Matrix3d::Identity(), 1e-14, theta);
    EXPECT_GT(R.determinant(), 0);
  }
}

TEST(So3, LogUndoesExpWithRelativePrecisionAtEveryAwkwardAngle) {
  for (const double length : awkward_lengths_rad()) {
    const Vector3d theta = length * Vector3d(1, -2, 2) / 3;
    EXPECT_LE((Log(Exp(theta)) - theta).norm(), 1e-14 * length) << length;
  }
}

TEST(So3, LogUndoesExpUpToPi) {
  check_property([] {
    const Vector3d theta = random_tangent(uniform(0, kPi - 1e-9));
    RC_ASSERT((Log(Exp(theta)) - theta).norm() < 1e-13);
  });
}

TEST(So3, LogOfATinyRotationKeepsItsDigits) {
  check_property([] {
    const Vector3d theta = random_tangent(1e-8);
    RC_ASSERT((Log(Exp(theta)) - theta).norm() < 1e-14 * theta.norm());
  });
}

TEST(So3, LogNearPiGivesTheRotationBack) {
  for (const double below_pi : {0.0, 1e-15, 1e-12, 1e-9, 1e-6}) {
    check_property([below_pi] {
      const Matrix3d R = Exp(random_tangent(kPi - below_pi));
      const Vector3d theta = Log(R);
      RC_ASSERT(std::abs(theta.norm() - (kPi - below_pi)) < 1e-14);
      RC_ASSERT((Exp(theta) - R).norm() < 1e-14);
    });
  }
}

TEST(So3, LogPastPiTurnsTheShorterWay) {
  const Vector3d theta = (kPi + 0.1) * Vector3d::UnitZ();
  EXPECT_LT((Log(Exp(theta)) - (0.1 - kPi) * Vector3d::UnitZ()).norm(), 1e-14);
}

TEST(So3, RightJacobianIsTheDerivativeOfExpAtAwkwardAngles) {
  for (const double length : awkward_lengths_rad()) {
    const Vector3d theta = length * Vector3d(1, -2, 2) / 3;
    expect_near(Jr(theta), numeric_right_jacobian(theta), 1e-9, theta);
  }
}

TEST(So3, RightJacobianIsTheDerivativeOfExpAtRandom) {
  check_property([] {
    const Vector3d theta = random_tangent(uniform(0, 2 * kPi));
    RC_ASSERT((Jr(theta) - numeric_right_jacobian(theta)).cwiseAbs().maxCoeff() < 1e-9);
  });
}

TEST(So3, InverseRightJacobianIsTheDerivativeOfLogAtAwkwardAngles) {
  for (const double length : awkward_lengths_rad()) {
    const Vector3d theta = length * Vector3d(1, -2, 2) / 3;
    expect_near(Jr_inverse(theta), numeric_right_jacobian_inverse(theta), 1e-9, theta);
  }
}

TEST(So3, InverseRightJacobianIsTheDerivativeOfLogAtRandom) {
  check_property([] {
    const Vector3d theta = random_tangent(uniform(0, kPi - 1e-3));
    RC_ASSERT((Jr_inverse(theta) - numeric_right_jacobian_inverse(theta)).cwiseAbs().maxCoeff() < 1e-9);
  });
}

TEST(So3, JacobianTimesItsInverseIsTheIdentityAlsoAtPi) {
  for (const double length : {0.0, 1e-8, 0.05, 0.1, 1.0, kPi, kPi + 0.5}) {
    check_property([length] {
      const Vector3d theta = random_tangent(length);
      RC_ASSERT((Jr(theta) * Jr_inverse(theta) - Matrix3d::Identity()).norm() < 1e-13);
    });
  }
}

TEST(So3, SeriesAndClosedFormMeetWhereTheyChange) {
  const double below = std::nextafter(so3_detail::kSeriesAngle_rad, 0.0), above = so3_detail::kSeriesAngle_rad;
  EXPECT_NEAR(so3_detail::t_minus_sin_over_cube(below), so3_detail::t_minus_sin_over_cube(above), 1e-13);
  EXPECT_NEAR(so3_detail::one_minus_half_cot_over_square(below), so3_detail::one_minus_half_cot_over_square(above),
              1e-13);
}

TEST(So3, OrthonormalizedTakesADriftedMatrixBackToTheGroup) {
  check_property([] {
    const Matrix3d R = Exp(random_tangent(uniform(0, kPi)));
    const Matrix3d drifted = R + 1e-8 * hat(random_tangent(1)) * hat(random_tangent(1));
    const Matrix3d back = orthonormalized(drifted);
    RC_ASSERT((back.transpose() * back - Matrix3d::Identity()).norm() < 1e-14);
    RC_ASSERT((back - R).norm() < 1e-7);
  });
}

}  // namespace
}  // namespace lxd::rt_so3_test

// SPDX-License-Identifier: Apache-2.0
// The factors' Jacobians against numeric differentiation, and the algebra of relative motions against sampled errors.
#include <random>

#include <gtest/gtest.h>

#include "backend/graph/factors.hpp"
#include "rt/so3.hpp"

namespace lxd::backend_graph_factors_test {
namespace {

constexpr double kStep = 1e-6;
constexpr double kTolerance = 2e-6;  // of central differences at factors that are about one

struct Chance {
  std::mt19937_64 engine{7};
  double number(double scale) { return std::uniform_real_distribution<double>(-scale, scale + 1e-300)(engine); }
  Eigen::Vector3d vector(double scale) { return {number(scale), number(scale), number(scale)}; }
  Vector6d tangent(double scale) {
    Vector6d tangent;
    tangent.head<3>() = vector(scale);
    tangent.tail<3>() = vector(scale);
    return tangent;
  }
  // Identity, next to it, and anywhere.
  Pose pose(int i) { return i == 0 ? Pose() : i == 1 ? box_plus({}, tangent(1e-9)) : box_plus({}, tangent(2.0)); }
  Matrix6d covariance() {
    const Matrix6d A = Matrix6d::NullaryExpr([&](Eigen::Index, Eigen::Index) { return number(1.0); });
    return A * A.transpose() + 0.1 * Matrix6d::Identity();
  }
};

// d f(x [+] d) / dd at zero.
template <int kRows, typename F>
Eigen::Matrix<double, kRows, 6> numeric(const Pose& x, F&& f) {
  Eigen::Matrix<double, kRows, 6> J;
  for (int i = 0; i < 6; ++i) {
    const Vector6d d = kStep * Vector6d::Unit(i);
    J.col(i) = (f(box_plus(x, d)) - f(box_plus(x, -d))) / (2 * kStep);
  }
  return J;
}

TEST(GraphFactors, RelativeFactorHasTheJacobiansOfItsResidual) {
  Chance chance;
  for (int i = 0; i < 30; ++i) {
    const Pose a = chance.pose(i % 3), b = chance.pose((i / 3) % 3);
    const RelativeFactor factor{box_plus(a.inverse() * b, chance.tangent(i % 2 == 0 ? 0.0 : 0.5)),
                                sqrt_information(chance.covariance())};
    Matrix6d by_a, by_b;
    factor.evaluate(a, b, &by_a, &by_b);
    const auto of_a = [&](const Pose& x) { return factor.evaluate(x, b, nullptr, nullptr); };
    const auto of_b = [&](const Pose& x) { return factor.evaluate(a, x, nullptr, nullptr); };
    EXPECT_LT((by_a - numeric<6>(a, of_a)).norm(), kTolerance * (1 + by_a.norm()));
    EXPECT_LT((by_b - numeric<6>(b, of_b)).norm(), kTolerance * (1 + by_b.norm()));
  }
}

TEST(GraphFactors, GnssFactorHasTheJacobiansOfItsResidual) {
  Chance chance;
  for (int i = 0; i < 30; ++i) {
    const Pose T = chance.pose(i % 3);
    const EarthAlignment alignment{chance.number(3), chance.vector(10), chance.number(0.2)};
    const GnssFactor factor{chance.vector(2), chance.vector(10), chance.vector(5), Eigen::Matrix3d::Identity() * 0.3,
                            Eigen::Matrix3d::Identity() * 0.7};
    const Eigen::Vector3d b = chance.vector(1);
    Eigen::Matrix<double, 3, 6> by_pose;
    Eigen::Matrix<double, 3, kAlignmentSize> by_alignment;
    factor.evaluate(T, alignment, b, &by_pose, &by_alignment);
    const auto of_pose = [&](const Pose& x) { return factor.evaluate(x, alignment, b, nullptr, nullptr); };
    EXPECT_LT((by_pose - numeric<3>(T, of_pose)).norm(), kTolerance * (1 + by_pose.norm()));
    const auto at = [&](int column, double step) {
      EarthAlignment moved = alignment;
      if (column == 0) moved.yaw_rad += step;
      if (column >= 1 && column <= 3) moved.offset_m[column - 1] += step;
      if (column == 4) moved.delay_s += step;
      return factor.evaluate(T, moved, b, nullptr, nullptr);
    };
    for (int column = 0; column < kAlignmentSize; ++column) {
      const Eigen::Vector3d difference = (at(column, kStep) - at(column, -kStep)) / (2 * kStep);
      EXPECT_LT((by_alignment.col(column) - difference).norm(), kTolerance * (1 + difference.norm())) << column;
    }
  }
}

TEST(GraphFactors, TiltAndAnchorHaveTheJacobiansOfTheirResiduals) {
  Chance chance;
  for (int i = 0; i < 30; ++i) {
    const Pose T = chance.pose(i % 3);
    const TiltFactor tilt{chance.vector(1).normalized(), 0.5};
    Eigen::Matrix<double, 3, 6> by_tilt;
    tilt.evaluate(T, &by_tilt);
    EXPECT_LT((by_tilt - numeric<3>(T, [&](const Pose& x) { return tilt.evaluate(x, nullptr); })).norm(), 1e-6);
    const AnchorFactor anchor{box_plus(T, chance.tangent(0.3)), Vector6d::Constant(0.5)};
    Matrix6d by_anchor;
    anchor.evaluate(T, &by_anchor);
    EXPECT_LT((by_anchor - numeric<6>(T, [&](const Pose& x) { return anchor.evaluate(x, nullptr); })).norm(), 1e-5);
  }
}

TEST(GraphFactors, AnAlignmentSeesTheMotionOfAnAntennaDuringItsDelay) {
  // given a body that drives along x at 10 m/s and a receiver whose fixes are 0.1 s old
  const GnssFactor factor{
      Eigen::Vector3d::Zero(), {10, 0, 0}, {4, 0, 0}, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity()};
  // when it is at 5 m, then the fix says 4 m and nothing is wrong
  const EarthAlignment late{0, {0, 0, 0}, 0.1};
  const Pose T_map_body{Eigen::Matrix3d::Identity(), {5, 0, 0}};
  EXPECT_LT((late.antenna_enu_m(T_map_body, factor.antenna_body_m, factor.antenna_velocity_mps) - factor.enu_m).norm(),
            1e-12);
}

// Sampled errors of T_a_b and T_b_c must have the covariance that the algebra says.
TEST(RelativeMotionAlgebra, CompositionAndInverseCarryCovariancesAsSampledErrorsDo) {
  Chance chance;
  const double scale = 1e-4;
  const RelativeMotion ab{chance.pose(2), scale * scale * chance.covariance()};
  const RelativeMotion bc{chance.pose(2), scale * scale * chance.covariance()};
  const Matrix6d L_ab = ab.covariance.llt().matrixL(), L_bc = bc.covariance.llt().matrixL();
  const RelativeMotion ac = ab * bc, ba = inverse_of(ab);
  std::normal_distribution<double> normal;
  Matrix6d of_ac = Matrix6d::Zero(), of_ba = Matrix6d::Zero();
  constexpr int kSamples = 20'000;
  const auto draw = [&] { return Vector6d::NullaryExpr([&](Eigen::Index) { return normal(chance.engine); }).eval(); };
  for (int i = 0; i < kSamples; ++i) {
    const Pose wrong_ab = box_plus(ab.T, L_ab * draw()), wrong_bc = box_plus(bc.T, L_bc * draw());
    const Vector6d e = box_minus(wrong_ab * wrong_bc, ac.T), f = box_minus(wrong_ab.inverse(), ba.T);
    of_ac += e * e.transpose() / kSamples;
    of_ba += f * f.transpose() / kSamples;
  }
  EXPECT_LT((of_ac - ac.covariance).norm(), 0.04 * ac.covariance.norm());
  EXPECT_LT((of_ba - ba.covariance).norm(), 0.04 * ba.covariance.norm());
  // and what was put together comes apart again
  const RelativeMotion again = between(ab, ac);
  EXPECT_LT((again.covariance - bc.covariance).norm(), 1e-9 * bc.covariance.norm());
  EXPECT_LT(box_minus(again.T, bc.T).norm(), 1e-12);
}

}  // namespace
}  // namespace lxd::backend_graph_factors_test

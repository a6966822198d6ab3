// SPDX-License-Identifier: Apache-2.0
// Visual reprojection residuals: the rows against numeric differentiation, the covariance, the sums, and what a lonely
// camera measures.
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "estimator/vision/reprojection.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/estimator_states.hpp"
#include "tests/support/property.hpp"

namespace lxd::estimator_reprojection_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using test::StateChance;

constexpr double kTau_s = 0.07;

MountedCamera mounted(StateChance& chance, const CameraIntrinsics& intrinsics) {
  return {CameraModel(intrinsics), {Exp(chance.vector(1)), chance.vector(0.3)}};
}

// A landmark 2 to 12 m before the camera at tau, seen beside where it is.
VisualObservation observation_of(StateChance& chance, const State& end, const MountedCamera& camera, double tau_s,
                                 double noise_px) {
  const PathKnot knot = SweepPath::knot(end, tau_s);
  const Pose T_world_camera = Pose{knot.R, knot.p} * camera.T_body_camera;
  Vector2d pixel(chance.uniform(20, 620), chance.uniform(20, 460));
  Vector3d bearing = Vector3d::UnitZ();
  EXPECT_TRUE(camera.model.unproject(pixel, bearing));
  const Vector3d p = T_world_camera * Vector3d(bearing * chance.uniform(2, 12));
  return {p, Matrix3d::Zero(), pixel + noise_px * Vector2d(chance.normal(), chance.normal())};
}

class Reprojection : public testing::TestWithParam<CameraIntrinsics (*)()> {};
INSTANTIATE_TEST_SUITE_P(Estimator, Reprojection,
                         testing::Values(&test::plain_camera, &test::radtan_camera, &test::fisheye_camera));

TEST_P(Reprojection, TheRowsAgreeWithNumericDifferentiation) {
  test::check_property(
      [] {
        StateChance chance(*rc::gen::arbitrary<unsigned>());
        const MountedCamera camera = mounted(chance, GetParam()());
        const State end = chance.state();
        const VisualObservation seen = observation_of(chance, end, camera, kTau_s, 3);
        VisualResidual out;
        RC_ASSERT(reproject(seen, SweepPath::knot(end, kTau_s), camera, 1, out));
        const auto numeric = test::numeric_jacobian<2>(end, [&](const State& x) {
          VisualResidual moved;
          EXPECT_TRUE(reproject(seen, SweepPath::knot(x, kTau_s), camera, 1, moved));
          return moved.r_px;
        });
        RC_ASSERT((numeric.leftCols<kLidarDim>() - out.rows).norm() < 1e-6 * out.rows.norm());
        RC_ASSERT(numeric.rightCols<kStateDim - kLidarDim>().norm() < 1e-6);
      },
      300);
}

TEST(EstimatorReprojection, TheImageAtTheEndSaysNothingOfTheRates) {
  StateChance chance(3);
  const MountedCamera camera = mounted(chance, test::radtan_camera());
  const State end = chance.state();
  VisualResidual out;
  ASSERT_TRUE(reproject(observation_of(chance, end, camera, 0, 0), SweepPath::knot(end, 0), camera, 1, out));
  EXPECT_EQ(out.rows.rightCols<6>().norm(), 0);
  EXPECT_LT(out.r_px.norm(), 1e-6);
}

// A landmark uncertain along the ray does not blur its image; one uncertain across does, by f sigma / z.
TEST(EstimatorReprojection, TheCovarianceIsTrackingPlusTheLandmarksProjected) {
  const MountedCamera camera{CameraModel(test::plain_camera()), {}};
  VisualObservation seen{{0, 0, 5}, Vector3d(0.04, 0, 1).asDiagonal(), {322, 241}};
  VisualResidual out;
  ASSERT_TRUE(reproject(seen, SweepPath::knot({}, 0), camera, 0.5, out));
  EXPECT_NEAR(out.covariance_px2(0, 0), 0.25 + std::pow(420 * 0.2 / 5, 2), 1e-9);
  EXPECT_NEAR(out.covariance_px2(1, 1), 0.25, 1e-9);
  EXPECT_NEAR(out.covariance_px2(0, 1), 0, 1e-9);
}

TEST(EstimatorReprojection, WhatCannotBeSeenIsRefused) {
  const MountedCamera camera{CameraModel(test::plain_camera()), {}};
  VisualResidual out;
  const PathKnot knot = SweepPath::knot({}, 0);
  EXPECT_FALSE(reproject({{0, 0, -5}, Matrix3d::Zero(), {1, 1}}, knot, camera, 1, out));
  EXPECT_FALSE(reproject({{0, std::nan(""), 5}, Matrix3d::Zero(), {1, 1}}, knot, camera, 1, out));
  EXPECT_FALSE(reproject({{0, 0, 5}, Matrix3d::Zero(), {std::nan(""), 1}}, knot, camera, 1, out));
  EXPECT_FALSE(reproject({{0, 0, 5}, Matrix3d::Constant(std::nan("")), {1, 1}}, knot, camera, 1, out));
}

// H^T W H and H^T W r, written out with dense matrices.
TEST(EstimatorReprojection, TheSumsAreThoseOfTheWhitenedRows) {
  StateChance chance(5);
  const MountedCamera camera = mounted(chance, test::radtan_camera());
  const State end = chance.state();
  std::vector<VisualResidual> residuals(3);
  LidarMatrix information = LidarMatrix::Zero();
  LidarVector gradient = LidarVector::Zero();
  for (VisualResidual& out : residuals) {
    VisualObservation seen = observation_of(chance, end, camera, kTau_s, 1);
    seen.covariance_m2 = chance.covariance<3>(0.05);
    ASSERT_TRUE(reproject(seen, SweepPath::knot(end, kTau_s), camera, 0.7, out));
    const Eigen::Matrix2d W = out.covariance_px2.inverse();
    information += out.rows.transpose() * W * out.rows;
    gradient += out.rows.transpose() * W * out.r_px;
  }
  constexpr double kWide = 1e6;  // no robust weight
  const NormalEquations sums = accumulate(residuals, 1, kWide);
  EXPECT_LT((sums.information - information).norm(), 1e-8 * information.norm());
  EXPECT_LT((sums.gradient - gradient).norm(), 1e-8 * gradient.norm());
  EXPECT_NEAR(sums.weight, (information.block<3, 3>(kPosition, kPosition).trace()), 1e-6 * sums.weight);
  NormalEquations twice = sums;
  twice += sums;
  EXPECT_LT((twice.information - 2 * information).norm(), 1e-8 * information.norm());
}

NormalEquations sums_of_landmarks(StateChance& chance, const State& end, const MountedCamera& camera, int count) {
  std::vector<VisualResidual> residuals(static_cast<std::size_t>(count));
  for (VisualResidual& out : residuals)
    if (!reproject(observation_of(chance, end, camera, kTau_s, 1), SweepPath::knot(end, kTau_s), camera, 0.7, out))
      ADD_FAILURE() << "a landmark is not seen";
  return accumulate(residuals, 1, 1e6);
}

Vector6d variance_of(double sigma_rad, double sigma_m) {
  Vector6d variance;
  variance << Vector3d::Constant(sigma_rad * sigma_rad), Vector3d::Constant(sigma_m * sigma_m);
  return variance;
}

// The image's own error as six more unknowns with a prior and the pose's columns: solved densely together with the
// state, the state's increment and its covariance are those of the sums without them.
TEST(EstimatorReprojection, TheImagesOwnErrorIsTakenOutAsIfItHadBeenEstimated) {
  StateChance chance(11);
  const MountedCamera camera = mounted(chance, test::radtan_camera());
  const State end = chance.state();
  const Vector6d variance = variance_of(0.004, 0.03);
  NormalEquations sums = sums_of_landmarks(chance, end, camera, 30);
  const LidarMatrix prior = 1e2 * LidarMatrix::Identity();
  Eigen::Matrix<double, kLidarDim + 6, kLidarDim + 6> both;
  both << sums.information + prior, sums.information.leftCols<6>(), sums.information.topRows<6>(),
      sums.information.topLeftCorner<6, 6>();
  both.diagonal().tail<6>() += variance.cwiseInverse();
  Eigen::Matrix<double, kLidarDim + 6, 1> gradient;
  gradient << sums.gradient, sums.gradient.head<6>();
  const LidarVector wanted = both.ldlt().solve(gradient).head<kLidarDim>();
  const LidarMatrix covariance = both.inverse().topLeftCorner<kLidarDim, kLidarDim>();

  marginalise(variance, sums);
  const LidarMatrix information = sums.information + prior;
  EXPECT_LT((information.ldlt().solve(sums.gradient) - wanted).norm(), 1e-8 * wanted.norm());
  EXPECT_LT((information.inverse() - covariance).norm(), 1e-8 * covariance.norm());
  EXPECT_NEAR(sums.weight, (sums.information.block<3, 3>(kPosition, kPosition).trace()), 1e-9 * sums.weight);
}

// One landmark or a hundred: of a path that is known to 3 cm an image tells no more than that.
TEST(EstimatorReprojection, ManyLandmarksTellNoMoreThanThePathAllows) {
  StateChance chance(12);
  const MountedCamera camera = mounted(chance, test::radtan_camera());
  const State end = chance.state();
  for (const int count : {1, 10, 100}) {
    NormalEquations sums = sums_of_landmarks(chance, end, camera, count);
    marginalise(variance_of(0.004, 0.03), sums);
    const Eigen::Matrix3d position = sums.information.block<3, 3>(kPosition, kPosition);
    EXPECT_LT(position.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff(), 1.001 / (0.03 * 0.03)) << count;
  }
}

TEST(EstimatorReprojection, OnAPathWithoutErrorNothingIsTakenOut) {
  StateChance chance(13);
  const MountedCamera camera = mounted(chance, test::radtan_camera());
  const State end = chance.state();
  const NormalEquations sums = sums_of_landmarks(chance, end, camera, 10);
  NormalEquations same = sums;
  marginalise(Vector6d::Zero(), same);
  EXPECT_EQ((same.information - sums.information).norm(), 0);
  EXPECT_EQ((same.gradient - sums.gradient).norm(), 0);
}

// Given a wrong pose, forty landmarks, half a pixel of noise and a quarter of them outliers; then Gauss-Newton with the
// robust sums comes back to it.
TEST(EstimatorReprojection, AnImageAloneFindsThePose) {
  StateChance chance(6);
  const MountedCamera camera = mounted(chance, test::radtan_camera());
  const State truth = chance.state();
  std::vector<VisualObservation> seen;
  for (int i = 0; i < 40; ++i) seen.push_back(observation_of(chance, truth, camera, kTau_s, i % 4 == 0 ? 60 : 0.5));
  State x = truth;
  x.R = x.R * Exp(Vector3d(0.03, -0.02, 0.04));
  x.p += Vector3d(0.1, -0.2, 0.1);
  std::vector<VisualResidual> residuals(seen.size());
  std::vector<float> scratch(seen.size());
  for (int i = 0; i < 15; ++i) {
    const PathKnot knot = SweepPath::knot(x, kTau_s);
    for (std::size_t k = 0; k < seen.size(); ++k) ASSERT_TRUE(reproject(seen[k], knot, camera, 0.5, residuals[k]));
    const NormalEquations sums = accumulate(residuals, visual_scale(residuals, scratch), kernel_sigmas(i));
    StateVector dx = StateVector::Zero();
    dx.head<6>() = -sums.information.topLeftCorner<6, 6>().ldlt().solve(sums.gradient.head<6>());
    x = boxplus(x, dx);
  }
  const StateVector error = boxminus(x, truth);
  EXPECT_LT(error.head<3>().norm(), 2e-3);
  EXPECT_LT((error.segment<3>(kPosition).norm()), 0.015);
}

TEST(EstimatorReprojection, TheScaleFollowsTheMedian) {
  StateChance chance(8);
  std::vector<VisualResidual> residuals(2001);
  std::vector<float> scratch(residuals.size());
  for (VisualResidual& r : residuals) {
    r.covariance_px2 = 0.25 * Eigen::Matrix2d::Identity();
    r.r_px = {chance.normal(1.5), chance.normal(1.5)};
  }
  EXPECT_NEAR(visual_scale(residuals, scratch), 3, 0.15);
  for (VisualResidual& r : residuals) r.r_px *= 0.1;
  EXPECT_EQ(visual_scale(residuals, scratch), 1);
  EXPECT_EQ(visual_scale({}, scratch), 1);
}

}  // namespace
}  // namespace lxd::estimator_reprojection_test

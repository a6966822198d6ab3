// SPDX-License-Identifier: Apache-2.0
// A mesh that knows its error is told so, and one that claims too little or too much is found out.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/synthetic_mesh.hpp"
#include "tools/evaluate/calibration.hpp"
#include "tools/evaluate/mesh_errors.hpp"

namespace lxd::evaluate_calibration_test {
namespace {

constexpr double kReach_m = 1;

// Gaussian errors whose standard deviation is `factor` times what is claimed; claims from 5 to 50 mm.
std::vector<ClaimedError> drawn(double factor, int count = 20'000) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> claim(0.005, 0.05);
  std::vector<ClaimedError> errors;
  for (int i = 0; i < count; ++i) {
    const double sigma_m = claim(random);
    errors.push_back({std::abs(factor * sigma_m * normal(random)), sigma_m});
  }
  return errors;
}

TEST(Calibration, OfHonestClaimsIsOne) {
  const MeshCalibration c = calibration(drawn(1), kReach_m);
  EXPECT_EQ(c.samples, 20'000U);
  EXPECT_EQ(c.beyond_reach, 0U);
  EXPECT_NEAR(c.mean_square, 1, 0.04);
  EXPECT_NEAR(c.median_square, kMedianOfChiSquared1, 0.02);
  EXPECT_NEAR(c.error_ratio, 1, 0.02);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(c.share_within[i], kGaussianWithin[i], 0.01) << i + 1 << " sigma";
  ASSERT_EQ(c.deciles.size(), 10U);
  EXPECT_TRUE(std::ranges::is_sorted(c.deciles, {}, &CalibrationBin::claimed_rms_m));
  for (std::size_t i = 0; i < c.deciles.size(); ++i) {
    EXPECT_EQ(c.deciles[i].samples, 2000U);
    EXPECT_NEAR(c.deciles[i].actual_rms_m / c.deciles[i].claimed_rms_m, 1, 0.06) << i;
  }
}

TEST(Calibration, OverconfidenceAndTimidityAreFoundOut) {
  const MeshCalibration bold = calibration(drawn(3), kReach_m);
  EXPECT_NEAR(bold.error_ratio, 3, 0.06);
  EXPECT_NEAR(bold.mean_square, 9, 0.4);
  EXPECT_NEAR(bold.share_within[0], 0.261, 0.01) << "a third of a sigma";
  const MeshCalibration timid = calibration(drawn(0.5), kReach_m);
  EXPECT_NEAR(timid.error_ratio, 0.5, 0.01);
  EXPECT_NEAR(timid.share_within[0], 0.954, 0.01);
}

// Every sample claims the same, and is off by as much as two of them.
TEST(Calibration, KnownAnswersByHand) {
  const MeshCalibration c = calibration({{0.02, 0.01}, {0.02, 0.01}, {0.02, 0.01}, {0.02, 0.01}}, kReach_m);
  EXPECT_DOUBLE_EQ(c.mean_square, 4);
  EXPECT_DOUBLE_EQ(c.median_square, 4);
  EXPECT_DOUBLE_EQ(c.share_within[0], 0);
  EXPECT_DOUBLE_EQ(c.share_within[1], 1);
  EXPECT_EQ(c.deciles.size(), 4U) << "fewer samples than deciles";
}

TEST(Calibration, SamplesOnNoSurfaceAreCountedAndDoNotDrownTheRest) {
  auto errors = drawn(1, 1000);
  for (int i = 0; i < 100; ++i) errors.push_back({kReach_m, 0.01});
  const MeshCalibration c = calibration(std::move(errors), kReach_m);
  EXPECT_EQ(c.samples, 1100U);
  EXPECT_EQ(c.beyond_reach, 100U);
  EXPECT_NEAR(c.mean_square, 1, 0.15);
  EXPECT_NEAR(c.share_within[2], kGaussianWithin[2] * 1000 / 1100, 0.01) << "they are outside of every sigma";
}

TEST(Calibration, NothingAndZeroClaimNothing) {
  EXPECT_EQ(calibration({}, kReach_m).samples, 0U);
  const MeshCalibration c = calibration({{0.01, 0}, {0.01, 0.01}}, kReach_m);
  EXPECT_EQ(c.samples, 1U);
  EXPECT_DOUBLE_EQ(c.mean_square, 1);
}

// Given a floor whose vertices are off by a centimetre each way at random and which says so, or says a fifth of it.
class BumpyFloor : public ::testing::Test {
 protected:
  static MeshCalibration measured(double claimed_sigma_m) {
    test::SyntheticMesh flat;
    flat.add_patch({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, 0.1F);
    TriangleMesh world, mesh;
    for (const MeshVertex& v : flat.vertices) world.vertices_m.push_back(v.position_m.cast<double>());
    world.faces.assign(flat.faces.begin(), flat.faces.end());
    mesh = world;
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0, kSigma_m);
    for (Eigen::Vector3d& v : mesh.vertices_m) v.z() += noise(random);
    mesh.variance_m2.assign(mesh.vertices_m.size(), claimed_sigma_m * claimed_sigma_m);
    MeshErrorOptions options;
    options.samples = 20'000;
    const Pose above{Eigen::Matrix3d::Identity(), {5, 5, 2}};
    return mesh_errors(mesh, world, std::span(&above, 1), options).calibration.value();
  }
  static constexpr double kSigma_m = 0.01;
  // Between the corners of a triangle their errors average: E[w0^2 + w1^2 + w2^2] = 1/2 over its area.
  static constexpr double kBetweenCorners = 0.7071;
};

TEST_F(BumpyFloor, ThatKnowsItsErrorIsCalibrated) {
  const MeshCalibration c = measured(kSigma_m * kBetweenCorners);
  EXPECT_NEAR(std::sqrt(c.mean_square), 1, 0.05);
  EXPECT_NEAR(c.deciles.front().actual_rms_m, kSigma_m * kBetweenCorners, 5e-4);
}

TEST_F(BumpyFloor, ThatClaimsAFifthIsFoundOut) {
  EXPECT_NEAR(std::sqrt(measured(0.2 * kSigma_m * kBetweenCorners).mean_square), 5, 0.25);
}

}  // namespace
}  // namespace lxd::evaluate_calibration_test

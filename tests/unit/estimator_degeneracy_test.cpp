// SPDX-License-Identifier: Apache-2.0
// What the geometry holds: a room holds all, a corridor not its axis, a plane three directions; and what is noise in
// the normals gives no information.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/ieskf.hpp"
#include "tests/support/estimator_states.hpp"

namespace lxd {
namespace {

using Eigen::Vector3d;
using test::StateChance;

constexpr double kNoise = 0.03 * 0.03;  // rad^2, of the normals
constexpr float kSigma_m = 0.02F;

// Points on the planes of a box of half edges `half_m` about the body, each with its plane's normal turned by an error.
class BoxRows {
 public:
  BoxRows(const Vector3d& half_m, double normal_error_rad, unsigned seed = 41)
      : half_m_(half_m), error_(normal_error_rad), chance_(seed) {}

  // Points on the two faces across `axis`.
  BoxRows& faces(int axis, int count) {
    for (int i = 0; i < count; ++i) {
      Vector3d p = half_m_.cwiseProduct(Vector3d(across(), across(), across()));
      const double side = i % 2 == 0 ? 1 : -1;
      p[axis] = side * half_m_[axis];
      const Vector3d n = Exp(chance_.vector(error_)) * Vector3d(-side * Vector3d::Unit(axis));
      const PathKnot knot = SweepPath::knot(State{}, chance_.uniform(0, 0.1));
      rows.push_back(point_to_surface({p, 0, kSigma_m * kSigma_m}, knot, {0, 0, n.cast<float>()}));
    }
    return *this;
  }
  [[nodiscard]] NormalEquations sums() const { return accumulate(rows, 1, 1e9); }

  std::vector<PointResidual> rows;

 private:
  double across() { return chance_.uniform(-1, 1); }
  Vector3d half_m_;
  double error_;
  StateChance chance_;
};

const Vector3d kRoom_m{5, 4, 1.5}, kCorridor_m{12, 2, 1.5};

BoxRows room(double normal_error_rad = 0.0) {
  BoxRows box(kRoom_m, normal_error_rad);
  box.faces(0, 800).faces(1, 800).faces(2, 800);
  return box;
}

BoxRows corridor(double normal_error_rad = 0.0) {
  BoxRows box(kCorridor_m, normal_error_rad);
  box.faces(1, 1200).faces(2, 1200);
  return box;
}

// Covariance of the pose before and after an update with these sums, the prior as after a sweep at 10 Hz.
struct Update {
  explicit Update(NormalEquations sums, double noise) {
    const Degeneracy degeneracy = find_degeneracy(sums, noise);
    discount(degeneracy, sums);
    StateMatrix P = StateMatrix::Zero();
    P.topLeftCorner<kLidarDim, kLidarDim>() = 1e-2 * LidarMatrix::Identity();
    Ieskf filter;
    filter.reset(State{}, P);
    filter.begin_update();
    dx = filter.iterate(sums);
    EXPECT_TRUE(filter.conclude());
    prior = P.topLeftCorner<6, 6>();
    posterior = filter.covariance().topLeftCorner<6, 6>();
  }
  Matrix6d prior, posterior;
  StateVector dx;
};

TEST(EstimatorDegeneracy, ARoomHoldsEveryDirection) {
  for (const double error : {0.0, 0.01, 0.03}) {
    const Degeneracy found = find_degeneracy(room(error).sums(), kNoise);
    EXPECT_EQ(found.directions, 0) << error;
    EXPECT_GT(found.trust.minCoeff(), 0.97) << error;
  }
}

TEST(EstimatorDegeneracy, ACorridorsAxisIsTheOneThatIsNotHeld) {
  for (const double error : {0.0, 0.01, 0.02}) {
    const Degeneracy found = find_degeneracy(corridor(error).sums(), kNoise);
    EXPECT_EQ(found.directions, 1) << error;
    EXPECT_GT(std::abs(found.axes(kPosition, 0)), 0.999) << error;  // along x
  }
}

// The noise is taken as the same along every axis, scaled by one lever for all turns. Where far points make that lever
// long, the turn about the line to them counts for little: a known limit, on the careful side.
TEST(EstimatorDegeneracy, InALongNarrowTunnelTheRollCountsAsNotHeldEither) {
  BoxRows tunnel(Vector3d(40, 1.5, 1.5), 0);
  const Degeneracy found = find_degeneracy(tunnel.faces(1, 1200).faces(2, 1200).sums(), kNoise);
  EXPECT_EQ(found.directions, 2);
  EXPECT_GT(std::abs(found.axes(kTheta, 1)), 0.999);
}

TEST(EstimatorDegeneracy, ASinglePlaneHoldsThreeDirections) {
  BoxRows floor(kRoom_m, 0);
  floor.faces(2, 1000);
  EXPECT_EQ(find_degeneracy(floor.sums(), kNoise).directions, 3);
}

TEST(EstimatorDegeneracy, WithoutResidualsNothingIsHeld) {
  NormalEquations nothing;
  const Degeneracy found = find_degeneracy(nothing, kNoise);
  EXPECT_EQ(found.directions, 6);
  discount(found, nothing);
  EXPECT_EQ(nothing.information.norm(), 0);
}

TEST(EstimatorDegeneracy, TheLeverTurnsRadiansIntoMetresSoThatTheRoomsSizeDoesNotMatter) {
  const Degeneracy small = find_degeneracy(room().sums(), kNoise);
  BoxRows hall(10 * kRoom_m, 0);
  const Degeneracy large = find_degeneracy(hall.faces(0, 800).faces(1, 800).faces(2, 800).sums(), kNoise);
  EXPECT_NEAR(large.lever_m / small.lever_m, 10, 1e-3);
  EXPECT_LT((large.sensitivity - small.sensitivity).norm(), 1e-3);
}

TEST(EstimatorDegeneracy, SensitivitiesSumToTheirTraces) {
  const Degeneracy found = find_degeneracy(room(0.01).sums(), kNoise);
  EXPECT_NEAR(found.sensitivity.sum(), 2, 1e-5);  // unit normals: 1 of the shifts, scaled to 1 of the turns
  for (int i = 1; i < 6; ++i) EXPECT_GE(found.sensitivity[i], found.sensitivity[i - 1]);
}

TEST(EstimatorDegeneracy, AlongACorridorTheCovarianceIsNotReduced) {
  // Given normals with as much error as the configuration allows for, which pretend to hold the axis ...
  const NormalEquations sums = corridor(0.02).sums();
  const Update plain(sums, 0.0), discounted(sums, kNoise);
  EXPECT_LT(plain.posterior(3, 3), 0.2 * plain.prior(3, 3));  // the pretence, without the discount
  // ... then the variance along it stays the prior's, and across it shrinks.
  EXPECT_NEAR(discounted.posterior(3, 3), discounted.prior(3, 3), 0.02 * discounted.prior(3, 3));
  EXPECT_LT(discounted.posterior(4, 4), 0.01 * discounted.prior(4, 4));
  EXPECT_LT(discounted.posterior(5, 5), 0.01 * discounted.prior(5, 5));
}

TEST(EstimatorDegeneracy, AlongACorridorTheStateDoesNotMove) {
  // Given residuals that the normals' errors would explain by a way of 0.1 m along the corridor ...
  BoxRows box = corridor(0.02);
  for (PointResidual& r : box.rows) r.r_m = 0.1 * r.row[kPosition];
  // ... then that way is taken without the discount, and not with it.
  EXPECT_LT(Update(box.sums(), 0).dx[kPosition], -0.08);
  EXPECT_LT(std::abs(Update(box.sums(), kNoise).dx[kPosition]), 0.005);
}

TEST(EstimatorDegeneracy, ARoomsCovarianceIsThatOfThePlainUpdateWithinThreePercent) {
  const NormalEquations sums = room(0.01).sums();
  const Update plain(sums, 0.0), discounted(sums, kNoise);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(discounted.posterior(i, i) / plain.posterior(i, i), 1, 0.03) << i;
}

// One direction's sensitivity below, at and above the noise: x is seen with the share s of a unit normal's square.
Degeneracy with_sensitivity(double s, double noise) {
  BoxRows box = room();
  for (PointResidual& r : box.rows) r.row[kPosition] = 0;
  NormalEquations sums = box.sums();
  const double others = sums.information(4, 4) + sums.information(5, 5);
  sums.weight = others;
  sums.information(kPosition, kPosition) = s * sums.weight;
  return find_degeneracy(sums, noise);
}

TEST(EstimatorDegeneracy, TrustFollowsTheSensitivityOverTheNoise) {
  struct Case {
    double sensitivity, trust;
    int directions;
  };
  for (const Case& c : {Case{0, 0, 1}, Case{0.5, 0, 1}, Case{1.0, 0, 1}, Case{1.25, 0.2, 1}, Case{1.99, 0.497, 1},
                        Case{2.01, 0.502, 0}, Case{10, 0.9, 0}, Case{100, 0.99, 0}}) {
    const Degeneracy found = with_sensitivity(c.sensitivity * kNoise, kNoise);
    EXPECT_NEAR(found.trust[0], c.trust, 2e-3) << c.sensitivity;
    EXPECT_EQ(found.directions, c.directions) << c.sensitivity;
  }
}

TEST(EstimatorDegeneracy, WithoutNoiseWhateverIsSeenIsTrustedAndWhatIsNotSeenIsNotHeld) {
  const Degeneracy seen = with_sensitivity(1e-6, 0);
  EXPECT_EQ(seen.directions, 0);
  EXPECT_GT(seen.trust.minCoeff(), 1 - 1e-5);
  const Degeneracy unseen = with_sensitivity(0, 0);
  EXPECT_TRUE(unseen.trust.allFinite()) << unseen.trust.transpose();
  EXPECT_EQ(unseen.directions, 1);
}

TEST(EstimatorDegeneracy, DiscountKeepsTheInformationSymmetricAndPositive) {
  for (const BoxRows& box : {room(0.02), corridor(0.02)}) {
    NormalEquations sums = box.sums();
    discount(find_degeneracy(sums, kNoise), sums);
    EXPECT_LT(test::asymmetry(sums.information), 1e-12 * sums.information.norm());
    EXPECT_GT(test::least_relative_eigenvalue(sums.information), -1e-13);
  }
}

// The share t of an axis' information is kept, and the same share of the gradient: a measurement with 1/t of the
// variance. With the root of the share it would measure 1/sqrt(t) as much, and below a quarter iterations would run
// away.
TEST(EstimatorDegeneracy, ADiscountedMeasurementStillMeasuresTheSame) {
  // Given a measured offset of 0.1 m of a pose that is held by half in x ...
  const Vector6d offset = 0.1 * Vector6d::Unit(kPosition);
  NormalEquations sums = room().sums();
  for (int i = 0; i < kLidarDim; ++i)
    for (int k = 0; k < kLidarDim; ++k)
      if ((i == kPosition) != (k == kPosition)) sums.information(i, k) = 0;
  sums.information.bottomRows<6>().setZero();
  sums.information.rightCols<6>().setZero();
  sums.information(kPosition, kPosition) = 2 * kNoise * sums.weight;
  sums.gradient.head<6>() = sums.information.topLeftCorner<6, 6>() * offset;
  discount(find_degeneracy(sums, kNoise), sums);
  // ... then without any prior the answer is that offset, whatever the share.
  const Vector6d solved = sums.information.topLeftCorner<6, 6>().llt().solve(sums.gradient.head<6>());
  EXPECT_NEAR(solved[kPosition], 0.1, 1e-6);
}

}  // namespace
}  // namespace lxd

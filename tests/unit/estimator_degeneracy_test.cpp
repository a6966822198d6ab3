// SPDX-License-Identifier: Apache-2.0
// What the geometry holds: a room holds all, a corridor not its axis, a plane three directions; and what is noise in
// the normals gives no information.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/ieskf.hpp"
#include "tests/support/estimator_states.hpp"

namespace lxd::estimator_degeneracy_test {
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
      motion_ += motion_of(knot, p) / (kSigma_m * kSigma_m);
    }
    return *this;
  }
  [[nodiscard]] NormalEquations sums() const {
    NormalEquations all = accumulate(rows, 1, 1e9);
    all.motion = motion_;
    return all;
  }

  std::vector<PointResidual> rows;

 private:
  double across() { return chance_.uniform(-1, 1); }
  Vector3d half_m_;
  double error_;
  StateChance chance_;
  LidarMatrix motion_ = LidarMatrix::Zero();
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

// A prior as after a sweep at 10 Hz: 0.1 of everything.
const LidarMatrix kRoot = 0.1 * LidarMatrix::Identity();

// Covariance of the pose before and after an update with these sums.
struct Update {
  explicit Update(NormalEquations sums, double noise, const LidarMatrix& root = kRoot) {
    discount(find_degeneracy(sums, root, noise), sums);
    StateMatrix P = StateMatrix::Zero();
    P.topLeftCorner<kLidarDim, kLidarDim>() = root * root.transpose();
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
    const Degeneracy found = find_degeneracy(room(error).sums(), kRoot, kNoise);
    EXPECT_EQ(found.directions, 0) << error;
    EXPECT_GT(found.trust.minCoeff(), 0.95) << error;
  }
}

TEST(EstimatorDegeneracy, ACorridorsAxisIsTheOneThatIsNotHeld) {
  for (const double error : {0.0, 0.01, 0.02}) {
    const Degeneracy found = find_degeneracy(corridor(error).sums(), kRoot, kNoise);
    EXPECT_EQ(found.directions, 1) << error;
    if (error > 0.01) continue;  // the axes then lie across
    // Position and speed along it are the two that are not believed.
    for (int i = 0; i < 2; ++i) {
      const LidarVector axis = found.axes.col(i).normalized();
      EXPECT_GT(std::hypot(axis[kPosition], axis[kVelocity]), 0.999) << error;
      EXPECT_EQ(found.trust[i], 0) << error;
    }
    EXPECT_GT(found.trust[2], 0.5) << error;
  }
}

// Points move with a roll by their distance to the axis, not by that to the sensor: far ones do not spoil it.
TEST(EstimatorDegeneracy, InALongNarrowTunnelTheRollIsHeld) {
  BoxRows tunnel(Vector3d(40, 1.5, 1.5), 0);
  const Degeneracy found = find_degeneracy(tunnel.faces(1, 1200).faces(2, 1200).sums(), kRoot, kNoise);
  EXPECT_EQ(found.directions, 1);
}

TEST(EstimatorDegeneracy, ASinglePlaneHoldsThreeDirections) {
  BoxRows floor(kRoom_m, 0);
  floor.faces(2, 1000);
  EXPECT_EQ(find_degeneracy(floor.sums(), kRoot, kNoise).directions, 3);
}

TEST(EstimatorDegeneracy, WithoutResidualsNothingIsHeld) {
  NormalEquations nothing;
  const Degeneracy found = find_degeneracy(nothing, kRoot, kNoise);
  EXPECT_EQ(found.directions, 6);
  discount(found, nothing);
  EXPECT_EQ(nothing.information.norm(), 0);
}

TEST(EstimatorDegeneracy, TheRoomsSizeDoesNotMatter) {
  BoxRows small(kRoom_m, 0), hall(10 * kRoom_m, 0);
  const Vector6d one =
      find_degeneracy(small.faces(0, 800).faces(1, 800).faces(2, 800).sums(), kRoot, kNoise).sensitivity;
  const Vector6d ten =
      find_degeneracy(hall.faces(0, 800).faces(1, 800).faces(2, 800).sums(), kRoot, kNoise).sensitivity;
  EXPECT_LT((ten - one).norm(), 1e-3 * one.norm());
}

// n n^T is never more than the identity: what is seen of a motion is at most all of it.
TEST(EstimatorDegeneracy, SensitivitiesAscendAndAreAtMostThoseOfSeeingAll) {
  for (const BoxRows& box : {room(0.01), corridor(0.01)}) {
    const Degeneracy found = find_degeneracy(box.sums(), kRoot, kNoise);
    for (int i = 1; i < 6; ++i) EXPECT_GE(found.sensitivity[i], found.sensitivity[i - 1]);
    EXPECT_GE(found.sensitivity[0], -1e-9);
    EXPECT_LE(found.sensitivity[5], 1 / kNoise);
  }
}

TEST(EstimatorDegeneracy, AxesAndDualsAreEachOthersInverse) {
  StateChance chance(42);
  const LidarMatrix root = chance.covariance<kLidarDim>(0.3).llt().matrixL();
  const NormalEquations sums = corridor(0.02).sums();
  const Degeneracy found = find_degeneracy(sums, root, kNoise);
  EXPECT_LT((found.axes.transpose() * found.duals - LidarMatrix::Identity()).norm(), 1e-9);
  // Independent in the prior and in the measurement.
  EXPECT_LT((found.duals.transpose() * root * root.transpose() * found.duals - LidarMatrix::Identity()).norm(), 1e-9);
  const LidarMatrix seen = found.axes.transpose() * sums.information * found.axes;
  EXPECT_LT((seen - LidarMatrix(found.information.asDiagonal())).norm(), 1e-9 * seen.norm());
}

// Where a heading is known to a degree and the tilt to a hundredth of one, errors of a floor's normals must not turn
// the heading by way of the tilt.
TEST(EstimatorDegeneracy, AFloorsErrorsDoNotTurnTheHeading) {
  LidarVector sigma = LidarVector::Constant(0.1);
  sigma.head<3>() << 1.7e-4, 1.7e-4, 1.7e-2;
  BoxRows floor(kRoom_m, 0.02);
  const NormalEquations sums = floor.faces(2, 2000).sums();
  const LidarMatrix root = sigma.asDiagonal();
  const Update plain(sums, 0.0, root), discounted(sums, kNoise, root);
  EXPECT_LT(plain.posterior(2, 2), 0.9 * plain.prior(2, 2));  // the pretence
  EXPECT_GT(discounted.posterior(2, 2), 0.98 * discounted.prior(2, 2));
}

TEST(EstimatorDegeneracy, AlongACorridorTheCovarianceIsNotReduced) {
  // Given normals with as much error as the configuration allows for, which pretend to hold the axis ...
  const NormalEquations sums = corridor(0.02).sums();
  const Update plain(sums, 0.0), discounted(sums, kNoise);
  EXPECT_LT(plain.posterior(3, 3), 0.2 * plain.prior(3, 3));  // the pretence, without the discount
  // ... then the variance along it stays the prior's, and across it shrinks.
  EXPECT_NEAR(discounted.posterior(3, 3), discounted.prior(3, 3), 0.1 * discounted.prior(3, 3));
  EXPECT_LT(discounted.posterior(4, 4), 0.01 * discounted.prior(4, 4));
  EXPECT_LT(discounted.posterior(5, 5), 0.01 * discounted.prior(5, 5));
}

TEST(EstimatorDegeneracy, AlongACorridorTheStateDoesNotMove) {
  // Given residuals that the normals' errors would explain by a way of 0.1 m along the corridor ...
  BoxRows box = corridor(0.02);
  for (PointResidual& r : box.rows) r.r_m = 0.1 * r.row[kPosition];
  // ... then that way is taken without the discount, and not with it.
  EXPECT_LT(Update(box.sums(), 0).dx[kPosition], -0.08);
  EXPECT_LT(std::abs(Update(box.sums(), kNoise).dx[kPosition]), 0.01);
}

TEST(EstimatorDegeneracy, ARoomsCovarianceIsThatOfThePlainUpdateWithinThreePercent) {
  const NormalEquations sums = room(0.01).sums();
  const Update plain(sums, 0.0), discounted(sums, kNoise);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(discounted.posterior(i, i) / plain.posterior(i, i), 1, 0.03) << i;
}

// All but one direction well seen, and x with so many times the noise.
Degeneracy with_information_over_noise(double ratio, double noise) {
  NormalEquations sums;
  sums.weight = 1e4;
  sums.motion = sums.weight * LidarMatrix::Identity();
  sums.information = sums.weight / 3 * LidarMatrix::Identity();
  sums.information(kPosition, kPosition) = ratio * noise * sums.weight;
  return find_degeneracy(sums, kRoot, noise);
}

TEST(EstimatorDegeneracy, TrustFollowsTheInformationOverTheNoise) {
  struct Case {
    double ratio, trust;
    int directions;
  };
  for (const Case& c : {Case{0, 0, 1}, Case{1, 0, 1}, Case{1.99, 0, 1}, Case{2.01, 0.005, 0}, Case{2.5, 0.2, 0},
                        Case{4, 0.5, 0}, Case{20, 0.9, 0}, Case{200, 0.99, 0}}) {
    const Degeneracy found = with_information_over_noise(c.ratio, kNoise);
    EXPECT_NEAR(found.trust[0], c.trust, 1e-4) << c.ratio;
    EXPECT_EQ(found.directions, c.directions) << c.ratio;
  }
}

TEST(EstimatorDegeneracy, WithoutNoiseWhateverIsSeenIsTrustedAndWhatIsNotSeenIsNotHeld) {
  BoxRows box = corridor();
  const Degeneracy unseen = find_degeneracy(box.sums(), kRoot, 0);
  EXPECT_TRUE(unseen.trust.allFinite()) << unseen.trust.transpose();
  EXPECT_EQ(unseen.directions, 1);
  const Degeneracy seen = find_degeneracy(box.faces(0, 40).sums(), kRoot, 0);
  EXPECT_EQ(seen.directions, 0);
  EXPECT_GT(seen.trust.minCoeff(), 1 - 1e-5);
}

TEST(EstimatorDegeneracy, DiscountKeepsTheInformationSymmetricAndPositive) {
  for (const BoxRows& box : {room(0.02), corridor(0.02)}) {
    NormalEquations sums = box.sums();
    discount(find_degeneracy(sums, kRoot, kNoise), sums);
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
  sums.information(kPosition, kPosition) = 4 * kNoise * sums.motion(kPosition, kPosition);
  sums.gradient.head<6>() = sums.information.topLeftCorner<6, 6>() * offset;
  discount(find_degeneracy(sums, kRoot, kNoise), sums);
  // ... then without any prior the answer is that offset, whatever the share.
  const Vector6d solved = sums.information.topLeftCorner<6, 6>().llt().solve(sums.gradient.head<6>());
  EXPECT_NEAR(solved[kPosition], 0.1, 1e-6);
}

}  // namespace
}  // namespace lxd::estimator_degeneracy_test

// SPDX-License-Identifier: Apache-2.0
// The filter with all its 18 dimensions on simulated inertial ways, poses measured now and then: its errors and its
// surprises are what its covariance says over many seeded runs, and both ways to update it agree.
#include <gtest/gtest.h>

#include "estimator/ieskf.hpp"
#include "tests/support/chi_square.hpp"
#include "tests/support/estimator_states.hpp"

namespace lxd::estimator_inertial_consistency_test {
namespace {

using Eigen::Vector3d;
using test::MeanBounds;
using test::StateChance;

constexpr ImuNoise kNoise{2e-3, 3e-2, 2e-4, 2e-3};
constexpr double kReading_s = 0.01, kTurnSigma_rad = 0.003, kShiftSigma_m = 0.02;
constexpr int kReadingsAPose = 10, kPoses = 20, kPoseDim = 6;

StateMatrix prior() {
  StateMatrix P = StateMatrix::Zero();
  const auto set = [&](int block, double sigma) { P.diagonal().segment<3>(block).setConstant(sigma * sigma); };
  set(kTheta, 0.01);
  set(kPosition, 0.02);
  set(kVelocity, 0.3);
  set(kGyroBias, 0.02);
  set(kAccelBias, 0.1);
  set(kGravity, 0.05);
  return P;
}

StateVector drawn(const StateMatrix& P, StateChance& chance) {
  StateVector dx;
  for (int i = 0; i < kStateDim; ++i) dx[i] = chance.normal(std::sqrt(P(i, i)));
  return dx;
}

Ieskf::Measurement<kPoseDim> pose_measurement(const State& x, const Pose& measured) {
  Ieskf::Measurement<kPoseDim> m;
  m.r.head<3>() = Log(measured.R.transpose() * x.R);
  m.r.tail<3>() = x.p - measured.p;
  m.H.block<3, 3>(0, kTheta) = Jr_inverse(m.r.head<3>());
  m.H.block<3, 3>(3, kPosition).setIdentity();
  m.R.diagonal() << Vector3d::Constant(kTurnSigma_rad * kTurnSigma_rad),
      Vector3d::Constant(kShiftSigma_m * kShiftSigma_m);
  return m;
}

// A body that turns with up to 2 rad/s and is pushed by several m/s^2; what is measured is right but for noise and
// biases that walk.
class InertialRun {
 public:
  InertialRun(unsigned seed, double believed_noise)
      : chance_(seed),
        believed_{believed_noise * kNoise.gyro_density, believed_noise * kNoise.accel_density,
                  believed_noise * kNoise.gyro_walk, believed_noise * kNoise.accel_walk} {
    State start = chance_.state();
    start.p.setZero();
    start.v = chance_.vector(1);
    filter.reset(start, prior());
    truth_ = boxplus(start, drawn(prior(), chance_));
  }
  void go(int readings) {
    const double root = std::sqrt(kReading_s);
    for (int i = 0; i < readings; ++i, t_s_ += kReading_s) {
      const InertialSpan m{kReading_s,
                           {0.3, std::cos(2 * t_s_), 2 * std::sin(3 * t_s_)},
                           {2 * std::sin(5 * t_s_), 1 + std::cos(3 * t_s_), 9.8}};
      truth_ = propagate(truth_, {kReading_s, m.rate_radps - chance_.vector(kNoise.gyro_density / root),
                                  m.force_mps2 - chance_.vector(kNoise.accel_density / root)});
      truth_.b_g += chance_.vector(kNoise.gyro_walk * root);
      truth_.b_a += chance_.vector(kNoise.accel_walk * root);
      filter.predict(m, believed_);
    }
  }
  Pose measured() { return {truth_.R * Exp(chance_.vector(kTurnSigma_rad)), truth_.p + chance_.vector(kShiftSigma_m)}; }
  [[nodiscard]] double squared_error() const {
    const StateVector e = boxminus(truth_, filter.state());
    return e.dot(filter.covariance().llt().solve(e));
  }
  Ieskf filter;

 private:
  StateChance chance_;
  ImuNoise believed_;
  State truth_;
  double t_s_ = 0;
};

// Means over seeded runs: of the errors at the end, and of the surprises of all poses.
struct Consistency {
  double nees = 0, nis = 0;
};

Consistency consistency(int runs, double believed_noise = 1) {
  Consistency sum;
  for (int i = 0; i < runs; ++i) {
    InertialRun run(2000 + i, believed_noise);
    for (int pose = 0; pose < kPoses; ++pose) {
      run.go(kReadingsAPose);
      const auto m = pose_measurement(run.filter.state(), run.measured());
      sum.nis += run.filter.surprise(m) / (runs * kPoses);
      run.filter.correct(m);
    }
    sum.nees += run.squared_error() / runs;
  }
  return sum;
}

TEST(EstimatorInertialConsistency, ErrorsAndSurprisesAreWhatTheCovarianceSays) {
  constexpr int kRuns = 200;
  const Consistency found = consistency(kRuns);
  RecordProperty("nees", std::to_string(found.nees));
  RecordProperty("nis", std::to_string(found.nis));
  const MeanBounds errors(kStateDim, kRuns), surprises(kPoseDim, kRuns * kPoses);
  EXPECT_GT(found.nees, errors.low);
  EXPECT_LT(found.nees, errors.high);
  EXPECT_GT(found.nis, surprises.low);
  EXPECT_LT(found.nis, surprises.high);
}

// The bounds can fail, those of the surprises, most of which is the poses' own noise, only to one side: an IMU that is
// believed four times as good, or a third as good as it is, is found out.
TEST(EstimatorInertialConsistency, AWrongBeliefInTheImuIsFoundOut) {
  constexpr int kRuns = 100;
  const MeanBounds errors(kStateDim, kRuns), surprises(kPoseDim, kRuns * kPoses);
  const Consistency sure = consistency(kRuns, 0.25), timid = consistency(kRuns, 3);
  EXPECT_GT(sure.nees, errors.high);
  EXPECT_LT(timid.nis, surprises.low);
  EXPECT_LT(timid.nees, errors.low);
}

TEST(EstimatorInertialConsistency, TheIteratedUpdateAgreesWithTheDirectOne) {
  InertialRun direct(77, 1), iterated(77, 1);
  direct.go(kReadingsAPose);
  iterated.go(kReadingsAPose);
  const Pose measured = direct.measured();
  const auto m = pose_measurement(direct.filter.state(), measured);
  direct.filter.correct(m);
  iterated.filter.begin_update();
  NormalEquations sums;
  const Eigen::Matrix<double, kPoseDim, kLidarDim> H = m.H.leftCols<kLidarDim>();
  const Eigen::Matrix<double, kPoseDim, kPoseDim> W = m.R.inverse();
  sums.information = H.transpose() * W * H;
  sums.gradient = H.transpose() * W * m.r;
  iterated.filter.iterate(sums);
  ASSERT_TRUE(iterated.filter.conclude());
  EXPECT_LT(boxminus(iterated.filter.state(), direct.filter.state()).norm(), 1e-6);
  EXPECT_LT((iterated.filter.covariance() - direct.filter.covariance()).norm(), 1e-6 * prior().norm());
}

TEST(EstimatorInertialConsistency, PosesTellBiasesAndGravity) {
  InertialRun run(78, 1);
  for (int pose = 0; pose < 100; ++pose) {
    run.go(kReadingsAPose);
    run.filter.correct(pose_measurement(run.filter.state(), run.measured()));
    ASSERT_EQ(test::asymmetry(run.filter.covariance()), 0);
  }
  EXPECT_GT(test::least_relative_eigenvalue(run.filter.covariance()), -1e-14);
  const StateMatrix P = run.filter.covariance();
  for (const int i : {9, 10, 11}) EXPECT_LT(std::sqrt(P(i, i)), 0.004) << i;  // of 0.02
  for (const int i : {12, 13, 14}) EXPECT_LT(std::sqrt(P(i, i)), 0.04) << i;  // of 0.1
}

TEST(EstimatorInertialConsistency, CalibrationPutBackIsWhatWasTaken) {
  InertialRun run(79, 1);
  run.go(kReadingsAPose);
  run.filter.correct(pose_measurement(run.filter.state(), run.measured()));
  const State x = run.filter.state();
  const StateMatrix P = run.filter.covariance();
  run.filter.replace(run.filter.calibration());
  // What it had in common with the rest is forgotten, nothing else.
  EXPECT_EQ(boxminus(run.filter.state(), x).norm(), 0);
  EXPECT_EQ((run.filter.covariance().block<9, 9>(9, 9)), (P.block<9, 9>(9, 9)));
  EXPECT_EQ((run.filter.covariance().block<9, 9>(0, 0)), (P.block<9, 9>(0, 0)));
  EXPECT_EQ((run.filter.covariance().block<9, 9>(0, 9).norm()), 0);
}

}  // namespace
}  // namespace lxd::estimator_inertial_consistency_test

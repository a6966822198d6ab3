// SPDX-License-Identifier: Apache-2.0
// By how much the IMU's readings are stamped later than the LiDAR's returns of the same instant. Each driver knows its
// sensor's clock to what the bytes take to arrive; a millisecond of difference is 2 mrad in a quick turn.
//
// Estimated beside the filter as a separate bias (Friedland, Treatment of bias in recursive filtering, 1969): the
// filter carries how its state errs by a second of delay, and each update says how much of its correction looks like
// that. No state more, and the same answer as with one. README.md, "The IMU's delay".
#pragma once

#include "estimator/delay_sums.hpp"
#include "estimator/inertial_propagation.hpp"
#include "estimator/sweep_path.hpp"

namespace lxd {

// What an update knew and did: informations of the prior and of the measurement, posterior covariance, correction
// (posterior [-] prior), and how many times surer of itself the measurement is than it should be.
struct UpdateRecord {
  const StateMatrix& prior_information;
  const LidarMatrix& measured_information;
  const StateMatrix& P;
  const StateVector& correction;
  double doubt;
  const DelaySums& skew;  // all zero: nothing can be learnt from this one
};

class ImuDelay {
 public:
  ImuDelay() = default;  // known exactly: none
  // At first: s, and how sure that is; 0: exactly.
  ImuDelay(double delay_s, double sigma_s) : delay_s_(delay_s), variance_s2_(sigma_s * sigma_s) {}

  // The state has nothing of the IMU in it (any more).
  void forget() { by_delay_.setZero(); }
  // The state was carried on with this transition.
  void predict(const StateMatrix& F, const InertialSpan& measured);
  // The state was corrected by something else: the error that is left, and how the correction would have differed.
  void correct(const StateMatrix& keep) { by_delay_ = (keep * by_delay_).eval(); }
  void update(const UpdateRecord& update);

  [[nodiscard]] double delay_s() const { return delay_s_; }  // an instant's reading is stamped so much later
  [[nodiscard]] double sigma_s() const;
  // d (true state [-] state) / d delay, of what the delay is wrong by.
  [[nodiscard]] const StateVector& state_by_delay() const { return by_delay_; }

 private:
  double delay_s_ = 0, variance_s2_ = 0;
  StateVector by_delay_ = StateVector::Zero();
};

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
#include "board/imu_hints.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace lxd {
namespace {

constexpr std::uint64_t kSamplesMin = 20;  // fewer say nothing
// Gravity is in every mean of the force; a carrier adds or takes a few m/s^2 for a while.
constexpr double kForceMin_mps2 = 7, kForceMax_mps2 = 14;
constexpr double kOneG_mps2 = 9.80665, kUnitTolerance = 0.3;
// Carriers of LiDARs turn by less than this but for moments; a walk read in degrees a second is beyond it.
constexpr double kQuick_radps = 17, kQuickShareMax = 0.05;
constexpr double kUpsideDown = -0.5;  // of the reference's z axis along up

bool is_about(double value, double wanted) { return std::abs(value - wanted) < kUnitTolerance * wanted; }

}  // namespace

void ImuHints::note(RigTime t, const ImuSample& sample) {
  if (!sample.accel_mps2.allFinite() || !sample.gyro_radps.allFinite()) return;
  if (samples_ == 0) first_ = t;
  last_ = t;
  ++samples_;
  force_sum_mps2_ += sample.accel_mps2.norm();
  quick_ += sample.gyro_radps.norm() > kQuick_radps;
}

void ImuHints::note(RigTime begin, RigTime end, const Odometry& odometry, const Star& star) {
  if (first_sweep_ == kNever) first_sweep_ = begin;
  last_sweep_ = end;
  if (!odometry.motion().inertial()) return;
  ++propagated_;
  delay_.note(odometry.imu_delay().delay_s(), odometry.imu_delay().sigma_s());
  mount_.note(found_mount(odometry.imu_mount(), odometry.motion().imu_unlike(), star));
  const State& x = odometry.state();
  up_z_ = -(star.T_body_reference.R.transpose() * (x.R.transpose() * x.g.normalized())).z();
}

std::vector<std::string> ImuHints::sentences() const {
  std::vector<std::string> sentences;
  for (std::string sentence :
       {of_time(), of_force(), of_rate(), of_up(), delay_.sentence("imu", "readings"), mount_.sentence()})
    if (!sentence.empty()) sentences.push_back(std::move(sentence));
  if (sentences.empty() && propagated_ == 0 && samples_ >= kSamplesMin && first_sweep_ != kNever)
    sentences.emplace_back("imu: it was heard and never used: its readings have holes, or nothing was tracked");
  return sentences;
}

std::string ImuHints::of_time() const {
  if (first_sweep_ == kNever) return {};
  if (samples_ == 0) return "imu: nothing was heard of it";
  if (first_ < last_sweep_ && last_ > first_sweep_) return {};
  return fmt::format(
      "imu: its readings are of {:.3f} to {:.3f} s, the LiDAR's sweeps of {:.3f} to {:.3f} s: wanted one clock, in "
      "seconds",
      first_.seconds(), last_.seconds(), first_sweep_.seconds(), last_sweep_.seconds());
}

std::string ImuHints::of_force() const {
  if (samples_ < kSamplesMin) return {};
  const double mean = force_sum_mps2_ / static_cast<double>(samples_);
  if (mean > kForceMin_mps2 && mean < kForceMax_mps2) return {};
  const char* const guess = is_about(mean, 1)                                         ? " (is it in g?)"
                            : is_about(mean, 1e3 * kOneG_mps2) || is_about(mean, 1e3) ? " (is it in thousandths?)"
                                                                                      : "";
  return fmt::format("imu: its force is {:.3g} m/s^2 on average, wanted about 9.8{}", mean, guess);
}

std::string ImuHints::of_rate() const {
  if (samples_ < kSamplesMin) return {};
  const double share = static_cast<double>(quick_) / static_cast<double>(samples_);
  if (share < kQuickShareMax) return {};
  return fmt::format("imu: it turns by more than {} rad/s in {:.0f} % of its readings (are they in degrees a second?)",
                     kQuick_radps, 100 * share);
}

std::string ImuHints::of_up() const {
  if (propagated_ == 0 || up_z_ > kUpsideDown) return {};
  return "imu: it feels the rig stand on its head (has the force the wrong sign, or is imu.T_reference_sensor the "
         "inverse "
         "of what is meant?)";
}

}  // namespace lxd

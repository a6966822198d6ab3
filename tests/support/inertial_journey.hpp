// SPDX-License-Identifier: Apache-2.0
// An odometry that watches a carrier on any way through a room, with its IMU and its wheels.
#pragma once

#include <functional>
#include <utility>

#include "tests/support/inertial_motion.hpp"
#include "tests/support/room_sweeps.hpp"

namespace lxd::test {

inline constexpr ImuNoise kJourneyNoise{1e-3, 1e-2, 1e-4, 1e-3};
inline const Eigen::Vector3d kJourneyGyroBias{0.01, -0.02, 0.015}, kJourneyAccelBias{0.05, -0.03, 0.02};

inline OdometrySetup inertial_setup(bool imu = true, bool wheel = false) {
  OdometrySetup setup = small_setup();
  if (imu) setup.imu = kJourneyNoise;
  if (wheel) setup.wheel = WheelModel{{}, 0.02, 0.02};
  return setup;
}

// The world's truth is that of the odometry's first pose.
class InertialJourney {
 public:
  static constexpr double kReading_s = 0.005, kWheel_s = 0.02;

  InertialJourney(InertialMotion its_way, const OdometrySetup& setup)
      : way(std::move(its_way)), odometry(setup), imu_(setup.imu), wheel_(setup.wheel) {
    sweeps.columns = 120;
  }

  const SweepOutcome& sweep() {
    const double end_s = begin_s + kSweepSpan.seconds();
    // One reading more than the sweep needs, that its end lies between two.
    for (; imu_ && reading_s_ < end_s + kReading_s; reading_s_ += kReading_s) give(reading_s_);
    for (; wheel_ && wheel_s_ <= end_s; wheel_s_ += kWheel_s) odometry->add(way.wheel(wheel_s_));
    const auto pose_at = [&](double offset_s) { return way.pose(begin_s + offset_s); };
    const std::int64_t begin_ns = RigTime::from_seconds(begin_s).ns();
    const Sweep& seen = lidar_is_silent ? sweeps.with_points({}, begin_ns) : sweeps.next_along(pose_at, begin_ns);
    const SweepOutcome& outcome = odometry->step(seen);
    begin_s = end_s;
    if (!begun_) T_world_truth_ = outcome.T_world_body * way.pose(end_s).inverse();
    begun_ = true;
    return outcome;
  }
  // At the end of the last sweep.
  [[nodiscard]] Pose truth() const { return T_world_truth_ * way.pose(begin_s); }
  [[nodiscard]] double shift_error_m() { return (odometry->state().p - truth().p).norm(); }
  [[nodiscard]] double turn_error_rad() { return Log(odometry->state().R.transpose() * truth().R).norm(); }

  InertialMotion way;
  RoomSweeps sweeps;
  OwnedOdometry odometry;
  double begin_s = 0.7;
  bool lidar_is_silent = false;
  // What becomes of a reading on its way; false: it is lost.
  std::function<bool(double t_s, InertialReading& reading)> fault = [](double, InertialReading&) { return true; };

 private:
  void give(double t_s) {
    InertialReading reading = way.reading(t_s);
    reading.rate_radps += kJourneyGyroBias + chance_.vector(kJourneyNoise.gyro_density / std::sqrt(kReading_s));
    reading.force_mps2 += kJourneyAccelBias + chance_.vector(kJourneyNoise.accel_density / std::sqrt(kReading_s));
    if (fault(t_s, reading)) odometry->add(reading);
  }

  StateChance chance_{5};
  bool imu_, wheel_, begun_ = false;
  double reading_s_ = 0.6, wheel_s_ = 0.6;
  Pose T_world_truth_;
};

}  // namespace lxd::test

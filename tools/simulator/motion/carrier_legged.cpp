// SPDX-License-Identifier: Apache-2.0
// A quadruped's trot: diagonal pairs of legs land in turn, and each landing is a sharp push through the whole body.
#include <cmath>
#include <numbers>

#include "tools/simulator/motion/carriers.hpp"
#include "tools/simulator/motion/path_fit.hpp"
#include "tools/simulator/motion/wander.hpp"
#include "tools/simulator/units.hpp"

namespace lxd::sim {
namespace {

constexpr double kLandings_hz = 2.8;  // a stride has two
constexpr double kLandingsWander = 0.05;
constexpr double kSharpness = 2;  // of a landing: its pulse is exp(k (cos - 1)), smooth at any order
constexpr double kLeggedBob_m = 0.009;
constexpr double kLeggedSway_m = 0.006;
constexpr double kPitch = 1.2 * kDegree_rad;
constexpr double kLeggedRoll = 1.8 * kDegree_rad;
constexpr double kYaw = 1.0 * kDegree_rad;
constexpr double kUneven = 0.8 * kDegree_rad;  // deviation, of the ground under the feet
constexpr double kLeggedFullGait_mps = 0.4;
constexpr double kGaitStart_s = 1.0;

class Trot {
 public:
  Trot(const Course& course, const Manner& manner, Random& random)
      : manner_(manner),
        moves_s_(course.moves_s),
        rhythm_(random, 0.05, 0.4),
        uneven_{Wander(random, 0.3, 2), Wander(random, 0.3, 2)} {}

  PathSample step(const CoursePoint& at) {
    phase_ += 2 * std::numbers::pi * kLandings_hz * (1 + kLandingsWander * rhythm_(at.t_s)) * Course::kStep_s;
    const double gait = eased(at.t_s, moves_s_, kGaitStart_s) * manner_.vigour *
                        std::tanh((at.speed_mps + turning(at)) / kLeggedFullGait_mps);
    const double stride = phase_ / 2;
    const double sides = std::sin(stride) + std::sin(3 * stride) / 4;  // left pair, right pair
    const Eigen::Quaterniond R = standing(at.up, at.heading_rad);
    const Eigen::Quaterniond trot = turned(
        gait * (kLeggedRoll * sides + kUneven * uneven_[0](at.t_s)),
        gait * (kPitch * (2 * landing(phase_ + 1) - 1) + kUneven * uneven_[1](at.t_s)), gait * kYaw * std::cos(stride));
    const Eigen::Vector3d bob_m(0, gait * kLeggedSway_m * std::sin(stride),
                                gait * kLeggedBob_m * (1 - 2 * landing(phase_)));
    return {at.t_s, at.p + manner_.height_m * Eigen::Vector3d::UnitZ() + R * bob_m, R * trot};
  }

 private:
  static double landing(double phase) { return std::exp(kSharpness * (std::cos(phase) - 1)); }

  // Feet step while it turns on the spot, too: as the speed of the feet about the body.
  double turning(const CoursePoint& at) {
    constexpr double kFeet_m = 0.3;
    const double rate = started_ ? std::abs(at.heading_rad - heading_) / Course::kStep_s : 0;
    heading_ = at.heading_rad;
    started_ = true;
    return kFeet_m * rate;
  }

  Manner manner_;
  double moves_s_;
  double phase_ = 0;
  double heading_ = 0;
  bool started_ = false;
  Wander rhythm_;
  std::array<Wander, 2> uneven_;
};

}  // namespace

Trajectory carry_legged(const Course& course, const Manner& manner, Random& random) {
  Trot trot(course, manner, random);
  std::vector<PathSample> samples;
  for (const CoursePoint& point : course.points) samples.push_back(trot.step(point));
  return interpolate(course.begin_s, Course::kStep_s, samples);
}

}  // namespace lxd::sim

// SPDX-License-Identifier: Apache-2.0
// A rig in the hands of someone who walks and looks around.
#include <cmath>
#include <numbers>

#include "tools/simulator/motion/carriers.hpp"
#include "tools/simulator/motion/path_fit.hpp"
#include "tools/simulator/motion/wander.hpp"
#include "tools/simulator/units.hpp"

namespace lxd::sim {
namespace {

constexpr double kSteps_hz = 1.9;                // steps a second; the body sways once every two
constexpr double kStepsWander = 0.04;            // of it
constexpr double kBob_m = 0.022;                 // up and down, each step
constexpr double kSway_m = 0.02;                 // to either side
constexpr double kSurge_m = 0.008;               // forth and back, each step
constexpr double kFullGait_mps = 0.9;            // above it the gait is as large as it gets
constexpr double kDrift_m = 0.015;               // of the arms, slow; deviation
constexpr double kNod = 0.8 * kDegree_rad;       // pitch of each step
constexpr double kRoll = 1.0 * kDegree_rad;      // of each two
constexpr double kShake = 1.6 * kDegree_rad;     // deviation, 0.4 .. 1.5 Hz
constexpr double kTremor = 0.15 * kDegree_rad;   // deviation, 4 .. 8 Hz
constexpr double kLookAside = 15 * kDegree_rad;  // deviation
constexpr double kLookUp = 4 * kDegree_rad;
constexpr double kStart_s = 1.5;  // in which arms and eyes begin to move

struct Shake {
  explicit Shake(Random& random) : slow(random, 0.4, 1.5), fast(random, 4, 8) {}
  double operator()(double t_s) const { return kShake * slow(t_s) + kTremor * fast(t_s); }
  Wander slow, fast;
};

class Walker {
 public:
  Walker(const Course& course, const Manner& manner, Random& random)
      : manner_(manner),
        moves_s_(course.moves_s),
        rhythm_(random, 0.05, 0.3),
        drift_{Wander(random, 0.2, 0.8), Wander(random, 0.2, 0.8), Wander(random, 0.2, 0.8)},
        shake_{Shake(random), Shake(random), Shake(random)},
        aside_(random, 0.03, 0.12),
        up_(random, 0.03, 0.12) {}

  PathSample step(const CoursePoint& at) {
    phase_ += 2 * std::numbers::pi * kSteps_hz * (1 + kStepsWander * rhythm_(at.t_s)) * Course::kStep_s;
    const double awake = eased(at.t_s, moves_s_, kStart_s) * manner_.vigour;
    const double gait = awake * std::tanh(at.speed_mps / kFullGait_mps);
    const double stride = phase_ / 2;
    const Eigen::Vector3d gait_m(kSurge_m * std::cos(phase_), kSway_m * std::sin(stride), kBob_m * std::sin(phase_));
    const Eigen::Vector3d drift_m = kDrift_m * Eigen::Vector3d(drift_[0](at.t_s), drift_[1](at.t_s), drift_[2](at.t_s));
    const Eigen::Quaterniond R = standing(Eigen::Vector3d::UnitZ(), at.heading_rad);
    const Eigen::Quaterniond look =
        turned(0, 0, awake * kLookAside * aside_(at.t_s)) * turned(0, awake * kLookUp * up_(at.t_s), 0);
    const Eigen::Quaterniond shake =
        turned(awake * shake_[0](at.t_s) + gait * kRoll * std::cos(stride),
               awake * shake_[1](at.t_s) + gait * kNod * std::cos(phase_), awake * shake_[2](at.t_s));
    return {at.t_s, at.p + manner_.height_m * Eigen::Vector3d::UnitZ() + R * (gait * gait_m + awake * drift_m),
            R * look * shake};
  }

 private:
  Manner manner_;
  double moves_s_;
  double phase_ = 0;
  Wander rhythm_;
  std::array<Wander, 3> drift_;
  std::array<Shake, 3> shake_;
  Wander aside_, up_;
};

}  // namespace

Trajectory carry_handheld(const Course& course, const Manner& manner, Random& random) {
  Walker walker(course, manner, random);
  std::vector<PathSample> samples;
  for (const CoursePoint& point : course.points) samples.push_back(walker.step(point));
  return interpolate(course.begin_s, Course::kStep_s, samples);
}

}  // namespace lxd::sim

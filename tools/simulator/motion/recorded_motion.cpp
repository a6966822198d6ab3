// SPDX-License-Identifier: Apache-2.0
// A recorded path as the motion of a scenario: smoothed, with an attitude where the file has none, from rest on
// request, and put where the scenario wants it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "tools/simulator/context.hpp"
#include "tools/simulator/motion/carriers.hpp"
#include "tools/simulator/motion/path_file.hpp"
#include "tools/simulator/motion/smooth.hpp"

namespace lxd::sim {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep_s = Course::kStep_s;
constexpr double kSpare_s = 0.3;      // beside the margin, for the curve's first and last knots
constexpr double kEaseIn_s = 1.5;     // from rest to the path's own speed, at least
constexpr double kEaseIn_s2pm = 1.0;  // times that speed: then it is at most at 2.2 m/s^2
constexpr double kRestMargin_s = 0.1;
constexpr std::ptrdiff_t kSpeedSpan = 4;  // poses to either side that tell the speed
constexpr double kGapMax_s = 1;
constexpr double kKnots_s = 0.05;

// Which of a format's content is motion and which is noise of who estimated the path (README.md has the residuals).
struct Cutoffs {
  double position_hz, rotation_hz;
};
Cutoffs cutoffs_of(const RecordedPath& path, const MotionConfig& config) {
  if (config.cutoff_hz > 0) return {config.cutoff_hz, config.cutoff_hz};
  if (path.format == "oxts") return {1.0, 2.5};
  if (path.format == "ntu_viral") return {2.0, 2.0};
  return {3.0, 4.0};
}

double speed_at(const RecordedPath& path, double t_s) {
  const auto after = std::ranges::lower_bound(path.samples, t_s, {}, &PathSample::t_s);
  const std::ptrdiff_t last = std::ssize(path.samples) - 1;
  const std::ptrdiff_t i = std::clamp<std::ptrdiff_t>(after - path.samples.begin(), kSpeedSpan, last - kSpeedSpan);
  const PathSample &a = path.samples[i - kSpeedSpan], &b = path.samples[i + kSpeedSpan];
  return (b.p - a.p).norm() / (b.t_s - a.t_s);
}

// Recording time to the path's: held, eased in, then as fast as it was.
class PathClock {
 public:
  PathClock(const MotionConfig& config, const RecordedPath& path)
      : start_s_(config.file_start_s),
        moving_(config.start_moving),
        moves_s_(config.rest_s + kRestMargin_s),
        ease_s_(std::max(kEaseIn_s, kEaseIn_s2pm * speed_at(path, config.file_start_s))) {}

  [[nodiscard]] double path_s(double t_s) const {
    if (moving_) return start_s_ + t_s;
    const double since = t_s - moves_s_;
    const double u = std::clamp(since / ease_s_, 0.0, 1.0);
    const double eased_s = ease_s_ * u * u * u * u * u * (7 + u * (-14 + u * (10 - 2.5 * u)));  // integral of eased()
    return start_s_ + eased_s + std::max(0.0, since - ease_s_);
  }

 private:
  double start_s_;
  bool moving_;
  double moves_s_;
  double ease_s_;
};

struct Span {
  double begin_s, end_s;  // of the path
};

Span used_span(const PathClock& clock, double duration_s) {
  const double margin_s = Course::kMargin_s + kSpare_s;
  return {clock.path_s(-margin_s), clock.path_s(duration_s + margin_s)};
}

Status check_span(const MotionConfig& config, const RecordedPath& path, const Span& span) {
  const double lasts_s = path.samples.back().t_s;
  if (span.begin_s < 0)
    return Error{fmt::format("motion.file_start_s: found {}, wanted at least {:.1f} to start moving",
                             config.file_start_s, config.file_start_s - span.begin_s)};
  if (span.end_s > lasts_s)
    return Error{fmt::format("{}: the path lasts {:.1f} s, wanted at least {:.1f} s for this duration from {} s on",
                             config.file.string(), lasts_s, span.end_s, config.file_start_s)};
  for (std::size_t i = 1; i < path.samples.size(); ++i) {
    const double from_s = path.samples[i - 1].t_s, to_s = path.samples[i].t_s;
    if (to_s - from_s > kGapMax_s && to_s > span.begin_s && from_s < span.end_s)
      return Error{fmt::format("{}: no pose between {:.1f} s and {:.1f} s of the path, wanted gaps of at most {} s",
                               config.file.string(), from_s, to_s, kGapMax_s)};
  }
  return success();
}

// The heading of what flies by position alone: it follows the course slowly, and stays when there is none.
std::vector<double> followed_headings(const Trajectory& way) {
  constexpr double kMoving_mps = 0.4, kFollow_s = 3, kTurnMax_radps = 0.6, kInertia_s = 0.5;
  constexpr std::ptrdiff_t kEase = 20;
  std::vector<double> headings;
  double heading = 0, rate = 0;
  for (double t = way.begin_s(); t <= way.end_s(); t += kStep_s) {
    const Vector3d v = way.at(t).v_world_mps;
    double wanted = 0;
    if (std::hypot(v.x(), v.y()) > kMoving_mps)
      wanted = std::remainder(std::atan2(v.y(), v.x()) - heading, 2 * std::numbers::pi) / kFollow_s;
    rate += (std::clamp(wanted, -kTurnMax_radps, kTurnMax_radps) - rate) * kStep_s / kInertia_s;
    heading += rate * kStep_s;
    headings.push_back(heading);
  }
  smooth(headings, kEase, 0.0);
  return headings;
}

// A multicopter's attitude from its acceleration, as that of the generated one.
Trajectory flown(const Trajectory& way) {
  std::vector<PathSample> samples;
  for (const double heading : followed_headings(way)) {
    const double t_s = way.begin_s() + static_cast<double>(samples.size()) * kStep_s;
    const MotionState state = way.at(t_s);
    const Vector3d thrust = state.a_world_mps2 + kGravity_mps2 * Vector3d::UnitZ();
    samples.push_back({t_s, state.T_world_body.p, standing(thrust.normalized(), heading)});
  }
  return interpolate(way.begin_s(), kStep_s, samples);
}

// From the path's coordinates to the world's: turned about the vertical alone.
Pose placing(const MotionConfig& config, const Pose& start) {
  if (!config.origin) return {};
  const auto& [x, y, z, yaw_rad] = *config.origin;
  const double now_rad = std::atan2(start.R(1, 0), start.R(0, 0));
  const Eigen::Matrix3d R = Eigen::AngleAxisd(yaw_rad - now_rad, Vector3d::UnitZ()).toRotationMatrix();
  return {R, Vector3d(x, y, z) - R * start.p};
}

}  // namespace

Result<Trajectory> recorded_motion(const MotionConfig& config, double duration_s) {
  Result<RecordedPath> path = load_path(config.file, config.format);
  if (!path) return path.error();
  if (config.level) level(*path);
  const PathClock clock(config, *path);
  if (const Status sound = check_span(config, *path, used_span(clock, duration_s)); !sound.ok()) return sound.error();
  const Cutoffs cutoffs = cutoffs_of(*path, config);
  Trajectory way = fit_path(path->samples, {kKnots_s, cutoffs.position_hz, cutoffs.rotation_hz}).motion;
  if (!path->oriented) way = flown(way);

  const double begin_s = -Course::kMargin_s - kSpare_s;
  const auto count = std::lround((duration_s - 2 * begin_s) / kStep_s) + 1;
  const Pose T_world_path = placing(config, way.pose(clock.path_s(0)));
  std::vector<PathSample> samples;
  for (long i = 0; i < count; ++i) {
    const double t_s = begin_s + static_cast<double>(i) * kStep_s;
    const Pose pose = T_world_path * way.pose(clock.path_s(t_s));
    samples.push_back({t_s, pose.p, pose.quaternion()});
  }
  return interpolate(begin_s, kStep_s, samples);
}

}  // namespace lxd::sim

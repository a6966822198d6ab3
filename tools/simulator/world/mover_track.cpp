// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/mover_track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lxd::sim {
namespace {

constexpr float kLoopGap_m = 1e-3F;

// The part of the ray within |x| <= half along one axis; keeps which axis was entered last.
struct Slab {
  float enter = -std::numeric_limits<float>::infinity();
  float leave = std::numeric_limits<float>::infinity();
  int axis = 0;

  void cut(int k, float origin, float direction, float half) {
    if (direction == 0) {
      if (std::abs(origin) > half) leave = enter = std::numeric_limits<float>::quiet_NaN();
      return;
    }
    const float a = (-half - origin) / direction;
    const float b = (half - origin) / direction;
    if (const float near = std::min(a, b); near > enter) {
      enter = near;
      axis = k;
    }
    leave = std::min(leave, std::max(a, b));
  }
};

}  // namespace

Eigen::Vector3f MoverPose::to_local(const Eigen::Vector3f& w) const {
  return {heading.x() * w.x() + heading.y() * w.y(), heading.x() * w.y() - heading.y() * w.x(), w.z()};
}

Eigen::Vector3f MoverPose::to_world(const Eigen::Vector3f& l) const {
  return {heading.x() * l.x() - heading.y() * l.y(), heading.y() * l.x() + heading.x() * l.y(), l.z()};
}

MoverTrack::MoverTrack(const Mover& mover) : mover_(mover), arc_m_{0} {
  for (std::size_t i = 1; i < mover.way_m.size(); ++i)
    arc_m_.push_back(arc_m_.back() + (mover.way_m[i] - mover.way_m[i - 1]).cast<double>().norm());
  loop_ = mover.way_m.size() > 2 && (mover.way_m.front() - mover.way_m.back()).norm() < kLoopGap_m;
}

MoverPose MoverTrack::at(float t_s) const {
  const double length = arc_m_.back();
  if (length <= 0) return {mover_.way_m.front(), Eigen::Vector2f::UnitX()};
  double s = double{mover_.start_m} + double{mover_.speed_mps} * double{t_s};
  const double period = loop_ ? length : 2 * length;
  s -= period * std::floor(s / period);
  const bool back = s > length;
  if (back) s = period - s;
  const auto above = std::ranges::upper_bound(arc_m_, s) - arc_m_.begin();
  const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above, 1, std::ssize(arc_m_) - 1));
  const Eigen::Vector3f step = mover_.way_m[i] - mover_.way_m[i - 1];
  const double part = (s - arc_m_[i - 1]) / std::max(arc_m_[i] - arc_m_[i - 1], 1e-9);
  Eigen::Vector2f heading = step.head<2>();
  heading = heading.norm() > 0 ? Eigen::Vector2f(heading.normalized()) : Eigen::Vector2f::UnitX();
  return {mover_.way_m[i - 1] + static_cast<float>(part) * step, back ? Eigen::Vector2f(-heading) : heading};
}

std::optional<BoxHit> MoverTrack::entered_by(const Eigen::Vector3f& origin_m, const Eigen::Vector3f& direction,
                                             float t_s) const {
  const MoverPose pose = at(t_s);
  const Eigen::Vector3f origin = pose.to_local(origin_m - pose.centre_m);
  const Eigen::Vector3f along = pose.to_local(direction);
  Slab slab;
  for (int k = 0; k < 3; ++k) slab.cut(k, origin[k], along[k], mover_.half_m[k]);
  if (!(slab.enter <= slab.leave) || !(slab.enter > 0)) return std::nullopt;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  normal[slab.axis] = along[slab.axis] > 0 ? -1.0F : 1.0F;
  return BoxHit{slab.enter, pose.to_world(normal), origin + slab.enter * along, normal};
}

}  // namespace lxd::sim

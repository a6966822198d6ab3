// SPDX-License-Identifier: Apache-2.0
// The frames that features are anchored in: the poses of the last few images that were worth keeping (paper: the active
// tracking frame pool of maximum size N). They are the filter's estimates of their time and no part of its state.
// Real-time thread.
#pragma once

#include <array>
#include <cstdint>

#include "rt/pose.hpp"
#include "rt/so3.hpp"
#include "rt/time.hpp"

namespace lxd {

inline constexpr std::uint32_t kWindowFrames = 10;

struct WindowFrame {
  Pose T_world_camera;
  RigTime stamp;
};

class FeatureWindow {
 public:
  void clear() { begin_ = end_ = 0; }

  // Frames are numbered in order; those from oldest() to newest() are there.
  [[nodiscard]] bool empty() const { return begin_ == end_; }
  [[nodiscard]] bool full() const { return end_ - begin_ == kWindowFrames; }
  [[nodiscard]] std::uint32_t oldest() const { return begin_; }
  [[nodiscard]] std::uint32_t newest() const { return end_ - 1; }
  [[nodiscard]] const WindowFrame& operator[](std::uint32_t number) const { return frames_[number % kWindowFrames]; }

  // Precondition: not full.
  void push(const WindowFrame& frame) { frames_[end_++ % kWindowFrames] = frame; }
  // Precondition: not empty.
  void pop_oldest() { ++begin_; }

  // In all frames the camera looked elsewhere by R_camera_turned than was believed.
  void turn_cameras(const Eigen::Matrix3d& R_camera_turned) {
    for (WindowFrame& frame : frames_) frame.T_world_camera.R *= R_camera_turned;
  }

  // Is the camera far enough from the newest frame for another, or is that old?
  [[nodiscard]] bool wants(const WindowFrame& frame) const {
    if (empty()) return true;
    const WindowFrame& last = (*this)[newest()];
    return (frame.T_world_camera.p - last.T_world_camera.p).norm() > kStep_m ||
           Log(last.T_world_camera.R.transpose() * frame.T_world_camera.R).norm() > kTurn_rad ||
           frame.stamp - last.stamp > kWait;
  }

 private:
  static constexpr double kStep_m = 0.05, kTurn_rad = 0.05;
  static constexpr Duration kWait = Duration::from_ns(kNanosPerSecond / 2);

  std::array<WindowFrame, kWindowFrames> frames_;
  std::uint32_t begin_ = 0, end_ = 0;
};

}  // namespace lxd

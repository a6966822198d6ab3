// SPDX-License-Identifier: Apache-2.0
// The newest readings of the IMU, and the spans of constant rate and force between two times that they make.
// Real-time thread only; memory from the arena.
#pragma once

#include <cstdint>
#include <span>

#include "estimator/inertial_propagation.hpp"
#include "rt/arena.hpp"
#include "rt/time.hpp"

namespace lxd {

// A sample of the IMU on the rig's clock, in the body's frame (which is the IMU's whenever it is in use).
struct InertialReading {
  RigTime t;
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();  // specific force: +g upwards at rest
};

struct InertialCounts {
  std::uint64_t not_finite = 0, late = 0, stuck = 0;
};

class ImuHistory {
 public:
  static constexpr std::uint32_t kReadings = 2048;     // 1 s at 2 kHz, of which a sweep needs a tenth
  static constexpr std::uint32_t kSpansMax = 1024;     // between two times
  static constexpr std::uint32_t kStuckReadings = 20;  // bit for bit the same, in a row: the sensor hangs

  explicit ImuHistory(Arena& arena);

  // Readings are of an instant so much before their stamps: all times below but those of add() and newest() are
  // instants.
  void set_delay(Duration delay) { delay_ = delay; }

  // Readings that are no numbers, not after the last one, or the same over and over are counted and left out.
  void add(const InertialReading& reading) noexcept;
  void clear() { count_ = 0; }

  // Are there readings throughout [from, to], none farther from the next than `gap_max`? After the last one as much is
  // granted: its values are held.
  [[nodiscard]] bool covers(RigTime from, RigTime to, Duration gap_max) const noexcept;

  // In the order of time, their sum is `to - from`. Each is the mean of the readings at its two ends; at `from` and
  // `to` these are interpolated, and held beyond the first and the last. Valid until the next call. Precondition:
  // covers(from, to, ...).
  std::span<const InertialSpan> spans(RigTime from, RigTime to) noexcept;

  // Mean over the readings in [from, to], and how far they scatter; nothing (count 0) without any.
  struct Mean {
    std::uint32_t count = 0;
    Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero(), force_mps2 = Eigen::Vector3d::Zero();
    double rate_sigma = 0, force_sigma = 0;  // root mean square of an axis about the mean
  };
  [[nodiscard]] Mean mean(RigTime from, RigTime to) const noexcept;

  // Interpolated, and held beyond the first and the last. Precondition: size() > 0.
  [[nodiscard]] InertialReading value_at(RigTime t) const noexcept;

  [[nodiscard]] std::uint32_t size() const { return count_; }
  [[nodiscard]] const InertialReading& newest() const { return at(count_ - 1); }
  [[nodiscard]] const InertialCounts& counts() const { return counts_; }

 private:
  [[nodiscard]] const InertialReading& at(std::uint32_t i) const { return readings_[(first_ + i) % kReadings]; }
  // Number of readings stamped at or before t.
  [[nodiscard]] std::uint32_t until(RigTime t) const noexcept;
  // What value_at() says, of a stamp.
  [[nodiscard]] InertialReading stamped(RigTime stamp) const noexcept;

  std::span<InertialReading> readings_;
  std::span<InertialSpan> spans_;
  std::uint32_t first_ = 0, count_ = 0;
  std::uint32_t repeats_ = 0;
  Duration delay_;
  InertialCounts counts_;
};

}  // namespace lxd

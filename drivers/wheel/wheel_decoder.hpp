// SPDX-License-Identifier: Apache-2.0
// CAN frames in, forward speed and yaw rate of the wheel frame out: a pure function of frames and their receive times.
// The wheel frame: x forward, z up, between the wheels that are used (the rear ones, where a vehicle has four).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "drivers/replay/rejections.hpp"
#include "drivers/wheel/can_table.hpp"

namespace lxd {

struct WheelSample {
  RigTime received;
  double speed_mps = 0;       // forward
  double yaw_rate_radps = 0;  // about z, left turns positive
  Duration span;              // the values are means over this time before `received`; 0: they are of one instant
};

enum class WheelSource : std::uint8_t {
  motion,       // messages that say speed and yaw rate
  rear_wheels,  // difference of two wheel speeds
  odometer,     // difference of two ways, between messages
  steering,     // speed and the angle of the steered wheels
  four_wheels   // the speeds of all
};

// As rig files name them, in the enumeration's order.
inline constexpr std::array<std::string_view, 5> kWheelKinematicsNames{"motion", "differential", "odometer",
                                                                       "ackermann", "four_wheel"};

// What a source is made of. The message with the first of them makes the sample, with the others' newest values.
std::span<const CanRole> roles_of(WheelSource source);

// A vehicle that is known, and what samples are made of when nothing else is said.
struct Vehicle {
  std::string_view name;
  std::span<const CanMessage> (*messages)();
  WheelSource source;
};
inline constexpr std::array<Vehicle, 4> kVehicles{{{"agilex", &agilex_messages, WheelSource::motion},
                                                   {"toyota", &toyota_messages, WheelSource::rear_wheels},
                                                   {"honda", &honda_messages, WheelSource::rear_wheels},
                                                   {"nissan", &nissan_messages, WheelSource::rear_wheels}}};

struct WheelDecoderConfig {
  std::span<const CanMessage> messages;
  WheelSource source = WheelSource::motion;
  double track_m = 0;  // between the wheels used; positive where a source takes the difference of two sides
  Duration period = Duration::from_ns(20'000'000);        // of the odometer's messages
  Duration longest_gap = Duration::from_ns(500'000'000);  // an odometer's difference over more is no speed
  double speed_max_mps = 70;
  double yaw_rate_max_radps = 10;
  // Between the axles: positive for steering. For four_wheels 0 says that no wheel is steered.
  double wheelbase_m = 0;
  Duration oldest_part = Duration::from_ns(100'000'000);  // of a sample whose parts come in several messages
};

struct WheelCounts {
  std::uint64_t samples = 0;
  std::uint64_t other_frames = 0;  // of the table, sound, not what samples are made of
  std::uint64_t unknown_id = 0, bad_length = 0, bad_checksum = 0, fault_bit = 0, out_of_range = 0;
  std::uint64_t remote_frames = 0, error_frames = 0, bus_off = 0;  // bus_off are error frames too
  std::uint64_t gaps = 0;                                          // odometer begun anew
  std::uint64_t missing_part = 0;                                  // what comes in another message is not there, or old
};

// Those that are refusals, by the names that a report gives them.
Rejections rejections_of(const WheelCounts& counts);

class WheelDecoder {
 public:
  explicit WheelDecoder(const WheelDecoderConfig& config) : config_(config) {}

  // Nothing: the frame makes no sample, and counts() says why.
  std::optional<WheelSample> decode(const CanFrame& frame);

  [[nodiscard]] const WheelCounts& counts() const { return counts_; }

 private:
  struct Part {
    CanValue value;
    RigTime received;
  };
  struct Odometer {
    RigTime received;
    std::int64_t left = 0, right = 0;  // raw
  };

  const CanMessage* accept(const CanFrame& frame);
  void count_error(const CanFrame& frame);
  void keep(const CanMessage& message, const CanValues& values, RigTime received);
  [[nodiscard]] bool has_all_parts(RigTime now) const;
  [[nodiscard]] double value(CanRole role) const { return parts_[static_cast<std::size_t>(role)].value.value(); }
  std::optional<WheelSample> sample_at(RigTime received);
  std::optional<WheelSample> from_odometer(RigTime received);
  [[nodiscard]] WheelSample from_steering(RigTime received) const;
  [[nodiscard]] WheelSample from_four_wheels(RigTime received) const;
  [[nodiscard]] WheelSample from_sides(double left_mps, double right_mps, RigTime received) const;
  [[nodiscard]] bool in_range(const WheelSample& sample) const;

  WheelDecoderConfig config_;
  std::array<Part, static_cast<std::size_t>(CanRole::kCount)> parts_{};  // newest, by role
  std::optional<Odometer> last_;
  WheelCounts counts_;
};

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// Packets of a sensor that scans without repetition become sweeps of equal duration: points in the sensor's frame, each
// with its own time, without those that the sensor itself calls noise. All echoes of a shot are points. Allocates
// nothing.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "drivers/livox/packet_parser.hpp"
#include "rt/sweep.hpp"

namespace lxd {

struct LivoxSweepCounts {
  std::uint64_t no_return = 0;         // points at the origin
  std::uint64_t noise_tag = 0;         // points
  std::uint64_t above_capacity = 0;    // points
  std::uint64_t repeated_packets = 0;  // a timestamp for the second time
  std::uint64_t late_packets = 0;      // of a sweep that is over
  // By the gaps between timestamps, as long as no packet fills them late. A gap over which the sensor's counters go on
  // by one is a step of its clock.
  std::uint64_t missing_packets = 0;
};

// One sweep after the other, into storage that the caller lends:
//   if (builder.completes(packet)) { if (builder.close(sweep)) deliver(sweep); sweep = a fresh one; }
//   builder.add(packet, sweep);
class LivoxSweepBuilder {
 public:
  explicit LivoxSweepBuilder(Duration period) : period_ns_(static_cast<std::uint64_t>(period.ns())) {}

  // True: the sweep under way is over, and `packet` belongs to the next; also when the sensor's clock went back: by
  // more than a second at once, by less when a few packets in a row say so.
  [[nodiscard]] bool completes(const LivoxPacket& packet) const;
  // Precondition: !packet.is_imu(), and a sweep without points when completes() was true before.
  void add(const LivoxPacket& packet, Sweep& sweep);
  // Fills begin, end and stamp (the end) on the sensor's clock. False: not one point.
  bool close(Sweep& sweep);

  [[nodiscard]] const LivoxSweepCounts& counts() const { return counts_; }

 private:
  static constexpr std::size_t kRemembered = 16;  // packets that a copy may come behind
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  [[nodiscard]] bool restarted(const LivoxPacket& packet) const;
  bool repeated(std::uint64_t timestamp_ns);
  [[nodiscard]] bool is_next(const LivoxPacket& packet) const;
  void count_missing(const LivoxPacket& packet);
  void forget();
  void add_points(const LivoxPacket& packet, Sweep& sweep);
  void add_point(const LivoxPoint& point, std::uint64_t packet_ns, Sweep& sweep);  // packet_ns: after the sweep's begin

  std::uint64_t period_ns_;
  bool open_ = false;                 // a sweep is under way
  std::uint64_t begin_ns_ = 0;        // of it
  std::uint64_t last_ns_ = 0;         // its latest point
  std::uint64_t next_ns_ = kNever;    // when the packet after the latest one should begin; kNever: not known
  std::uint32_t late_run_ = 0;        // late packets in a row
  std::uint16_t packet_counter_ = 0;  // of the last packet, as the next
  std::uint8_t frame_counter_ = 0;
  std::array<std::uint64_t, kRemembered> recent_ns_ = filled(kNever);
  std::size_t recent_ = 0;
  LivoxSweepCounts counts_;

  static constexpr std::array<std::uint64_t, kRemembered> filled(std::uint64_t value) {
    std::array<std::uint64_t, kRemembered> all{};
    all.fill(value);
    return all;
  }
};

}  // namespace lxd

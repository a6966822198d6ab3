// SPDX-License-Identifier: Apache-2.0
// Datagram in, points or an inertial sample out: a pure function of bytes. Every length is checked before a byte is
// read and before anything is divided, every refusal is counted by cause. Allocates nothing.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "drivers/livox/packet_format.hpp"

namespace lxd {

struct LivoxPoint {
  Eigen::Vector3f p_m = Eigen::Vector3f::Zero();  // sensor frame; the origin: nothing came back
  std::uint8_t reflectivity = 0;
  std::uint8_t tag = 0;
  bool noise = false;  // the sensor says so, by the tag
  std::uint8_t line = 0;
  std::uint32_t offset_ns = 0;  // after the packet's timestamp
};

struct LivoxImuSample {
  std::uint64_t timestamp_ns = 0;  // sensor time
  Eigen::Vector3d gyro_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mps2 = Eigen::Vector3d::Zero();  // specific force
};

// What a sound packet holds; points into the datagram.
struct LivoxPacket {
  std::uint64_t timestamp_ns = 0;  // sensor time, of the first point
  std::uint32_t duration_ns = 0;   // from the first point to the next packet's
  std::uint32_t count = 0;         // shots; an inertial packet has none
  std::uint16_t packet_counter = 0;
  std::uint8_t frame_counter = 0;
  LivoxClock clock = LivoxClock::kUptime;
  const LivoxRecord* record = nullptr;  // null: an inertial packet
  std::uint32_t lines = 1;
  const std::uint8_t* data = nullptr;

  [[nodiscard]] bool is_imu() const { return record == nullptr; }
  [[nodiscard]] std::uint32_t echoes() const { return record->echoes; }  // of each shot; precondition: !is_imu()
  // Precondition: i < count, echo < echoes().
  [[nodiscard]] LivoxPoint point(std::uint32_t i, std::uint32_t echo = 0) const;
  [[nodiscard]] LivoxImuSample imu() const;  // precondition: is_imu()
};

// Of the record of an inertial packet. Precondition: kLivoxImuBytes bytes.
bool livox_imu_is_finite(const std::uint8_t* record);

struct LivoxParserCounts {
  std::uint64_t packets = 0;         // accepted, of points
  std::uint64_t imu_packets = 0;     // accepted
  std::uint64_t bad_size = 0;        // shorter than a header, or not as long as the header says
  std::uint64_t bad_type = 0;        // of data: not known
  std::uint64_t bad_time_type = 0;   // a clock that is not known
  std::uint64_t bad_count = 0;       // no record, or records that do not fill the packet
  std::uint64_t bad_crc = 0;         // filled, and another
  std::uint64_t bad_time = 0;        // a timestamp beyond the year 2116
  std::uint64_t bad_imu_values = 0;  // not finite
};

class LivoxPacketParser {
 public:
  // lines: laser lines that fire in turn (kMid360Lines, kHapLines, else 1). Precondition: lines > 0.
  explicit LivoxPacketParser(std::uint32_t lines) : lines_(lines) {}

  // False: refused and counted; `packet` is then without meaning.
  bool parse(std::span<const std::uint8_t> datagram, LivoxPacket& packet);

  [[nodiscard]] const LivoxParserCounts& counts() const { return counts_; }

 private:
  bool accept(std::span<const std::uint8_t> datagram);
  bool accept_records(std::span<const std::uint8_t> datagram);

  std::uint32_t lines_;
  LivoxParserCounts counts_;
};

}  // namespace lxd

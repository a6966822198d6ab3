// SPDX-License-Identifier: Apache-2.0
// An Ouster sensor's inertial datagrams in, samples out: a pure function of bytes. Lengths are checked before a byte is
// read, every refusal is counted by cause. Allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "drivers/ouster/imu_format.hpp"

namespace lxd {

struct OusterImuSample {
  std::uint64_t accel_ns = 0, gyro_ns = 0;               // sensor time of each reading
  Eigen::Vector3d accel_mps2 = Eigen::Vector3d::Zero();  // specific force, axes of the sensor's IMU
  Eigen::Vector3d gyro_radps = Eigen::Vector3d::Zero();
};

struct OusterImuPacket {
  std::uint16_t count = 0;
  std::array<OusterImuSample, kOusterImuMaxRecords> storage{};

  [[nodiscard]] std::span<const OusterImuSample> samples() const { return std::span(storage).first(count); }
};

// Whole packets refused, then single records of sound packets.
struct OusterImuCounts {
  std::uint64_t packets = 0;  // accepted
  std::uint64_t bad_size = 0, bad_packet_type = 0, bad_init_id = 0, bad_crc = 0;
  std::uint64_t invalid_record = 0;     // the sensor says so (status bit)
  std::uint64_t non_finite_record = 0;  // a value that is no number
};

class OusterImuParser {
 public:
  // init_id: of the metadata; none: not checked. LEGACY packets have none.
  OusterImuParser(const OusterImuProfile& profile, std::optional<std::uint32_t> init_id)
      : profile_(profile), init_id_(init_id) {}

  // False: refused and counted; `packet` is then without meaning.
  bool parse(std::span<const std::uint8_t> datagram, OusterImuPacket& packet);

  [[nodiscard]] const OusterImuCounts& counts() const { return counts_; }

 private:
  [[nodiscard]] std::size_t records_in(std::size_t datagram_bytes) const;
  bool accept_header(std::span<const std::uint8_t> datagram);
  [[nodiscard]] bool crc_holds(std::span<const std::uint8_t> datagram) const;
  void take_record(const std::uint8_t* record, OusterImuPacket& packet);

  OusterImuProfile profile_;
  std::optional<std::uint32_t> init_id_;
  OusterImuCounts counts_;
};

}  // namespace lxd

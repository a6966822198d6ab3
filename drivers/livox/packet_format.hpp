// SPDX-License-Identifier: Apache-2.0
// The shape of a Livox SDK2 datagram (Mid-360, HAP): a header, then records of points or one of inertial data. Tables
// that the parser follows and the simulator fills. Sources: Livox-SDK2 08f523c, include/livox_lidar_def.h;
// livox_ros_driver2 13eb05e, src/comm/{comm.h,pub_handler.cpp}; Livox wiki, Mid-360 communication protocol 1.4.11.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/ouster/bit_field.hpp"

namespace lxd {

// Little-endian, as all of the datagram.
struct LivoxHeaderFields {
  BitField version = bytes_at(0, 1);
  BitField length = bytes_at(1, 2);         // of the whole datagram, bytes
  BitField time_interval = bytes_at(3, 2);  // from the first point to the next packet's, 0.1 us
  BitField record_count = bytes_at(5, 2);
  BitField packet_counter = bytes_at(7, 2);  // zero again with each frame
  BitField frame_counter = bytes_at(9, 1);
  BitField data_type = bytes_at(10, 1);
  BitField time_type = bytes_at(11, 1);
  BitField crc = bytes_at(24, 4);  // of everything from the timestamp on; zero: not filled
  BitField timestamp_ns = bytes_at(28, 8);
};
inline constexpr LivoxHeaderFields kLivoxHeader{};
inline constexpr std::size_t kLivoxHeaderBytes = 36;
inline constexpr std::size_t kLivoxCheckedFrom = 28;  // the first byte that the check value covers
inline constexpr std::int64_t kLivoxIntervalUnit_ns = 100;
inline constexpr std::uint64_t kLivoxLatestTime_ns = 1ULL << 62U;  // sums and differences below it cannot overflow

// What the tag of a point means.
enum class LivoxTags : std::uint8_t { kSdk2, kSdk1 };

// One shot, with an echo or several. Cartesian records have x, y, z (two's complement); spherical ones depth, zenith
// and azimuth. The fields are those of the first echo; the others' lie echo_bytes further on, but for the angles, which
// all share.
struct LivoxRecord {
  std::uint8_t data_type = 0;
  std::size_t bytes = 0;
  std::uint32_t echoes = 1;
  std::size_t echo_bytes = 0;
  double unit_m = 0;  // of x, y, z, depth
  BitField x{}, y{}, z{};
  BitField depth{}, zenith{}, azimuth{};  // angles in 0.01 deg
  BitField reflectivity{}, tag{};
  LivoxTags tags = LivoxTags::kSdk2;
};

// x, y, z of `width` bytes each, reflectivity, tag; more may follow.
constexpr LivoxRecord livox_cartesian(std::uint8_t data_type, std::size_t bytes, int width, double unit_m) {
  return {.data_type = data_type,
          .bytes = bytes,
          .unit_m = unit_m,
          .x = bytes_at(0, width),
          .y = bytes_at(width, width),
          .z = bytes_at(2 * width, width),
          .reflectivity = bytes_at(3 * width, 1),
          .tag = bytes_at(3 * width + 1, 1)};
}

inline constexpr double kLivoxAngleUnit_deg = 0.01;
inline constexpr std::array kLivoxRecords{
    livox_cartesian(1, 14, 4, 1e-3),
    livox_cartesian(2, 8, 2, 1e-2),
    LivoxRecord{.data_type = 3,
                .bytes = 10,
                .unit_m = 1e-3,
                .depth = bytes_at(0, 4),
                .zenith = bytes_at(4, 2),
                .azimuth = bytes_at(6, 2),
                .reflectivity = bytes_at(8, 1),
                .tag = bytes_at(9, 1)},
    LivoxRecord{.data_type = 0x11,
                .bytes = 28,
                .echoes = 2,
                .echo_bytes = 14,
                .unit_m = 1e-3,
                .x = bytes_at(0, 4),
                .y = bytes_at(4, 4),
                .z = bytes_at(8, 4),
                .reflectivity = bytes_at(12, 1),
                .tag = bytes_at(13, 1)},
};

// Null when the data type is not one of points.
constexpr const LivoxRecord* find_livox_record(std::uint64_t data_type) {
  for (const LivoxRecord& record : kLivoxRecords) {
    if (record.data_type == data_type) return &record;
  }
  return nullptr;
}

// The inertial record: six floats, gyro x y z in rad/s, then accelerometer x y z in g.
inline constexpr std::uint64_t kLivoxImuType = 0;
inline constexpr std::size_t kLivoxImuBytes = 24;
inline constexpr double kLivoxGravity_mps2 = 9.80665;

// Of whose clock the timestamps are.
enum class LivoxClock : std::uint8_t { kUptime = 0, kPtp = 1, kGps = 2 };
inline constexpr std::uint64_t kLivoxClocks = 3;

// SDK2: three classes of two bits (trailing points between two surfaces, particles in the air, others);
// 0 is best, 1 moderate, 2 and 3 are noise.
inline constexpr std::array<unsigned, 3> kLivoxTagShifts{0, 2, 4};
// SDK1: by place, by intensity (1: surely noise, 2: perhaps; 3: hardly, or reserved), then the echo's number.
inline constexpr std::array<unsigned, 2> kLivoxSdk1TagShifts{0, 2};

constexpr bool livox_tag_is_noise(std::uint8_t tag, LivoxTags tags = LivoxTags::kSdk2) {
  if (tags == LivoxTags::kSdk1) {
    for (const unsigned shift : kLivoxSdk1TagShifts) {
      const unsigned doubt = tag >> shift & 3U;
      if (doubt == 1 || doubt == 2) return true;
    }
    return false;
  }
  for (const unsigned shift : kLivoxTagShifts) {
    if ((tag >> shift & 3U) >= 2) return true;
  }
  return false;
}

inline constexpr std::uint32_t kMid360Lines = 4;  // laser lines that fire in turn
inline constexpr std::uint32_t kHapLines = 6;

}  // namespace lxd

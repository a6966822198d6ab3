// SPDX-License-Identifier: Apache-2.0
// Livox SDK2's control protocol (Mid-360, HAP) in numbers: the frame's header, commands, keys, states. Little endian.
// Sources: Livox-SDK2 08f523c, sdk_core/comm/{sdk_protocol,define}.h, command_handler/build_request.cpp,
// include/livox_lidar_def.h; Livox wiki, Mid-360 communication protocol 1.4.11.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/ouster/bit_field.hpp"

namespace lxd {

struct LivoxControlFields {
  BitField start = bytes_at(0, 1);
  BitField version = bytes_at(1, 1);
  BitField length = bytes_at(2, 2);  // with the header
  BitField sequence = bytes_at(4, 4);
  BitField command = bytes_at(8, 2);
  BitField kind = bytes_at(10, 1);    // LivoxControlKind
  BitField sender = bytes_at(11, 1);  // LivoxControlSender
  BitField header_crc = bytes_at(18, 2);
  BitField data_crc = bytes_at(20, 4);  // 0 where there are no data
};
inline constexpr LivoxControlFields kLivoxControl{};
inline constexpr std::size_t kLivoxControlHeaderBytes = 24;
inline constexpr std::size_t kLivoxControlCheckedBytes = 18;  // by the header's own check value
inline constexpr std::size_t kLivoxControlMaxBytes = 1400;    // frames travel in one Ethernet packet
inline constexpr std::uint8_t kLivoxControlStart = 0xAA;
inline constexpr std::uint8_t kLivoxControlVersion = 0;
inline constexpr unsigned kLivoxHeaderCrcInitial = 0xFFFF;  // CRC-16/CCITT-FALSE

enum class LivoxControlKind : std::uint8_t { kCommand = 0, kAck = 1 };
enum class LivoxControlSender : std::uint8_t { kHost = 0, kLidar = 1 };

enum class LivoxCommand : std::uint16_t {
  kDiscovery = 0x0000,
  kSetParameters = 0x0100,
  kGetParameters = 0x0101,
  kPushState = 0x0102,  // the sensor sends it once a second, unasked: its sign of life
  kReboot = 0x0200
};

enum class LivoxKey : std::uint16_t {
  kPointType = 0x0000,
  kStateHost = 0x0005,
  kPointHost = 0x0006,
  kImuHost = 0x0007,
  kWorkMode = 0x001A,
  kImuEnable = 0x001C,
  kSerial = 0x8000,
  kWorkState = 0x8006,
  kCoreTemperature = 0x8007,
  kLocalTime = 0x8009,
  kTimeSync = 0x800C,
  kHealth = 0x8011
};

enum class LivoxWorkMode : std::uint8_t {
  kSampling = 1,
  kIdle = 2,
  kSleep = 3,
  kError = 4,
  kSelfCheck = 5,
  kMotorStart = 6,
  kUpgrade = 8,
  kReady = 9
};

// Ports: the sensor's and the host's.
struct LivoxPorts {
  std::uint16_t sensor, host;
};
inline constexpr std::uint16_t kLivoxDiscoveryPort = 56000;  // of both, broadcast once a second
namespace mid360 {
inline constexpr LivoxPorts kControl{56100, 56101}, kState{56200, 56201}, kPoints{56300, 56301}, kImu{56400, 56401};
}
namespace hap {
inline constexpr LivoxPorts kControl{56000, 56000}, kState{56000, 56000}, kPoints{57000, 57000}, kImu{58000, 58000};
}

// What a discovery's answer calls the sensor.
enum class LivoxDevice : std::uint8_t { kMid360 = 9, kIndustrialHap = 10, kHap = 15, kMid360s = 35, kAvia2 = 40 };

using LivoxAddress = std::array<std::uint8_t, 4>;  // IPv4, as it is written

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// VectorNav's binary output (VN-100/200/300): 0xFA, a bitmap of groups, a bitmap of fields for each group, the fields
// in that order, CRC16 with its high byte first over all but the 0xFA. Little endian. Sources: vnproglib 1.2,
// cpp/src/packet.cpp; ArduPilot, AP_ExternalAHRS_VectorNav.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace lxd {

inline constexpr std::uint8_t kVectorNavSync = 0xFA;
inline constexpr std::size_t kVectorNavGroups = 7;           // Common, Time, IMU, GPS, Attitude, INS, GPS2
inline constexpr std::size_t kVectorNavMaxFrameBytes = 600;  // a longer one is taken for a damaged header
inline constexpr std::size_t kVectorNavCrcBytes = 2;

struct VectorNavField {
  std::uint8_t group, bit;
};

namespace vectornav {
inline constexpr VectorNavField kTimeStartup{0, 0}, kTimeGps{0, 1};  // u64 ns
inline constexpr VectorNavField kAngularRate{0, 5}, kAccel{0, 8};    // less the biases that the sensor estimates
inline constexpr VectorNavField kImu{0, 9};                          // uncompensated: acceleration, then rate
inline constexpr VectorNavField kTimeGroupStartup{1, 0}, kTimeGroupGps{1, 1};
inline constexpr VectorNavField kImuGroupUncompAccel{2, 2}, kImuGroupUncompGyro{2, 3};
inline constexpr VectorNavField kImuGroupAccel{2, 9}, kImuGroupAngularRate{2, 10};
}  // namespace vectornav

// Bytes of each field; 0: there is none, or (GPS satellites and raw measurements) its length varies.
inline constexpr std::array<std::array<std::uint8_t, 16>, kVectorNavGroups> kVectorNavFieldBytes{{
    {8, 8, 8, 12, 16, 12, 24, 12, 12, 24, 20, 28, 2, 4, 8, 0},
    {8, 8, 8, 2, 8, 8, 8, 4, 4, 1, 0, 0, 0, 0, 0, 0},
    {2, 12, 12, 12, 4, 4, 16, 12, 12, 12, 12, 2, 40, 0, 0, 0},
    {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, 0, 0},
    {2, 12, 16, 36, 12, 12, 12, 12, 12, 12, 28, 24, 12, 0, 0, 0},
    {2, 24, 24, 12, 12, 12, 12, 12, 12, 4, 4, 68, 64, 0, 0, 0},
    {8, 8, 2, 1, 1, 24, 24, 12, 12, 12, 4, 4, 2, 28, 0, 0},
}};

// Which fields a frame has. Of a group that is not set the fields are 0.
struct VectorNavLayout {
  std::uint8_t groups = 0;
  std::array<std::uint16_t, kVectorNavGroups> fields{};

  void add(VectorNavField field);
  [[nodiscard]] bool has(VectorNavField field) const;
  [[nodiscard]] std::size_t header_bytes() const;  // with the 0xFA
  [[nodiscard]] std::size_t frame_bytes() const;
  // From the frame's first byte; none: the frame does not have it.
  [[nodiscard]] std::optional<std::size_t> offset_of(VectorNavField field) const;
  [[nodiscard]] bool every_length_known() const;  // and there is a field at all
};

enum class VectorNavHeader { kIncomplete, kUnknownField, kTooLong, kSound };

// Of bytes that begin with 0xFA. The layout is meaningful when the header is sound.
VectorNavHeader read_vectornav_header(std::span<const std::uint8_t> bytes, VectorNavLayout& layout);

}  // namespace lxd

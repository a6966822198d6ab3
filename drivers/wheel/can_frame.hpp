// SPDX-License-Identifier: Apache-2.0
// One frame of a classic CAN bus, as the kernel hands it over (linux/can.h), with its receive time.
#pragma once

#include <array>
#include <cstdint>

#include "rt/time.hpp"

namespace lxd {

inline constexpr std::uint32_t kCanStandardIdMax = 0x7FF;
inline constexpr std::uint32_t kCanExtendedIdMax = 0x1FFFFFFF;
inline constexpr std::size_t kCanMaxData = 8;

// linux/can/error.h: classes of an error frame, in its id.
inline constexpr std::uint32_t kCanErrorBusOff = 0x40;
inline constexpr std::uint32_t kCanErrorRestarted = 0x100;

enum class CanKind : std::uint8_t {
  data,
  remote,  // asks for data, has none
  error    // made by the host's controller; the id holds error classes
};

using CanData = std::array<std::uint8_t, kCanMaxData>;

struct CanFrame {
  RigTime received;      // kernel's stamp
  std::uint32_t id = 0;  // without the kernel's flag bits
  bool extended = false;
  CanKind kind = CanKind::data;
  std::uint8_t length = 0;  // 0 .. 8
  CanData data{};           // bytes from length on are zero

  bool operator==(const CanFrame&) const = default;
};

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// A classic CAN frame as the kernel hands it over (linux/can.h, struct can_frame): 16 bytes, the id with its flags in
// the host's byte order. What a chunk of a CAN device holds.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "drivers/wheel/can_frame.hpp"

namespace lxd {

inline constexpr std::size_t kCanWireBytes = 16;

// Nothing: not 16 bytes, or a length beyond 8.
std::optional<CanFrame> can_frame_of(std::span<const std::uint8_t> wire, RigTime received);

// How the host's controller is, as its error frames tell (linux/can/error.h).
struct CanTrouble {
  bool passive = false;  // it has seen so many errors that it no longer signals any
  bool bus_off = false;  // it has left the bus
  bool back = false;     // it was restarted, or says that it is active again
};
CanTrouble trouble_of(const CanFrame& error_frame);

}  // namespace lxd

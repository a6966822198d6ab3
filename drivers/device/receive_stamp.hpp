// SPDX-License-Identifier: Apache-2.0
// What the kernel tells beside a message: when it was received, how many were lost before it, to whom it was sent.
#pragma once

#include <cstdint>
#include <optional>

#include <sys/socket.h>

#include "drivers/device/host_clock.hpp"

namespace lxd {

struct MessageNotes {
  std::optional<RigTime> received;
  std::optional<std::uint32_t> lost;      // since the socket was made; wraps
  std::uint32_t destination_address = 0;  // of a datagram: IPv4, host byte order
};

MessageNotes notes_of(const msghdr& message, const HostClock& clock);

// Room for all notes.
inline constexpr std::size_t kMessageNotesBytes = 128;

// Asks for all. False: this socket gives no stamps.
bool ask_for_notes(int socket);

// The kernel's count of lost messages as one that does not wrap.
class LossCount {
 public:
  // Lost since the last call.
  std::uint32_t since(std::uint32_t lost) {
    const std::uint32_t more = lost - last_;
    last_ = lost;
    return more;
  }
  void begin_again() { last_ = 0; }

 private:
  std::uint32_t last_ = 0;
};

}  // namespace lxd

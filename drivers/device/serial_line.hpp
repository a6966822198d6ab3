// SPDX-License-Identifier: Apache-2.0
// How a terminal is made a plain line of bytes: raw, 8N1, at any rate that its hardware can make (termios2).
#pragma once

#include <cstdint>

#include "rt/result.hpp"

namespace lxd {

// Error: the system's cause; no terminal, or a rate that it refuses (more than 3 % off).
Status make_plain_line(int fd, std::uint32_t baud_rate);

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// What a GPIO line's edges take of libgpiod 1.6, so that tests can stand in for a chip.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace lxd {

struct GpioEvent {
  std::int64_t stamp_ns = 0;  // CLOCK_MONOTONIC, made in the interrupt (Linux 5.7 and later)
  bool rising = false;
};

class GpioApi {
 public:
  virtual ~GpioApi() = default;

  // Asks for both edges of a line: its file descriptor, or -1 and errno. `chip`: "gpiochip0", its number or its label.
  virtual int request(const std::string& chip, unsigned line) = 0;
  // Waiting events, at least one when the descriptor is readable; -1 and errno.
  virtual int read(int fd, std::span<GpioEvent> events) = 0;
  // Gives the line back.
  virtual void release() = 0;
};

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// Apart from serial_port.cpp because <asm/termbits.h>, which alone has termios2, and <termios.h> exclude each other.
#include "drivers/device/serial_line.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>

#include <asm/termbits.h>
#include <fmt/format.h>
#include <sys/ioctl.h>

namespace lxd {
namespace {

constexpr double kRateTolerance = 0.03;  // beyond, the last of ten bits is sampled outside of itself

termios2 plain(termios2 line, std::uint32_t baud_rate) {
  line.c_iflag = 0;
  line.c_oflag = 0;
  line.c_lflag = 0;
  line.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | (BOTHER << IBSHIFT);
  line.c_ispeed = line.c_ospeed = baud_rate;
  line.c_cc[VMIN] = 1;  // so that a read of nothing fails, and a read of 0 bytes means the line's end
  line.c_cc[VTIME] = 0;
  return line;
}

}  // namespace

Status make_plain_line(int fd, std::uint32_t baud_rate) {
  termios2 line{};
  if (::ioctl(fd, TCGETS2, &line) != 0) return Error{fmt::format("found no serial line: {}", std::strerror(errno))};
  line = plain(line, baud_rate);
  if (::ioctl(fd, TCSETS2, &line) != 0 || ::ioctl(fd, TCGETS2, &line) != 0)
    return Error{fmt::format("{} baud are refused: {}", baud_rate, std::strerror(errno))};
  if (std::abs(static_cast<double>(line.c_ospeed) - baud_rate) > kRateTolerance * baud_rate)
    return Error{fmt::format("found {} baud, wanted {}: the port cannot make them", line.c_ospeed, baud_rate)};
  (void)::ioctl(fd, TCFLSH, TCIFLUSH);  // what came at another rate
  return success();
}

}  // namespace lxd

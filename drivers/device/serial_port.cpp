// SPDX-License-Identifier: Apache-2.0
#include "drivers/device/serial_port.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>

#include "drivers/device/serial_line.hpp"

namespace lxd {

void SerialPort::tend(RigTime now) {
  if (port_ || !reopening_.due(now)) return;
  const Status opened = open();
  if (opened) {
    trouble_.clear();
    ++counts_.openings;
    return;
  }
  port_.reset();
  trouble_ = opened.error().message;
  reopening_.failed(now);
}

Status SerialPort::open() {
  port_ = FileDescriptor(::open(config_.path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!port_) return Error{std::strerror(errno)};
  return make_plain_line(port_.get(), config_.baud_rate);
}

void SerialPort::read(ChunkSink& sink) {
  for (int i = 0; i < kReads; ++i) {
    const ssize_t count = ::read(port_.get(), buffer_.data(), buffer_.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) return;
    // EIO, ENODEV and ENXIO: pulled out; 0 bytes: hung up.
    if (count <= 0) return leave(count == 0 ? "the line was hung up" : std::strerror(errno));
    reopening_.works();
    ++counts_.chunks;
    counts_.bytes += static_cast<std::uint64_t>(count);
    sink.take({clock_.now(), {}, config_.channel, {buffer_.data(), static_cast<std::size_t>(count)}});
    if (static_cast<std::size_t>(count) < buffer_.size()) return;
  }
}

void SerialPort::leave(std::string why) {
  port_.reset();
  trouble_ = std::move(why);
  ++counts_.departures;
  reopening_.failed(clock_.now());
}

}  // namespace lxd

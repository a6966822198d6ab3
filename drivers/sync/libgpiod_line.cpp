// SPDX-License-Identifier: Apache-2.0
// See libgpiod_line.hpp.
#include "drivers/sync/libgpiod_line.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

#include <fcntl.h>
#include <gpiod.h>

#include "rt/time.hpp"

namespace lxd {
namespace {

constexpr const char* kConsumer = "lxd-slam";  // as gpioinfo shows it

// libgpiod's descriptors wait; ours must not.
int unblocked(int fd) {
  const int flags = fd < 0 ? -1 : ::fcntl(fd, F_GETFL);
  return flags < 0 || ::fcntl(fd, F_SETFL, flags | O_NONBLOCK) < 0 ? -1 : fd;
}

}  // namespace

int LibgpiodLine::request(const std::string& chip, unsigned line) {
  chip_ = gpiod_chip_open_lookup(chip.c_str());
  gpiod_line* const found = chip_ == nullptr ? nullptr : gpiod_chip_get_line(chip_, line);
  if (found != nullptr && gpiod_line_request_both_edges_events(found, kConsumer) == 0) {
    const int fd = unblocked(gpiod_line_event_get_fd(found));
    if (fd >= 0) return fd;
  }
  const int cause = errno;
  release();
  errno = cause;
  return -1;
}

int LibgpiodLine::read(int fd, std::span<GpioEvent> events) {
  constexpr std::size_t kAtOnce = 16;  // what the kernel keeps of a line
  std::array<gpiod_line_event, kAtOnce> raw{};
  const auto room = static_cast<unsigned>(std::min(events.size(), raw.size()));
  const int count = gpiod_line_event_read_fd_multiple(fd, raw.data(), room);
  for (int i = 0; i < count; ++i) {
    const gpiod_line_event& event = raw[static_cast<std::size_t>(i)];
    events[static_cast<std::size_t>(i)] = {std::int64_t{event.ts.tv_sec} * kNanosPerSecond + event.ts.tv_nsec,
                                           event.event_type == GPIOD_LINE_EVENT_RISING_EDGE};
  }
  return count;
}

void LibgpiodLine::release() {
  if (chip_ != nullptr) gpiod_chip_close(chip_);  // releases its lines
  chip_ = nullptr;
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
#include "drivers/sync/pps_device.hpp"

#include <array>

#include <sys/timerfd.h>

#include "drivers/sync/pulse_wire.hpp"

namespace lxd {

PpsDevice::PpsDevice(std::string path, PpsSource::Edge edge, std::uint8_t channel, const HostClock& clock,
                     SystemCalls& calls)
    : source_(std::move(path), edge, clock, calls),
      channel_(channel),
      timer_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
  const timespec period{0, static_cast<long>(kAsked.ns())};
  const itimerspec both{period, period};
  (void)::timerfd_settime(timer_.get(), 0, &both, nullptr);
}

void PpsDevice::tend(RigTime now) {
  source_.tend(now);
  note_counts();
}

void PpsDevice::read(ChunkSink& sink) {
  std::uint64_t times = 0;
  (void)!::read(timer_.get(), &times, sizeof times);
  const auto pulse = source_.fetch(Duration());
  note_counts();
  if (!pulse) return;
  constexpr unsigned kByteBits = 8;
  std::array<std::uint8_t, kPulseBytes> sequence{};
  for (unsigned i = 0; i < kPulseBytes; ++i) sequence[i] = static_cast<std::uint8_t>(pulse->sequence >> kByteBits * i);
  counts_.bytes += sequence.size();
  sink.take({pulse->edge, {}, channel_, sequence});
}

// What nobody asked for in time is lost by the kernel, which keeps the newest alone.
void PpsDevice::note_counts() {
  const PpsCounts& source = source_.counts();
  counts_.chunks = source.pulses;
  counts_.kernel_overflow = source.missed;
  counts_.no_stamp = source.unsound;
  counts_.openings = source.openings;
  counts_.departures = source.departures;
}

}  // namespace lxd

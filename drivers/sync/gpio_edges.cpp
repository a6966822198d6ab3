// SPDX-License-Identifier: Apache-2.0
// See gpio_edges.hpp.
#include "drivers/sync/gpio_edges.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace lxd {

GpioEdges::GpioEdges(GpioConfig config, const HostClock& clock, GpioApi& api)
    : config_(std::move(config)),
      clock_(clock),
      api_(api),
      name_(fmt::format("{} line {}", config_.chip, config_.line)) {}

GpioEdges::GpioEdges(GpioConfig config, const HostClock& clock, std::unique_ptr<GpioApi> api)
    : config_(std::move(config)),
      clock_(clock),
      kept_(std::move(api)),
      api_(*kept_),
      name_(fmt::format("{} line {}", config_.chip, config_.line)) {}

void GpioEdges::tend(RigTime now) {
  if (fd_ >= 0 || !reopening_.due(now)) return;
  fd_ = api_.request(config_.chip, config_.line);
  if (fd_ < 0) {
    trouble_ = fmt::format("{}: cannot be had: {}", name_, std::strerror(errno));
    reopening_.failed(now);
    return;
  }
  trouble_.clear();
  ++counts_.openings;
}

void GpioEdges::read(ChunkSink& sink) {
  if (fd_ < 0) return;
  std::array<GpioEvent, kChunksPerRead> events;
  const int count = api_.read(fd_, events);
  if (count < 0 && errno != EAGAIN && errno != EINTR) leave(errno);
  for (int i = 0; i < count; ++i) deliver(events[static_cast<std::size_t>(i)], sink);
}

void GpioEdges::deliver(const GpioEvent& event, ChunkSink& sink) {
  const std::array<std::uint8_t, 1> edge{
      static_cast<std::uint8_t>(event.rising ? GpioEdge::rising : GpioEdge::falling)};
  reopening_.works();
  ++counts_.chunks;
  ++counts_.bytes;
  sink.take({clock_.of_monotonic(event.stamp_ns), {}, config_.channel, edge});
}

void GpioEdges::leave(int cause) {
  api_.release();
  fd_ = -1;
  trouble_ = fmt::format("{}: {}", name_, std::strerror(cause));
  ++counts_.departures;
}

}  // namespace lxd

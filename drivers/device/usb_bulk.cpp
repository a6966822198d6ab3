// SPDX-License-Identifier: Apache-2.0
// See usb_bulk.hpp.
#include "drivers/device/usb_bulk.hpp"

#include <utility>

#include <fmt/format.h>

namespace lxd {

UsbBulk::UsbBulk(UsbBulkConfig config, const HostClock& clock, UsbBulkApi& api)
    : config_(std::move(config)),
      clock_(clock),
      api_(api),
      name_(fmt::format("usb {:04x}:{:04x}{}{}", config_.vendor, config_.product, config_.serial.empty() ? "" : " ",
                        config_.serial)) {}

UsbBulk::~UsbBulk() {
  if (there_) api_.close();
}

void UsbBulk::tend(RigTime now) {
  if (there_ || !reopening_.due(now)) return;
  if (const Status opened = api_.open(config_); !opened) {
    trouble_ = fmt::format("{}: {}", name_, opened.error().message);
    reopening_.failed(now);
    return;
  }
  there_ = true;
  trouble_.clear();
  ++counts_.openings;
}

void UsbBulk::read(ChunkSink& sink) {
  if (!there_) return;
  const Status read = api_.read([&](std::span<const std::uint8_t> bytes) {
    reopening_.works();
    ++counts_.chunks;
    counts_.bytes += bytes.size();
    sink.take({clock_.now(), {}, config_.channel, bytes});
  });
  if (read) return;
  api_.close();
  there_ = false;
  trouble_ = fmt::format("{}: {}", name_, read.error().message);
  ++counts_.departures;
}

}  // namespace lxd

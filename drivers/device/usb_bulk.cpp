// SPDX-License-Identifier: Apache-2.0
// See usb_bulk.hpp.
#include "drivers/device/usb_bulk.hpp"

#include <charconv>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace lxd {
namespace {

constexpr std::string_view kPrefix = "usb:";
constexpr std::size_t kIdDigits = 4;

// Four hexadecimal digits at `at`.
std::optional<std::uint16_t> id_at(std::string_view text, std::size_t at) {
  if (text.size() < at + kIdDigits) return std::nullopt;
  std::uint16_t id = 0;
  const char* const end = text.data() + at + kIdDigits;
  const auto [rest, failed] = std::from_chars(text.data() + at, end, id, 16);
  return failed == std::errc() && rest == end ? std::optional(id) : std::nullopt;
}

}  // namespace

std::optional<UsbBulkConfig> parse_usb_device(const std::string& text) {
  constexpr std::size_t kProductAt = kPrefix.size() + kIdDigits + 1, kSerialAt = kProductAt + kIdDigits;
  const auto vendor = id_at(text, kPrefix.size()), product = id_at(text, kProductAt);
  if (!text.starts_with(kPrefix) || !vendor || !product || text[kProductAt - 1] != ':') return std::nullopt;
  UsbBulkConfig config;
  config.vendor = *vendor;
  config.product = *product;
  if (text.size() == kSerialAt) return config;
  if (text[kSerialAt] != ':' || text.size() == kSerialAt + 1) return std::nullopt;
  config.serial = text.substr(kSerialAt + 1);
  return config;
}

UsbBulk::UsbBulk(UsbBulkConfig config, const HostClock& clock, std::unique_ptr<UsbBulkApi> api)
    : config_(std::move(config)),
      clock_(clock),
      api_(std::move(api)),
      name_(fmt::format("usb {:04x}:{:04x}{}{}", config_.vendor, config_.product, config_.serial.empty() ? "" : " ",
                        config_.serial)) {}

UsbBulk::~UsbBulk() {
  if (there_) api_->close();
}

void UsbBulk::tend(RigTime now) {
  if (there_ || !reopening_.due(now)) return;
  if (const Status opened = api_->open(config_); !opened) {
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
  const Status read = api_->read([&](std::span<const std::uint8_t> bytes) {
    reopening_.works();
    ++counts_.chunks;
    counts_.bytes += bytes.size();
    sink.take({clock_.now(), {}, config_.channel, bytes});
  });
  if (read) return;
  api_->close();
  there_ = false;
  trouble_ = fmt::format("{}: {}", name_, read.error().message);
  ++counts_.departures;
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// One USB device's bulk input, as much of libusb as it takes, so that tests can stand in for a bus.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "rt/result.hpp"

namespace lxd {

struct UsbBulkConfig {
  std::uint16_t vendor = 0, product = 0;
  std::string serial{};          // empty: the first of vendor and product
  int interface = 0;             // claimed; a kernel driver that has it is asked to go and comes back afterwards
  std::uint8_t endpoint = 0x81;  // of bulk input
  std::uint8_t channel = 0;
};

// "usb:199b:3065" or "usb:199b:3065:SERIAL": vendor and product in hexadecimal, as lsusb has them. None: no such text.
std::optional<UsbBulkConfig> parse_usb_device(const std::string& text);

class UsbBulkApi {
 public:
  virtual ~UsbBulkApi() = default;

  // Error: why the device cannot be had; "not there" is one.
  virtual Status open(const UsbBulkConfig& config) = 0;
  // To poll for reading, as long as it is open.
  [[nodiscard]] virtual int fd() const = 0;
  // Hands over what has arrived; does not wait. Error: the device is gone, or gave up.
  virtual Status read(const std::function<void(std::span<const std::uint8_t>)>& take) = 0;
  virtual void close() = 0;
};

}  // namespace lxd

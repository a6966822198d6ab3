// SPDX-License-Identifier: Apache-2.0
// A sensor whose bytes come by USB bulk transfers, without a serial port of the kernel's: an IMU. It may be pulled out,
// or re-enumerate after a reset: it is sought again by vendor, product and serial number.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "drivers/device/device.hpp"
#include "drivers/device/host_clock.hpp"
#include "drivers/device/reopening.hpp"
#include "drivers/device/usb_bulk_api.hpp"

namespace lxd {

class UsbBulk final : public Device {
 public:
  // Away until tend() opens it. `clock` outlives it.
  UsbBulk(UsbBulkConfig config, const HostClock& clock, std::unique_ptr<UsbBulkApi> api);
  UsbBulk(const UsbBulk&) = delete;
  UsbBulk& operator=(const UsbBulk&) = delete;
  ~UsbBulk() override;

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] int fd() const override { return there_ ? api_->fd() : -1; }
  // A chunk a transfer; its stamp is that of the reading.
  void read(ChunkSink& sink) override;
  void tend(RigTime now) override;
  [[nodiscard]] const std::string& trouble() const override { return trouble_; }
  [[nodiscard]] const DeviceCounts& counts() const override { return counts_; }

 private:
  UsbBulkConfig config_;
  const HostClock& clock_;
  std::unique_ptr<UsbBulkApi> api_;
  std::string name_;
  bool there_ = false;
  Reopening reopening_;
  std::string trouble_ = "not opened yet";
  DeviceCounts counts_;
};

}  // namespace lxd

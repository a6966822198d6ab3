// SPDX-License-Identifier: Apache-2.0
// A serial port that may be pulled out and put in again: it is sought by the same path, best one below
// /dev/serial/by-id.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "drivers/device/device.hpp"
#include "drivers/device/file_descriptor.hpp"
#include "drivers/device/host_clock.hpp"
#include "drivers/device/reopening.hpp"
#include "rt/result.hpp"

namespace lxd {

struct SerialConfig {
  std::string path;
  std::uint32_t baud_rate = 115'200;
  std::uint8_t channel = 0;
};

class SerialPort final : public Device {
 public:
  // Away until tend() opens it. `clock` outlives the port.
  SerialPort(SerialConfig config, const HostClock& clock) : config_(std::move(config)), clock_(clock) {}

  [[nodiscard]] const std::string& name() const override { return config_.path; }
  [[nodiscard]] int fd() const override { return port_.get(); }
  // A chunk a read; its stamp is that of the read, as terminals have no better.
  void read(ChunkSink& sink) override;
  void tend(RigTime now) override;
  [[nodiscard]] const std::string& trouble() const override { return trouble_; }
  [[nodiscard]] const DeviceCounts& counts() const override { return counts_; }

 private:
  static constexpr std::size_t kReadBytes = 4096;  // what a terminal holds
  static constexpr int kReads = 4;                 // at once, so that other devices have their turn
  Status open();
  void leave(std::string why);

  SerialConfig config_;
  const HostClock& clock_;
  FileDescriptor port_;
  Reopening reopening_;
  std::string trouble_ = "not opened yet";
  DeviceCounts counts_;
  std::array<std::uint8_t, kReadBytes> buffer_{};
};

}  // namespace lxd

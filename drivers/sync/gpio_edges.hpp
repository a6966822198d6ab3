// SPDX-License-Identifier: Apache-2.0
// The edges of a GPIO line, stamped by the kernel: a pulse per second, or what a microcontroller does when it triggers
// a sensor. An expander on USB may be pulled out; it is sought again.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "drivers/device/device.hpp"
#include "drivers/device/host_clock.hpp"
#include "drivers/device/reopening.hpp"
#include "drivers/sync/gpio_api.hpp"

namespace lxd {

// The one byte of an edge's chunk, as the kernel numbers them.
enum class GpioEdge : std::uint8_t { rising = 1, falling = 2 };

struct GpioConfig {
  std::string chip;  // "gpiochip0", or its label
  unsigned line = 0;
  std::uint8_t channel = 0;
};

class GpioEdges final : public Device {
 public:
  // Away until tend() requests the line. `clock` and `api` outlive it; each line has an api of its own.
  GpioEdges(GpioConfig config, const HostClock& clock, GpioApi& api);
  // Keeps its api.
  GpioEdges(GpioConfig config, const HostClock& clock, std::unique_ptr<GpioApi> api);
  GpioEdges(const GpioEdges&) = delete;
  GpioEdges& operator=(const GpioEdges&) = delete;
  ~GpioEdges() override { api_.release(); }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] int fd() const override { return fd_; }
  // A chunk an edge: received is the edge's stamp. The kernel keeps 16 edges of a line; this interface of its does not
  // tell of more.
  void read(ChunkSink& sink) override;
  void tend(RigTime now) override;
  [[nodiscard]] const std::string& trouble() const override { return trouble_; }
  [[nodiscard]] const DeviceCounts& counts() const override { return counts_; }

 private:
  void leave(int cause);
  void deliver(const GpioEvent& event, ChunkSink& sink);

  GpioConfig config_;
  const HostClock& clock_;
  std::unique_ptr<GpioApi> kept_;  // none: the api is another's
  GpioApi& api_;
  std::string name_;
  int fd_ = -1;
  Reopening reopening_;
  std::string trouble_ = "not opened yet";
  DeviceCounts counts_;
};

}  // namespace lxd

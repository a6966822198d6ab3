// SPDX-License-Identifier: Apache-2.0
// A CAN interface by SocketCAN: the frames that are wanted, picked by the kernel, and all error frames. An interface
// that is taken down, or whose adapter is pulled out, is sought again by its name.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/device/can_wire.hpp"
#include "drivers/device/device.hpp"
#include "drivers/device/file_descriptor.hpp"
#include "drivers/device/host_clock.hpp"
#include "drivers/device/receive_stamp.hpp"
#include "drivers/device/reopening.hpp"
#include "rt/result.hpp"

namespace lxd {

struct CanId {
  std::uint32_t id = 0;
  bool extended = false;
};

struct CanConfig {
  std::string interface;
  std::vector<CanId> ids;  // empty: every frame of the bus
  std::uint8_t channel = 0;
};

class CanSocket final : public Device {
 public:
  // Away until tend() opens it. `clock` outlives the socket.
  CanSocket(CanConfig config, const HostClock& clock) : config_(std::move(config)), clock_(clock) {}
  // Over a socket of messages of that form that is open already.
  CanSocket(CanConfig config, const HostClock& clock, FileDescriptor socket);

  [[nodiscard]] const std::string& name() const override { return config_.interface; }
  [[nodiscard]] int fd() const override { return socket_.get(); }
  void read(ChunkSink& sink) override;  // a chunk a frame: can_frame_of()
  void tend(RigTime now) override;
  [[nodiscard]] const std::string& trouble() const override { return trouble_; }
  [[nodiscard]] const DeviceCounts& counts() const override { return counts_; }
  // The controller has left the bus and was not heard since. It comes back by itself where the interface has a
  // restart-ms (ip-link(8)).
  [[nodiscard]] bool bus_off() const { return bus_off_; }

 private:
  Status open();
  [[nodiscard]] Status choose(int socket) const;
  bool read_one(ChunkSink& sink);
  void note(const CanFrame& frame);
  void leave(int cause);

  CanConfig config_;
  const HostClock& clock_;
  FileDescriptor socket_;
  Reopening reopening_;
  LossCount losses_;
  bool bus_off_ = false;
  std::string trouble_ = "not opened yet";
  DeviceCounts counts_;
};

}  // namespace lxd

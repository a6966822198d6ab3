// SPDX-License-Identifier: Apache-2.0
// A UDP port of the host: many datagrams a system call, with the kernel's receive stamps, by whom they were sent.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/device/device.hpp"
#include "drivers/device/host_clock.hpp"
#include "rt/result.hpp"

namespace lxd {

// A sender whose datagrams are wanted. Two sensors on one port are two of them.
struct UdpSource {
  std::uint32_t address = 0;  // IPv4, host byte order; 0: any that no other source has
  std::uint8_t channel = 0;   // of its chunks
};

struct UdpConfig {
  std::uint16_t port = 0;                        // of the host; 0: the kernel chooses
  std::uint32_t multicast_group = 0;             // joined on all interfaces that lead to it; 0: none
  std::size_t receive_buffer_bytes = 8U << 20U;  // of the kernel, asked for; 0.1 s of two dense LiDARs
  std::size_t datagram_max = 65'507;             // longer ones are cut and left out; the most that IPv4 carries
  std::vector<UdpSource> sources;                // others are foreign
};

class UdpSocket final : public Device {
 public:
  // Error: the port cannot be had, or the group not be joined. `clock` outlives the socket.
  static Result<std::unique_ptr<UdpSocket>> open(const UdpConfig& config, const HostClock& clock);
  ~UdpSocket() override;

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] int fd() const override;
  void read(ChunkSink& sink) override;
  void tend(RigTime) override {}  // a port stays, whatever becomes of the cable
  [[nodiscard]] const std::string& trouble() const override { return trouble_; }
  [[nodiscard]] const DeviceCounts& counts() const override { return counts_; }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::size_t receive_buffer_bytes() const { return granted_bytes_; }  // what the kernel gave

 private:
  struct Batch;  // the buffers of one system call
  UdpSocket(const UdpConfig& config, const HostClock& clock);
  Status start();
  Status join();
  void ask_for_buffer();
  void deliver(int i, ChunkSink& sink);
  [[nodiscard]] const UdpSource* source_of(std::uint32_t address) const;

  UdpConfig config_;
  const HostClock& clock_;
  std::string name_, trouble_;
  std::unique_ptr<Batch> batch_;
  std::uint16_t port_ = 0;
  std::size_t granted_bytes_ = 0;
  DeviceCounts counts_;
};

}  // namespace lxd

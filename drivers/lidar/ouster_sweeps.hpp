// SPDX-License-Identifier: Apache-2.0
// An Ouster's packets as sweeps: parser, assembler of frames, sweep builder and clock.
#pragma once

#include <memory>

#include "drivers/lidar/packet_sweeps.hpp"
#include "drivers/ouster/frame_assembler.hpp"
#include "drivers/ouster/metadata.hpp"
#include "drivers/ouster/packet_parser.hpp"
#include "drivers/ouster/sweep_builder.hpp"
#include "drivers/replay/sweep_clock.hpp"

namespace lxd {

class OusterSweeps final : public PacketSweeps {
 public:
  OusterSweeps(const OusterMetadata& metadata, std::unique_ptr<SweepClock> clock);

  bool parse(std::span<const std::uint8_t> datagram) override { return parser_.parse(datagram, packet_); }
  bool take(RigTime received, Sweep& sweep) override;
  bool flush(Sweep& sweep) override;
  void report(Rejections& rejected) const override;

 private:
  bool build(const OusterFrame& frame, Sweep& sweep);

  OusterPacketParser parser_;
  OusterPacket packet_;
  OusterFrameAssembler assembler_;
  OusterSweepBuilder builder_;
  std::unique_ptr<SweepClock> clock_;
  std::uint32_t sequence_ = 0;
  Rejections rejected_;  // that none of the parts counts
};

}  // namespace lxd

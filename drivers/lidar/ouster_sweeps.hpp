// SPDX-License-Identifier: Apache-2.0
// An Ouster's packets as sweeps: parser, assembler of frames, sweep builder and clock.
#pragma once

#include <array>
#include <memory>

#include "drivers/lidar/packet_sweeps.hpp"
#include "drivers/ouster/frame_assembler.hpp"
#include "drivers/ouster/imu_parser.hpp"
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
  std::span<const ImuSample> inertial(std::span<const std::uint8_t> datagram, RigTime received) override;
  void add_pulse(RigTime edge) override { clock_->add_pulse(edge); }
  void report(Rejections& rejected) const override;
  void report_inertial(Rejections& rejected) const override;

 private:
  bool build(const OusterFrame& frame, Sweep& sweep);
  OusterImuParser* inertial_parser(std::span<const std::uint8_t> datagram);

  std::size_t point_bytes_;  // of a packet of points
  OusterImuParser legacy_imu_, imu_;
  OusterImuPacket imu_packet_;
  std::array<ImuSample, kOusterImuMaxRecords> samples_;
  OusterPacketParser parser_;
  OusterPacket packet_;
  OusterFrameAssembler assembler_;
  OusterSweepBuilder builder_;
  std::unique_ptr<SweepClock> clock_;
  std::uint32_t sequence_ = 0;
  Rejections rejected_;  // that none of the parts counts
};

}  // namespace lxd

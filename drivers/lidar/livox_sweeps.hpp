// SPDX-License-Identifier: Apache-2.0
// A Livox's packets as sweeps: parser, sweep builder and clock.
#pragma once

#include <memory>
#include <vector>

#include "drivers/lidar/packet_sweeps.hpp"
#include "drivers/livox/sdk1_parser.hpp"
#include "drivers/livox/sweep_builder.hpp"
#include "drivers/replay/livox_stream.hpp"
#include "drivers/replay/sweep_clock.hpp"

namespace lxd {

inline constexpr double kLivoxSweepRate_hz = 10;  // a scan without repetition has no turns: it is cut at this rate

class LivoxSweeps final : public PacketSweeps {
 public:
  LivoxSweeps(const LivoxParser& parser, std::unique_ptr<SweepClock> clock,
              Duration period = Duration::from_seconds(1 / kLivoxSweepRate_hz));

  bool parse(std::span<const std::uint8_t> datagram) override;
  bool take(RigTime received, Sweep& sweep) override;
  bool flush(Sweep& sweep) override { return builder_.close(building_) && deliver(sweep); }
  std::span<const ImuSample> inertial(std::span<const std::uint8_t> datagram, RigTime received) override;
  void add_pulse(RigTime edge) override { clock_->add_pulse(edge); }
  void report(Rejections& rejected) const override;
  void report_inertial(Rejections& rejected) const override;

 private:
  bool deliver(Sweep& sweep);

  LivoxParser parser_;
  LivoxPacket packet_;
  ImuSample sample_;
  LivoxSweepBuilder builder_;
  std::unique_ptr<SweepClock> clock_;
  std::vector<LidarPoint> storage_;
  Sweep building_;
  std::uint64_t no_room_ = 0;  // points, in sweeps that were lent
  std::uint32_t sequence_ = 0;
  Rejections rejected_;  // that none of the parts counts
};

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// What the reading thread of a live rig makes of a rig's bytes while nobody takes it.
#include <gtest/gtest.h>

#include "board/default/capacities.hpp"
#include "board/live_intake.hpp"
#include "rt/allocation_guard.hpp"
#include "tools/simulator/lidar/livox_encoder.hpp"

namespace lxd::board_live_intake_test {
namespace {

constexpr std::uint16_t kPort = 56'301;

class LiveIntakeOfTwoLivox : public testing::Test {
 protected:
  LiveIntakeOfTwoLivox() : block_(2 * (1000 * sizeof(LidarPoint) + 4096)), arena_(block_) {
    for (const LiveChannel channel : {LiveChannel::lidar0, LiveChannel::lidar1}) {
      LiveLidar lidar;
      lidar.channel = channel;
      lidar.wire.port = kPort;
      live_.lidars.push_back(lidar);
    }
    live_.rig.lidar1.emplace();
    live_.sensors.extra_lidar = true;
  }

  // Of two points.
  [[nodiscard]] std::vector<std::uint8_t> packet(std::uint16_t counter) const {
    const std::vector<sim::LivoxReturn> shots(2, sim::LivoxReturn{Eigen::Vector3d(1, 2, 3), 40, 0});
    const sim::LivoxHeader header{static_cast<std::uint64_t>(now_.ns()), 1'000'000, counter, 0, LivoxClock::kUptime};
    return sim::encode_livox_points(kLivoxRecords.front(), header, shots);
  }
  [[nodiscard]] Chunk chunk(LiveChannel channel, std::span<const std::uint8_t> bytes) const {
    return {now_, {0, 0, 0, kPort}, static_cast<std::uint8_t>(index_of(channel)), bytes};
  }

  // A packet a millisecond to the extra LiDAR.
  void hear(LiveIntake& intake, int packets) {
    for (int i = 0; i < packets; ++i, now_ = now_ + Duration::from_ns(1'000'000)) {
      const auto bytes = packet(static_cast<std::uint16_t>(i));
      intake.take(chunk(LiveChannel::lidar1, bytes));
    }
  }

  std::vector<std::byte> block_;
  Arena arena_;
  SweepPool sweeps_{arena_, "sweeps", 2, 1000};
  LiveRig live_;
  EventLog events_;
  RigTime now_ = RigTime::from_seconds(1000);
};

// Given a primary LiDAR whose sweeps end every tenth of a second, or that is silent for a while, then what the extra
// one sends meanwhile is there when it is wanted; after more than a second without anybody, what has no room is
// counted.
TEST_F(LiveIntakeOfTwoLivox, TheExtraOnesReturnsWaitForThePrimarysSweep) {
  SensorWatch watch(live_, events_);
  LiveIntake intake(live_, sweeps_, watch);
  hear(intake, 1000);
  EXPECT_FALSE(intake.rejected()["lidar1"].contains("no_room"));
  hear(intake, 1000);
  const auto refused = intake.rejected()["lidar1"]["no_room"];
  EXPECT_GT(refused, 500U);
  EXPECT_LT(refused, 1000U);
}

// Neither packets that are taken nor those that are refused.
TEST_F(LiveIntakeOfTwoLivox, TakingAllocatesNothing) {
  if (!AllocationGuard::active()) GTEST_SKIP() << "allocations are not counted here";
  SensorWatch watch(live_, events_);
  LiveIntake intake(live_, sweeps_, watch);
  const std::vector<std::uint8_t> noise(100, 0xA5);
  const auto bytes = packet(0);
  const AllocationGuard guard;
  for (std::uint16_t i = 0; i < 1000; ++i) {
    for (const LiveChannel channel : {LiveChannel::lidar0, LiveChannel::lidar1}) {
      intake.take(chunk(channel, bytes));
      intake.take(chunk(channel, noise));
    }
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace lxd::board_live_intake_test

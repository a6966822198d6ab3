// SPDX-License-Identifier: Apache-2.0
// Livox sensors over loopback UDP: found, set up, watched, started again, rebooted, sought again. Time is the test's
// own.
#include <gtest/gtest.h>

#include "drivers/livox/control_device.hpp"
#include "tests/support/made_livox.hpp"

namespace lxd::drivers_livox_device_test {
namespace {

using test::MadeLivox;

class NoSink final : public ChunkSink {
 public:
  void take(const Chunk&) override { ADD_FAILURE() << "control frames are no samples"; }
};

class LivoxLoop : public testing::Test {
 protected:
  static constexpr int kStep_ms = 100;

  LivoxSessionConfig config(const MadeLivox& sensor) {
    return {.host = {127, 0, 0, 1}, .sensor = sensor.address(), .points_port = 5000, .discovery_port = sensor.port()};
  }
  LivoxControl& begin(std::vector<LivoxSessionConfig> sessions) {
    control_.emplace(std::move(sessions), LivoxHostPorts{0, 0, 0});
    return *control_;
  }
  // Loopback delivers before sendto() returns, so each round is complete.
  void run(double seconds) {
    for (int ms = 0; ms < static_cast<int>(seconds * 1000); ms += kStep_ms) {
      elapsed_ms_ += kStep_ms;
      now_ = now_ + Duration::from_ns(std::int64_t{kStep_ms} * 1'000'000);
      control_->tend(now_);
      for (std::size_t i = 0; i < sensors_.size(); ++i) {
        sensors_[i]->step();
        if (elapsed_ms_ % 1000 == 0 && sensors_[i]->answers) sensors_[i]->push_state();
        if (sends_points_ && sensors_[i]->sampling() && i < control_->sessions().size())
          control_->heard_points(i, now_);
      }
      control_->read(sink_);
    }
  }
  [[nodiscard]] const LivoxSession& session(std::size_t i = 0) const { return control_->sessions()[i]; }

  MadeLivox sensor_{{127, 0, 0, 2}, "3GGDJ6K00100001"};
  std::vector<MadeLivox*> sensors_{&sensor_};
  bool sends_points_ = true;
  std::optional<LivoxControl> control_;
  NoSink sink_;
  RigTime now_ = RigTime::from_ns(1'700'000'000 * kNanosPerSecond);
  int elapsed_ms_ = 0;
};

TEST_F(LivoxLoop, FindsTheSensorSetsItUpAndLeavesItAlone) {
  begin({config(sensor_)});
  run(10);
  EXPECT_EQ(session().phase(), LivoxPhase::running);
  EXPECT_EQ(session().serial(), "3GGDJ6K00100001");
  EXPECT_EQ(session().address(), sensor_.address());
  EXPECT_TRUE(sensor_.sampling());
  EXPECT_EQ(sensor_.points_port, 5000);
  EXPECT_EQ(sensor_.discoveries, 1);
  EXPECT_EQ(sensor_.settings, 1);
  EXPECT_GE(session().counts().states, 8U);
  EXPECT_EQ(session().state()->mode, LivoxWorkMode::kSampling);
  EXPECT_TRUE(control_->trouble().empty()) << control_->trouble();
  EXPECT_EQ(sensor_.questions, 0) << "its states are signs of life enough";
}

TEST_F(LivoxLoop, AsksOnceASecondForASensorThatIsNotThere) {
  sensor_.answers = false;
  begin({config(sensor_)});
  run(10);
  EXPECT_EQ(sensor_.discoveries, 10);
  EXPECT_EQ(control_->trouble(), "not found yet");
  sensor_.answers = true;
  run(2);
  EXPECT_EQ(session().phase(), LivoxPhase::running);
}

TEST_F(LivoxLoop, AnotherSerialNumberIsNotItsSensor) {
  LivoxSessionConfig other = config(sensor_);
  other.serial = "3GGDJ6K00100002";
  begin({other});
  run(3);
  EXPECT_EQ(session().phase(), LivoxPhase::seeking);
  EXPECT_GE(control_->counts().foreign, 2U);
}

TEST_F(LivoxLoop, NamesTheParameterThatIsRefused) {
  sensor_.refuses_key = static_cast<std::uint16_t>(LivoxKey::kImuHost);
  begin({config(sensor_)});
  run(2);
  EXPECT_EQ(control_->trouble(), "refused parameter 0x0007 (code 1)");
  EXPECT_EQ(session().phase(), LivoxPhase::setting_up);
  sensor_.refuses_key = 0;
  run(5);
  EXPECT_EQ(session().phase(), LivoxPhase::running);
  EXPECT_GE(session().counts().refusals, 2U);
}

TEST_F(LivoxLoop, ASensorThatSendsNoPointsIsStartedAgainThenRebooted) {
  begin({config(sensor_)});
  run(3);
  sends_points_ = false;
  run(4);
  EXPECT_GE(session().counts().restarts, 1U);
  EXPECT_EQ(sensor_.reboots, 0);
  sends_points_ = true;
  run(5);
  const std::uint64_t restarts = session().counts().restarts;
  run(5);
  EXPECT_EQ(session().counts().restarts, restarts) << "points have come";
  sends_points_ = false;
  run(12);
  EXPECT_EQ(sensor_.reboots, 1);
  EXPECT_EQ(session().counts().reboots, 1U);
}

TEST_F(LivoxLoop, ASensorThatWasSwitchedOffIsFoundAgainAndSampling) {
  begin({config(sensor_)});
  run(3);
  sensor_.switch_off();
  run(10);
  EXPECT_EQ(session().phase(), LivoxPhase::seeking);
  EXPECT_EQ(control_->trouble(), "does not answer");
  sensor_.switch_on();
  run(2);
  EXPECT_EQ(session().phase(), LivoxPhase::running);
  EXPECT_TRUE(sensor_.sampling());
  EXPECT_EQ(session().counts().found, 2U);
  EXPECT_EQ(session().counts().lost, 1U);
}

// Another host's word, or a short loss of power: points may still be under way.
TEST_F(LivoxLoop, ASensorThatFellOutOfSamplingIsSetSamplingAgain) {
  begin({config(sensor_)});
  run(5);
  sensor_.mode = LivoxWorkMode::kIdle;
  run(2);
  EXPECT_TRUE(sensor_.sampling());
  EXPECT_GE(session().counts().restarts, 1U);
}

TEST_F(LivoxLoop, AMotorThatStartsIsGivenItsTime) {
  sends_points_ = false;
  begin({config(sensor_)});
  run(1);
  sensor_.mode = LivoxWorkMode::kMotorStart;
  run(1);
  const int settings = sensor_.settings;
  for (int i = 0; i < 20; ++i) run(1);
  EXPECT_EQ(sensor_.settings, settings);
  run(15);
  EXPECT_GT(sensor_.settings, settings) << "but not for ever";
}

TEST_F(LivoxLoop, TwoSensorsHaveASessionEach) {
  MadeLivox second({127, 0, 0, 3}, "3GGDJ6K00100002");
  sensors_.push_back(&second);
  begin({config(sensor_), config(second)});
  run(5);
  EXPECT_EQ(session(0).serial(), "3GGDJ6K00100001");
  EXPECT_EQ(session(1).serial(), "3GGDJ6K00100002");
  second.switch_off();
  run(8);
  EXPECT_EQ(session(0).phase(), LivoxPhase::running);
  EXPECT_EQ(session(1).phase(), LivoxPhase::seeking);
}

TEST_F(LivoxLoop, StrangersAndDamageAreCountedAndNothingElse) {
  begin({config(sensor_)});
  run(3);
  MadeLivox stranger({127, 0, 0, 9}, "STRANGER");
  const std::uint16_t port = sensor_.state_port;
  std::array<std::uint8_t, kLivoxControlMaxBytes> buffer;
  const std::array<std::uint8_t, 4> no_list{9, 0, 0, 0};
  LivoxControlFrame state{1, static_cast<std::uint16_t>(LivoxCommand::kPushState), LivoxControlKind::kCommand,
                          LivoxControlSender::kLidar, no_list};
  stranger.send_bytes(encode_livox_control(state, buffer), port);
  sensor_.send_bytes(encode_livox_control(state, buffer), port);
  sensor_.send_bytes(std::vector<std::uint8_t>(2000, 0xAA), port);
  sensor_.send_bytes({}, port);
  run(1);
  EXPECT_EQ(control_->counts().foreign, 1U);
  EXPECT_EQ(control_->frame_counts().bad_values, 1U);
  EXPECT_EQ(control_->frame_counts().bad_size, 1U);
  EXPECT_EQ(control_->frame_counts().bad_start, 1U);
  EXPECT_EQ(session().phase(), LivoxPhase::running);
}

TEST_F(LivoxLoop, APortThatIsTakenIsTold) {
  const LivoxHostPorts taken{sensor_.port(), 0, 0};
  LivoxControl control({config(sensor_)}, taken);
  control.tend(now_);
  EXPECT_NE(control.trouble().find("Address already in use"), std::string::npos) << control.trouble();
  EXPECT_EQ(control.fd(), -1);
  sensor_.switch_off();
  control.tend(now_ + Duration::from_seconds(1));
  EXPECT_GE(control.fd(), 0);
}

// Without an address everybody is asked.
TEST(LivoxSession, AsksEverybodyWhenItDoesNotKnowTheAddress) {
  class Keep final : public LivoxControlWire {
   public:
    void send(const LivoxAddress& to, std::uint16_t port, std::span<const std::uint8_t>) override {
      address = to;
      to_port = port;
    }
    LivoxAddress address{};
    int to_port = 0;
  } kept;
  LivoxSession session({.host = {10, 0, 0, 1}});
  session.step(RigTime::from_ns(0), kept);
  EXPECT_EQ(kept.address, kLivoxBroadcast);
  EXPECT_EQ(kept.to_port, 56000);
}

}  // namespace
}  // namespace lxd::drivers_livox_device_test

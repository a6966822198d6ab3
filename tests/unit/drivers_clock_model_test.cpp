// SPDX-License-Identifier: Apache-2.0
// A sensor's clock on the rig's: convergence as a time daemon promises it, steps that are told, time that never goes
// back.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/clock_story.hpp"
#include "tests/support/property.hpp"

namespace lxd::drivers_clock_model_test {
namespace {

using test::kStart_ns;

class ClockModelStory : public test::ClockStory {};

// Given seconds of which all but three were disturbed throughout, then the line is that of the three.
TEST(LowerEnvelopes, LineIsUnderAllAndTouchesTheLowest) {
  LowerEnvelope envelope(1, 500e-6);
  const auto line_s = [](double x_s) { return 0.01 - 80e-6 * x_s; };
  for (int second = 0; second < 60; ++second) {
    const bool clean = second == 7 || second == 31 || second == 52;
    envelope.add(second, line_s(second) + (clean ? 0 : 1e-3 + 1e-4 * second + 4e-3 * ((second * 7) % 10) / 10));
  }
  EXPECT_EQ(envelope.bins(), 60U);
  EXPECT_NEAR(envelope.line().slope, -80e-6, 1e-12);
  EXPECT_NEAR(envelope.line().at(60), line_s(60), 1e-9);
  EXPECT_GT(envelope.raggedness_s(), 1e-3);
}

TEST_F(ClockModelStory, FirstPairIsBelieved) {
  EXPECT_EQ(model_.to_rig(42).ns(), 42);
  EXPECT_EQ(model_.add(5'000, RigTime::from_ns(kStart_ns)), ClockVerdict::accepted);
  EXPECT_EQ(model_.to_rig(5'000).ns(), kStart_ns);
  EXPECT_EQ(model_.to_rig(6'000).ns(), kStart_ns + 1'000);
  EXPECT_FALSE(model_.healthy(RigTime::from_ns(kStart_ns)));
}

// Given 100 ppm of skew and delays of 1 ms in the mean, when 20 s have passed, then the promise of a time daemon holds.
TEST_F(ClockModelStory, ConvergesWithin20sAtEveryRate) {
  for (const double rate_hz : {100.0, 200.0, 640.0, 1280.0}) {
    for (const double skew_ppm : {100.0, -100.0}) {
      model_ = ClockModel({});
      received_ = {};
      Wire wire;
      wire.rate_hz = rate_hz;
      wire.clock.skew_ppm = skew_ppm;
      const Errors errors = errors_after(wire, 20, 60);
      EXPECT_LT(errors.rms_s, 0.3e-3) << rate_hz;
      EXPECT_LT(errors.worst_s, 1e-3) << rate_hz;
      EXPECT_NEAR(model_.skew() * 1e6, skew_ppm, 2);
      EXPECT_TRUE(model_.healthy(received_));
      EXPECT_LT(model_.bound(received_).seconds(), 0.3e-3);
      RecordProperty("rms_us_" + std::to_string(static_cast<int>(rate_hz)), std::to_string(errors.rms_s * 1e6));
      RecordProperty("max_us_" + std::to_string(static_cast<int>(rate_hz)), std::to_string(errors.worst_s * 1e6));
    }
  }
}

TEST_F(ClockModelStory, BoundHoldsTheError) {
  const auto seed_worst = [&](std::uint64_t seed) {
    model_ = ClockModel({});
    received_ = {};
    Wire wire;
    wire.seed = seed;
    int outside = 0;
    run(wire, 0, 60, [&](double t_s, ClockVerdict, double error_s) {
      outside += t_s > 5 && std::abs(error_s) > 3 * model_.bound(received_).seconds();
    });
    return outside;
  };
  for (std::uint64_t seed = 0; seed < 5; ++seed) EXPECT_LT(seed_worst(seed), 60) << seed;
}

TEST_F(ClockModelStory, KnownLatencyIsTakenOff) {
  model_ = ClockModel({Duration::from_ns(4'000'000)});
  Wire wire;
  wire.clock.latency_s = 4e-3;
  EXPECT_LT(errors_after(wire, 20, 40).worst_s, 0.3e-3);
}

// Given time that only goes on, when the estimate improves from packet to packet, then what it gives goes on too.
TEST_F(ClockModelStory, TimeNeverGoesBackAndNeverLeaps) {
  Wire wire;
  wire.rate_hz = 1280;
  wire.clock.jitter_s = 0;
  double last_s = -1;
  bool back = false, leaps = false;
  run(wire, 0, 30, [&](double t_s, ClockVerdict, double error_s) {
    const double given_s = t_s + error_s;
    back |= given_s <= last_s;
    leaps |= last_s >= 0 && given_s - last_s > 1.01 / wire.rate_hz;  // slew and skew
    last_s = given_s;
  });
  EXPECT_FALSE(back);
  EXPECT_FALSE(leaps);
}

TEST_F(ClockModelStory, SameStampsSameTimes) {
  std::vector<double> first, second;
  Wire wire;
  run(wire, 0, 5, [&](double, ClockVerdict, double error_s) { first.push_back(error_s); });
  model_ = ClockModel({});
  received_ = {};
  run(wire, 0, 5, [&](double, ClockVerdict, double error_s) { second.push_back(error_s); });
  EXPECT_EQ(first, second);
}

// Given a learned clock, when it steps by a second either way, then a few packets later the step is told once, time is
// right to within a delay, and within 20 s as good as before.
TEST_F(ClockModelStory, StepIsToldAndLearnedAnew) {
  for (const double step_s : {1.0, -1.0, 0.2, -3600.0}) {
    for (const double rate_hz : {100.0, 1280.0}) {
      model_ = ClockModel({});
      received_ = {};
      Wire wire;
      wire.rate_hz = rate_hz;
      wire.step_s = step_s;
      wire.step_at_s = 30;
      int refused = 0;
      double at_step_s = 1;
      Errors later;
      run(wire, 0, 80, [&](double t_s, ClockVerdict verdict, double error_s) {
        refused += verdict == ClockVerdict::refused;
        if (verdict == ClockVerdict::stepped) at_step_s = error_s;
        if (t_s > 51) later.add(error_s);
      });
      EXPECT_EQ(model_.counts().steps, 1U) << step_s;
      // Four; after a step back also 64 ms (82 packets at 1280 Hz), in which they might be a queue that empties.
      EXPECT_LE(refused, step_s < 0 ? std::max(7.0, 0.1 * rate_hz) : 4) << step_s;
      EXPECT_GE(refused, 4);
      EXPECT_LT(std::abs(at_step_s), 10e-3);
      EXPECT_LT(later.rms_s, 0.3e-3);
      EXPECT_LT(later.worst_s, 1e-3);
    }
  }
}

// Given stamps that are wrong one by one, when none agrees with the next, then the clock does not move.
TEST_F(ClockModelStory, SingleWrongStampsAreRefused) {
  Wire wire;
  sim::Random random(3, "garbage");
  Errors errors;
  run(wire, 0, 40, [&](double t_s, ClockVerdict verdict, double error_s) {
    if (verdict == ClockVerdict::accepted && t_s > 20) errors.add(error_s);
    if (random.chance(0.3)) {
      const auto garbage_ns = static_cast<std::int64_t>(random.bits());
      EXPECT_EQ(model_.add(garbage_ns, received_), ClockVerdict::refused);
    }
  });
  EXPECT_EQ(model_.counts().steps, 0U);
  EXPECT_GT(model_.counts().refused, 1000U);
  EXPECT_LT(errors.worst_s, 1e-3);
}

// Given a host that stands still for 300 ms, when it reads what has come meanwhile, whose stamps run on, then all of it
// is used and at its true time; where 60 ms of it were lost on the way, what follows is refused until it fits again.
TEST_F(ClockModelStory, AHostThatWasHeldUpLosesNothing) {
  for (const int lost : {0, 8, 10, 13}) {
    model_ = ClockModel({});
    received_ = {};
    Wire wire;
    wire.rate_hz = 200;
    const sim::SensorClock clock(wire.clock, RigTime::from_ns(kStart_ns));
    run(wire, 0, 30, [](double, ClockVerdict, double) {});
    int refused = 0;
    for (int i = lost; i < 60; ++i) {
      const RigTime t = RigTime::from_ns(kStart_ns) + Duration::from_seconds(30 + i / wire.rate_hz);
      const RigTime freed = RigTime::from_ns(kStart_ns) + Duration::from_seconds(30.3) + Duration::from_ns(20'000 * i);
      const ClockVerdict verdict = model_.add(clock.sensor_ns(t), freed);
      refused += verdict == ClockVerdict::refused;
      if (verdict != ClockVerdict::accepted) continue;
      EXPECT_LT(std::abs((model_.to_rig(clock.sensor_ns(t)) - t).seconds()), 1.5e-3) << i;
    }
    EXPECT_EQ(model_.counts().steps, 0U) << lost;
    EXPECT_EQ(refused > 0, lost >= 10) << lost;  // a hole of 50 ms and more
  }
}

// Given a small step back, which time soon makes up for; then it is told as one.
TEST_F(ClockModelStory, ASmallStepBackIsNotTakenForAHeldUpHost) {
  for (const double rate_hz : {100.0, 1280.0}) {
    model_ = ClockModel({});
    received_ = {};
    Wire wire;
    wire.rate_hz = rate_hz;
    wire.step_s = -0.06;
    wire.step_at_s = 30;
    Errors at_step, later;
    run(wire, 0, 80, [&](double t_s, ClockVerdict verdict, double error_s) {
      if (t_s > 30 && verdict == ClockVerdict::accepted) at_step.add(error_s);
      if (t_s > 51) later.add(error_s);
    });
    EXPECT_EQ(model_.counts().steps, 1U) << rate_hz;
    EXPECT_LT(at_step.worst_s, 10e-3) << rate_hz;
    EXPECT_LT(later.worst_s, 1e-3);
  }
}

// Given a queue on the way that holds packets for 300 ms and then lets go of them, then that is no step.
TEST_F(ClockModelStory, StallOnTheWayIsNoStep) {
  Wire wire;
  wire.rate_hz = 1280;
  const sim::SensorClock clock(wire.clock, RigTime::from_ns(kStart_ns));
  run(wire, 0, 30, [](double, ClockVerdict, double) {});
  for (int i = 0; i < 384; ++i) {
    const RigTime t = RigTime::from_ns(kStart_ns) + Duration::from_seconds(30 + i / wire.rate_hz);
    const RigTime freed = RigTime::from_ns(kStart_ns) + Duration::from_seconds(30.3) + Duration::from_ns(10'000 * i);
    EXPECT_NE(model_.add(clock.sensor_ns(t), freed), ClockVerdict::stepped);
  }
  EXPECT_EQ(model_.counts().steps, 0U);
}

// Given an IMU on a serial line that is in use for two thirds, when the host does not read for 400 ms and then reads
// all at once, its bytes dated back by the line's rate, then that is no step either, however late the line mostly is.
TEST_F(ClockModelStory, StallOfASerialLineIsNoStep) {
  for (const double late_s : {0.1e-3, 1e-3, 3e-3, 5e-3}) {
    model_ = ClockModel({});
    received_ = {};
    Wire wire;
    wire.rate_hz = 200;
    wire.clock.latency_jitter_s = late_s;
    const sim::SensorClock clock(wire.clock, RigTime::from_ns(kStart_ns));
    run(wire, 0, 30, [](double, ClockVerdict, double) {});
    const int frames = 80;
    for (int i = 0; i < frames; ++i) {
      const RigTime t = RigTime::from_ns(kStart_ns) + Duration::from_seconds(30 + i / wire.rate_hz);
      const RigTime freed = RigTime::from_ns(kStart_ns) + Duration::from_seconds(30.4 - 3.3e-3 * (frames - i));
      EXPECT_NE(model_.add(clock.sensor_ns(t), freed), ClockVerdict::stepped) << late_s;
    }
    EXPECT_EQ(model_.counts().steps, 0U) << late_s;
  }
}

// Given a sensor that is off for 5 s and comes back on the same clock, then time is right at once.
TEST_F(ClockModelStory, GapIsBridged) {
  Wire wire;
  run(wire, 0, 30, [](double, ClockVerdict, double) {});
  EXPECT_FALSE(model_.healthy(received_ + Duration::from_seconds(5)));
  Errors errors;
  run(wire, 35, 40, [&](double, ClockVerdict, double error_s) { errors.add(error_s); });
  EXPECT_LT(errors.worst_s, 1e-3);
  EXPECT_EQ(model_.counts().steps, 0U);
  EXPECT_TRUE(model_.healthy(received_));
}

// Whatever numbers come: no overflow, no step from nothing, an answer for every stamp.
TEST_F(ClockModelStory, AnyNumbersAreSurvived) {
  test::check_property([] {
    ClockModel model{{}};
    sim::Random random(static_cast<std::uint64_t>(*rc::gen::arbitrary<int>()), "any");
    for (int i = 0; i < 50; ++i) {
      const auto stamp_ns = static_cast<std::int64_t>(random.bits() >> (random.bits() % 64U));
      const auto received = RigTime::from_ns(static_cast<std::int64_t>(random.bits() >> (random.bits() % 64U)));
      model.add(stamp_ns, received);
      model.add_edge(received);
      (void)model.to_rig(stamp_ns);
      (void)model.bound(RigTime::from_ns(kStart_ns));
    }
  });
}

}  // namespace
}  // namespace lxd::drivers_clock_model_test

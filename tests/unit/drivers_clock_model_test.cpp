// SPDX-License-Identifier: Apache-2.0
// A sensor's clock on the rig's: convergence as a time daemon promises it, steps that are told, time that never goes
// back, pulses with their glitches and holes.
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/sync/clock_model.hpp"
#include "tests/support/property.hpp"
#include "tools/simulator/clock.hpp"

namespace lxd {
namespace {

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

// A sensor that sends packets, with the truth beside them.
class ClockModelStory : public testing::Test {
 protected:
  struct Wire {
    double rate_hz = 100;
    sim::ClockConfig clock{3.7, 100, 0, 0, 1e-3};  // offset s, skew ppm, stamp jitter s, latency s, its jitter s
    double step_s = 0, step_at_s = 1e9;
    std::uint64_t seed = 1;
  };
  struct Errors {
    double rms_s = 0, worst_s = 0;
    std::size_t count = 0;
    void add(double error_s) {
      worst_s = std::max(worst_s, std::abs(error_s));
      rms_s =
          std::sqrt((rms_s * rms_s * static_cast<double>(count) + error_s * error_s) / static_cast<double>(count + 1));
      ++count;
    }
  };

  // Runs from begin to end seconds; calls after(t, verdict, error) for each packet.
  void run(const Wire& wire, double begin_s, double end_s,
           const std::function<void(double, ClockVerdict, double)>& after) {
    const sim::SensorClock clock(wire.clock, RigTime::from_ns(kStart_ns));
    sim::Random random(wire.seed, "wire");
    for (auto i = static_cast<std::int64_t>(begin_s * wire.rate_hz);; ++i) {
      const double t_s = static_cast<double>(i) / wire.rate_hz;
      if (t_s >= end_s) return;
      const RigTime t = RigTime::from_ns(kStart_ns) + Duration::from_seconds(t_s);
      const double step_s = t_s >= wire.step_at_s ? wire.step_s : 0;
      const std::int64_t stamp_ns = clock.stamped_ns(t, random) + Duration::from_seconds(step_s).ns();
      received_ = std::max(received_, clock.received(t, random));
      const ClockVerdict verdict = model_.add(stamp_ns, received_);
      const RigTime mapped = model_.to_rig(stamp_ns);
      after(t_s, verdict, (mapped - t).seconds());
    }
  }

  Errors errors_after(const Wire& wire, double from_s, double end_s) {
    Errors errors;
    run(wire, 0, end_s, [&](double t_s, ClockVerdict, double error_s) {
      if (t_s >= from_s) errors.add(error_s);
    });
    return errors;
  }

  ClockModel model_{{}};
  RigTime received_ = RigTime::from_ns(0);
};

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
      // Four; after a step back also 20 ms (25 packets at 1280 Hz), in which they might be a queue that empties.
      EXPECT_LE(refused, rate_hz > 1000 && step_s < 0 ? 60 : 4) << step_s;
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

// A receiver's messages, 80 ms late, and its pulse.
class ClockPulseStory : public ClockModelStory {
 protected:
  ClockPulseStory() {
    wire_.rate_hz = 5;
    wire_.clock = {0.25, 40, 0, 80e-3, 10e-3};
  }

  // The sensor's seconds from begin to end, with their messages; calls after(t, error) at each.
  void run_pulses(int begin, int end, const std::function<void(double, double)>& after, bool pulses = true) {
    const sim::SensorClock clock(wire_.clock, RigTime::from_ns(kStart_ns));
    for (int second = begin; second < end; ++second) {
      run(wire_, second, second + 1, [](double, ClockVerdict, double) {});
      // The instant at which the sensor's clock shows a whole second.
      const std::int64_t whole_ns = kStart_ns + (second + 1) * kNanosPerSecond;
      RigTime edge = RigTime::from_ns(whole_ns);
      for (int i = 0; i < 4; ++i) edge = edge - Duration::from_ns(clock.sensor_ns(edge) - whole_ns);
      const Duration late = Duration::from_seconds(-5e-6 * std::log(1 - random_.uniform()));
      if (pulses) model_.add_edge(edge + late);
      after(second, (model_.to_rig(whole_ns) - edge).seconds());
    }
  }

  Wire wire_;
  sim::Random random_{5, "pulse"};
};

TEST_F(ClockPulseStory, PulseTakesOffTheUnknownLatency) {
  Errors before, after;
  run_pulses(0, 60,
             [&](double t_s, double error_s) { (t_s < 2 ? before : after).add(t_s < 2 || t_s > 30 ? error_s : 0); });
  EXPECT_TRUE(model_.pulse_locked());
  EXPECT_GT(before.worst_s, 50e-3);
  EXPECT_LT(after.worst_s, 50e-6);
  EXPECT_NEAR(model_.skew() * 1e6, 40, 1);
  EXPECT_LT(model_.bound(received_).seconds(), 100e-6);
}

// Ten minutes without a pulse.
TEST_F(ClockPulseStory, MissingPulsesAreHeldOver) {
  run_pulses(0, 90, [](double, double) {});
  Errors errors;
  run_pulses(
      90, 690, [&](double, double error_s) { errors.add(error_s); }, false);
  EXPECT_TRUE(model_.pulse_locked());
  EXPECT_LT(errors.worst_s, 0.3e-3);
  EXPECT_GT(model_.bound(received_).seconds(), errors.worst_s);
  run_pulses(690, 720, [&](double, double error_s) { errors.add(error_s); });
  EXPECT_EQ(model_.counts().relocks, 0U);
  EXPECT_LT(errors.worst_s, 0.3e-3);
}

TEST_F(ClockPulseStory, GlitchesAreRefusedAndCounted) {
  run_pulses(0, 30, [](double, double) {});
  Errors errors;
  for (int second = 30; second < 90; ++second) {
    const RigTime spurious = RigTime::from_ns(kStart_ns) + Duration::from_seconds(second + random_.uniform(0.3, 0.9));
    EXPECT_EQ(model_.add_edge(spurious), ClockVerdict::refused);
    run_pulses(second, second + 1, [&](double, double error_s) { errors.add(error_s); });
  }
  EXPECT_EQ(model_.counts().glitches, 60U);
  EXPECT_EQ(model_.counts().relocks, 0U);
  EXPECT_LT(errors.worst_s, 50e-6);
}

// Given a leap second, when the messages say a second less at the same pulses, then that is a step of the labels: told,
// and what it gives stays the rig's.
TEST_F(ClockPulseStory, LeapSecondIsAStepOfTheLabels) {
  run_pulses(0, 60, [](double, double) {});
  wire_.clock.offset_s -= 1;
  const sim::SensorClock clock(wire_.clock, RigTime::from_ns(kStart_ns));
  Errors errors;
  run_pulses(61, 120, [&](double t_s, double error_s) {
    if (t_s > 85) errors.add(error_s);
  });
  EXPECT_EQ(model_.counts().steps, 1U);
  EXPECT_TRUE(model_.pulse_locked());
  EXPECT_LT(errors.worst_s, 50e-6);
}

TEST_F(ClockPulseStory, PulseBeforeTheFirstMessageIsRefused) {
  EXPECT_EQ(model_.add_edge(RigTime::from_ns(kStart_ns)), ClockVerdict::refused);
}

}  // namespace
}  // namespace lxd

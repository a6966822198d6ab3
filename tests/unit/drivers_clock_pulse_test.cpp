// SPDX-License-Identifier: Apache-2.0
// A clock with a pulse per second: pulses with their glitches and holes, and a leap second.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/clock_story.hpp"

namespace lxd::drivers_clock_pulse_test {
namespace {

using test::kStart_ns;

// A receiver's messages, 80 ms late, and its pulse.
class ClockPulseStory : public test::ClockStory {
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
}  // namespace lxd::drivers_clock_pulse_test

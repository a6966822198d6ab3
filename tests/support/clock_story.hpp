// SPDX-License-Identifier: Apache-2.0
// A sensor that sends packets to a clock model, with the truth beside them.
#pragma once

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "drivers/sync/clock_model.hpp"
#include "tools/simulator/clock.hpp"

namespace lxd::test {

inline constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

class ClockStory : public testing::Test {
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

}  // namespace lxd::test

// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/clock_keys.hpp"

namespace lxd::sim {
namespace {

// A clock may be years off (a sensor that counts from its own start), but its stamps must stay representable.
constexpr ValueRange kOffset{-2e9, 2e9, "s", "is it in nanoseconds?"};
constexpr ValueRange kSkew{-1000, 1000, "ppm", "is it in parts per billion?"};
constexpr ValueRange kJitter{0, 0.1, "s", "is it in milliseconds?"};
constexpr ValueRange kLatency{0, 1, "s", "is it in milliseconds?"};

}  // namespace

void read_keys(YamlSection& section, ClockConfig& clock) {
  section.read("offset_s", clock.offset_s, kOffset);
  section.read("skew_ppm", clock.skew_ppm, kSkew);
  section.read("jitter_s", clock.jitter_s, kJitter);
  section.read("latency_s", clock.latency_s, kLatency);
  section.read("latency_jitter_s", clock.latency_jitter_s, kLatency);
}

}  // namespace lxd::sim

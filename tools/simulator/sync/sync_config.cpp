// SPDX-License-Identifier: Apache-2.0
// See sync_config.hpp.
#include "tools/simulator/sync/sync_config.hpp"

namespace lxd::sim {

void read_keys(YamlSection& section, SyncConfig& config) {
  constexpr ValueRange kJitter{0, 0.1, "s", "is it in microseconds?"};
  constexpr ValueRange kProbability{0, 1, "", "is it in per cent?"};
  constexpr ValueRange kPulse{1e-6, 0.9, "s", "is it in milliseconds?"};
  section.read("jitter_s", config.jitter_s, kJitter);
  section.read("missing_probability", config.missing_probability, kProbability);
  section.read("spurious_probability", config.spurious_probability, kProbability);
  section.read("pulse_s", config.pulse_s, kPulse);
}

}  // namespace lxd::sim

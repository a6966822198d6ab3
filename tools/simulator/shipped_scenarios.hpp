// SPDX-License-Identifier: Apache-2.0
// The scenarios that come with the program (tools/scenarios).
#pragma once

#include <span>
#include <string_view>

namespace lxd::sim {

struct ShippedScenario {
  std::string_view name;
  std::string_view text;  // YAML
};

std::span<const ShippedScenario> shipped_scenarios();  // sorted by name

}  // namespace lxd::sim

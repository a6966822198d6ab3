// SPDX-License-Identifier: Apache-2.0
// Worlds out of nothing but a kind and a seed: the same seed gives the same triangles.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "rt/result.hpp"
#include "tools/simulator/world/world.hpp"

namespace lxd::sim {

struct WorldKind {
  std::string_view name;
  std::string_view what;  // one line for help
};
[[nodiscard]] std::span<const WorldKind> world_kinds();

// Error: an unknown kind, with the known ones.
Result<World> make_world(std::string_view kind, std::uint64_t seed);

// The route of that name, or null.
[[nodiscard]] const Route* find_route(const World& world, std::string_view name);

// One maker a kind.
[[nodiscard]] World make_building(std::uint64_t seed);
[[nodiscard]] World make_campus(std::uint64_t seed);
[[nodiscard]] World make_street(std::uint64_t seed);
[[nodiscard]] World make_parking(std::uint64_t seed);
[[nodiscard]] World make_tunnel(std::uint64_t seed);
[[nodiscard]] World make_field(std::uint64_t seed);

}  // namespace lxd::sim

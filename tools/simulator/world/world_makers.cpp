// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/world_makers.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

namespace lxd::sim {
namespace {

struct Maker {
  std::string_view name;
  World (*make)(std::uint64_t seed);
};

constexpr std::array<WorldKind, 6> kKinds{
    {{"building", "two floors of furnished rooms, a corridor, stairs, glass; routes: walk"},
     {"campus", "houses, trees and cars on gentle relief, 200 m x 200 m; routes: walk, drive, fly"},
     {"street", "houses on both sides of a loop of more than 1 km; routes: drive, walk"},
     {"parking", "a walled yard with rows of cars, flat; routes: drive, walk"},
     {"tunnel", "420 m of smooth tube, degenerate on purpose; routes: drive"},
     {"field", "grass to the horizon, degenerate on purpose; routes: drive, walk"}}};
constexpr std::array<Maker, 6> kMakers{{{"building", make_building},
                                        {"campus", make_campus},
                                        {"street", make_street},
                                        {"parking", make_parking},
                                        {"tunnel", make_tunnel},
                                        {"field", make_field}}};

}  // namespace

std::span<const WorldKind> world_kinds() { return kKinds; }

Result<World> make_world(std::string_view kind, std::uint64_t seed) {
  const auto* const maker = std::ranges::find(kMakers, kind, &Maker::name);
  if (maker != kMakers.end()) return maker->make(seed);
  std::string known;
  for (const WorldKind& each : kKinds) known += fmt::format("{}{}", known.empty() ? "" : ", ", each.name);
  return Error{fmt::format("world: found '{}', wanted one of {} or a .ply or .obj file", kind, known)};
}

const Route* find_route(const World& world, std::string_view name) {
  const auto found = std::ranges::find(world.routes, name, &Route::name);
  return found == world.routes.end() ? nullptr : &*found;
}

}  // namespace lxd::sim

// SPDX-License-Identifier: Apache-2.0
// What the made worlds are made of.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/world/world.hpp"

namespace lxd::sim {

// Numbers of standard_materials().
enum class Surface : std::uint16_t {
  asphalt,
  paving,
  concrete,
  grass,
  plaster,
  plaster_warm,
  brick,
  stone,
  ceiling,
  carpet,
  wood,
  wood_dark,
  metal,
  fabric,
  poster,
  paint_red,
  paint_blue,
  paint_white,
  black,
  foliage,
  bark,
  sign,
  glass,
  person,
  vehicle,
};

[[nodiscard]] std::vector<Material> standard_materials();

}  // namespace lxd::sim

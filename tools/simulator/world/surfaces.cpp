// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/surfaces.hpp"

namespace lxd::sim {

// Albedos near 0.9 um and in daylight, rounded, of the order of Oke, "Boundary Layer Climates", 1987, table 1.1;
// contrasts and texels so that a camera finds corners at the distances at which it sees each surface.
std::vector<Material> standard_materials() {
  return {
      {"asphalt", 0.16F, 0.45F, 0.30F, {1, 1, 1}},
      {"paving", 0.40F, 0.40F, 0.60F, {1, 0.97F, 0.92F}},
      {"concrete", 0.42F, 0.35F, 0.50F, {1, 1, 0.97F}},
      {"grass", 0.35F, 0.55F, 0.40F, {0.5F, 1, 0.35F}},
      {"plaster", 0.68F, 0.35F, 0.60F, {1, 1, 0.98F}},
      {"plaster_warm", 0.55F, 0.40F, 0.70F, {1, 0.9F, 0.7F}},
      {"brick", 0.32F, 0.55F, 0.28F, {1, 0.6F, 0.5F}},
      {"stone", 0.35F, 0.50F, 0.45F, {0.95F, 0.95F, 1}},
      {"ceiling", 0.75F, 0.25F, 0.60F, {1, 1, 1}},
      {"carpet", 0.30F, 0.50F, 0.40F, {0.8F, 0.85F, 1}},
      {"wood", 0.50F, 0.40F, 0.15F, {1, 0.8F, 0.55F}},
      {"wood_dark", 0.25F, 0.50F, 0.12F, {1, 0.75F, 0.5F}},
      {"metal", 0.35F, 0.25F, 0.30F, {0.95F, 0.97F, 1}},
      {"fabric", 0.40F, 0.40F, 0.10F, {0.6F, 0.75F, 1}},
      {"poster", 0.50F, 0.90F, 0.16F, {1, 1, 1}},
      {"paint_red", 0.40F, 0.15F, 0.50F, {1, 0.2F, 0.15F}},
      {"paint_blue", 0.35F, 0.15F, 0.50F, {0.25F, 0.4F, 1}},
      {"paint_white", 0.80F, 0.15F, 0.50F, {1, 1, 1}},
      {"black", 0.06F, 0.30F, 0.20F, {1, 1, 1}},
      {"foliage", 0.45F, 0.60F, 0.15F, {0.35F, 1, 0.25F}},
      {"bark", 0.25F, 0.60F, 0.08F, {1, 0.85F, 0.7F}},
      {"sign", 0.95F, 0.60F, 0.20F, {1, 0.95F, 0.9F}},
      {"glass", 0.06F, 0.20F, 0.80F, {0.8F, 0.9F, 1}, true},
      {"person", 0.40F, 0.70F, 0.25F, {1, 0.85F, 0.8F}},
      {"vehicle", 0.45F, 0.40F, 0.50F, {0.8F, 0.85F, 1}},
  };
}

}  // namespace lxd::sim

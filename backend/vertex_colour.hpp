// SPDX-License-Identifier: Apache-2.0
// The colour of a vertex or point, as cameras saw it.
#pragma once

#include <cstdint>

namespace lxd {

// sRGB (IEC 61966-2-1).
struct VertexColour {
  std::uint8_t red = 128, green = 128, blue = 128;
  std::uint8_t views = 0;  // images that it was told from; 0: none saw it, and the colour is a neutral grey

  [[nodiscard]] bool known() const { return views > 0; }
  bool operator==(const VertexColour&) const = default;
};
static_assert(sizeof(VertexColour) == 4);

}  // namespace lxd

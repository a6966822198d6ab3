// SPDX-License-Identifier: Apache-2.0
#include "backend/seams/seam_scale.hpp"

#include <algorithm>
#include <vector>

namespace lxd {

float edge_length_m(std::span<const MeshVertex> vertices, std::span<const MeshFace> faces) {
  constexpr std::size_t kSamples = 3000;
  std::vector<float> lengths_m;
  for (std::size_t i = 0; i < faces.size(); i += faces.size() / kSamples + 1)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3f &a = vertices[faces[i][corner]].position_m,
                            &b = vertices[faces[i][(corner + 1) % 3]].position_m;
      if (const float length_m = (b - a).norm(); std::isfinite(length_m)) lengths_m.push_back(length_m);
    }
  if (lengths_m.empty()) return 0;
  const auto median = lengths_m.begin() + static_cast<std::ptrdiff_t>(lengths_m.size() / 2);
  std::ranges::nth_element(lengths_m, median);
  return *median;
}

}  // namespace lxd

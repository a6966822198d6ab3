// SPDX-License-Identifier: Apache-2.0
// What a ray into the map costs, near and far.
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/support/cast_scene.hpp"

namespace lxd {
namespace {

// A hall of `size` metres, rays from its middle everywhere but into the open ceiling.
void cast_rays_in_a_hall(benchmark::State& state) {
  test::CastScene scene;
  const auto size = static_cast<float>(state.range(0));
  scene.add_room({0, 0, 0}, {size, size, 4});
  scene.fuse({size / 2, size / 2, 1.5F}, 10);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<Ray> rays;
  for (int i = 0; i < 1000; ++i)
    rays.push_back({{size / 2, size / 2, 1.5},
                    Eigen::Vector3d(any(scene.random), any(scene.random), 0.3 * any(scene.random)).normalized(),
                    80});
  std::size_t i = 0, hits = 0;
  RayHit hit{};
  for (auto _ : state) {
    hits += cast_ray(scene.map, rays[i], hit);
    i = (i + 1) % rays.size();
  }
  state.counters["hits"] = benchmark::Counter(static_cast<double>(hits), benchmark::Counter::kAvgIterations);
}
BENCHMARK(cast_rays_in_a_hall)->Arg(6)->Arg(20);

}  // namespace
}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// Bidirectional PnP against forward-only, by the angle between the two looks: how often the pose is found within half a
// metre, and how far off it then is.
#include <algorithm>
#include <vector>

#include <benchmark/benchmark.h>

#include "backend/pnp/bidirectional_pnp.hpp"
#include "tests/support/sight_scene.hpp"

namespace lxd {
namespace {

constexpr unsigned kScenes = 100;
constexpr double kFound_m = 0.5;

// Ranges: angle (hundredths of a radian), share of old features with a distance (percent), both ways or forward only.
void look_again(benchmark::State& state) {
  const double turn_rad = 0.01 * static_cast<double>(state.range(0));
  // The farther apart the looks, the fewer descriptors hold.
  const test::SightConfig scene_config{.turn_rad = turn_rad,
                                       .points = 90,
                                       .historical_points = 0.01 * static_cast<double>(state.range(1)),
                                       .wrong = 0.2 + 0.4 * turn_rad};
  PnpConfig config;
  config.backward = state.range(2) != 0;
  std::vector<test::SightScene> scenes;
  for (unsigned seed = 1; seed <= kScenes; ++seed) scenes.emplace_back(scene_config, seed);
  std::vector<double> errors_m;
  double accepted = 0;
  std::size_t i = 0;
  for (auto _ : state) {
    const test::SightScene& scene = scenes[i++ % kScenes];
    const auto loop = visual_loop(scene.historical, scene.current, config);
    if (i > kScenes || !loop) continue;
    accepted += 1;
    const double error_m = (loop->T_from_to.p - scene.T_from_to().p).norm();
    if (error_m < kFound_m) errors_m.push_back(error_m);
  }
  std::sort(errors_m.begin(), errors_m.end());
  const auto done = static_cast<double>(std::min<std::size_t>(i, kScenes));
  state.counters["found"] = static_cast<double>(errors_m.size()) / done;
  state.counters["false"] = (accepted - static_cast<double>(errors_m.size())) / done;
  state.counters["median_m"] = errors_m.empty() ? 0 : errors_m[errors_m.size() / 2];
}
BENCHMARK(look_again)
    ->Name("pnp")
    ->ArgNames({"turn", "old_points", "both"})
    ->ArgsProduct({{20, 60, 90, 120}, {90, 35}, {0, 1}})
    ->Iterations(kScenes)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lxd

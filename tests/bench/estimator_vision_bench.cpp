// SPDX-License-Identifier: Apache-2.0
// What an image costs the real-time thread: features taken up, residuals of five iterations, distances, judgement.
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/support/feature_scene.hpp"

namespace lxd {
namespace {

void features_of_an_image(benchmark::State& state) {
  test::FeatureScene scene(true);
  scene.add_on_surfaces(150);
  scene.add_in_the_air(50);
  test::OwnedArena arena(std::size_t{1} << 20);
  FeatureStore store(scene.camera, {}, *arena);
  std::vector<FeatureFrame> frames;
  constexpr int kImages = 40;
  for (int i = 0; i < kImages; ++i) frames.push_back(scene.frame(0.1 * i));
  std::vector<VisualResidual> residuals(kFeaturesMax);
  std::vector<float> scratch(kFeaturesMax);
  std::size_t next = 0, used = 0;
  for (auto _ : state) {
    if (next == 0) store.clear();
    const Pose T = test::FeatureScene::pose(0.1 * static_cast<double>(next));
    State x;
    x.R = T.R;
    x.p = T.p;
    store.begin(frames[next]);
    const auto landmarks = store.landmarks();
    double scale = 1;
    for (int iteration = 0; iteration < 5; ++iteration) {
      std::size_t count = 0;
      for (const VisualObservation& seen : landmarks)
        count += reproject(seen, SweepPath::knot(x, 0.02), scene.camera, 0.5, residuals[count]);
      const auto all = std::span(residuals).first(count);
      scale = visual_scale(all, scratch);
      benchmark::DoNotOptimize(accumulate(all, scale, kernel_sigmas(iteration)));
      used += count;
    }
    store.conclude(T, scene.cast.map, scale);
    next = (next + 1) % kImages;
  }
  state.counters["residuals"] = benchmark::Counter(static_cast<double>(used) / 5, benchmark::Counter::kAvgIterations);
}
BENCHMARK(features_of_an_image)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace lxd

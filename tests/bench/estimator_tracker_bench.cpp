// SPDX-License-Identifier: Apache-2.0
// What an image of 640 x 480 costs the vision thread.
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/support/cameras.hpp"
#include "tests/support/texture_video.hpp"

namespace lxd {
namespace {

void track_an_image(benchmark::State& state) {
  test::TextureVideo video;
  std::vector<test::VideoImage> images;
  for (int i = 0; i < 6; ++i) images.push_back(video.image(test::motion(0.01 * i, 1, 5 * i, -3 * i), 0));
  FeatureTracker tracker(CameraModel(test::radtan_camera()), {});
  FeatureFrame frame;
  std::int64_t ns = 0;
  for (auto _ : state) {
    const std::size_t there_and_back = static_cast<std::size_t>(ns) % 10;
    GreyImage image = images[there_and_back < 6 ? there_and_back : 10 - there_and_back].grey;
    image.stamp = RigTime::from_ns(++ns);
    benchmark::DoNotOptimize(tracker.track(image, {}, frame));
  }
  state.counters["features"] = frame.count;
}
BENCHMARK(track_an_image)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lxd

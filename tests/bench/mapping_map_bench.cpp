// SPDX-License-Identifier: Apache-2.0
// What the map costs: a regression, a sweep's insertion, a query, the extraction of a sub-mesh's mesh.
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "mapping/surface_map.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd {
namespace {

void regress_full_batch(benchmark::State& state) {
  const GpKernel kernel{2.0F, 0.01F, 0.5F};
  GpBatch batch;
  batch.count = static_cast<int>(state.range(0));
  for (int i = 0; i < batch.count; ++i) {
    batch.u_m[i] = 0.05F + 0.1F * static_cast<float>(i % kQuadsPerEdge);
    batch.v_m[i] = 0.05F + 0.1F * static_cast<float>(i / kQuadsPerEdge);
    batch.height_m[i] = 0.2F + 0.01F * static_cast<float>(i % 3);
    batch.noise_m2[i] = 1e-4F;
  }
  GpPrediction out;
  for (auto _ : state) {
    regress(batch, kernel, amplitude_of(batch, kernel), out);
    benchmark::DoNotOptimize(out);
  }
}
BENCHMARK(regress_full_batch)->Arg(5)->Arg(25);

// 30,000 returns of a hall of 20 m x 20 m x 5 m, about its middle.
std::vector<MapPoint> hall_sweep(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> across(-10, 10), up(-1.5F, 3.5F);
  std::normal_distribution<float> noise(0, 0.01F);
  std::vector<MapPoint> points;
  for (int i = 0; i < 30'000; ++i) {
    Eigen::Vector3f p(across(random), across(random), up(random));
    if (i % 2 == 0)
      p.z() = -1.5F + noise(random);
    else
      p[i % 4 / 2] = (i % 8 < 4 ? 10.0F : -10.0F) + noise(random);
    points.push_back({p, 1e-4F});
  }
  return points;
}

void sub_mesh_insert_30k(benchmark::State& state) {
  MappingConfig config;
  if (state.range(0) == 0) config.converged_sigma_m = 0;  // no cell rests
  test::MappingScene scene(config, {10'000, 12'000, 10'000, 30'000});
  std::uint32_t sweep = 0;
  std::vector<std::vector<MapPoint>> sweeps;
  for (unsigned seed = 0; seed < 10; ++seed) sweeps.push_back(hall_sweep(seed));
  for (auto _ : state) {
    scene.sub_mesh.insert(sweeps[sweep % sweeps.size()], Eigen::Vector3d::Zero(), {0, 0, 0}, sweep);
    ++sweep;
  }
  state.counters["layers"] = scene.sub_mesh.layer_count();
}
BENCHMARK(sub_mesh_insert_30k)->ArgName("resting")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void surface_map_nearest(benchmark::State& state) {
  test::OwnedArena arena(std::size_t{64} << 20);
  const SubMeshCapacity capacity{10'000, 12'000, 10'000, 30'000};
  SurfaceMap map({}, {capacity, capacity}, *arena);
  for (unsigned seed = 0; seed < 10; ++seed) {
    const auto points = hall_sweep(seed);
    map.insert({points, std::span(points).first(5000), Eigen::Vector3d::Zero(), {0, 0, 0}, RigTime::from_ns(seed)});
  }
  const auto queries = hall_sweep(99);
  std::size_t i = 0;
  SurfaceHit hit{};
  for (auto _ : state) {
    benchmark::DoNotOptimize(map.nearest(queries[i].position_m.cast<double>(), hit));
    i = (i + 1) % queries.size();
  }
}
BENCHMARK(surface_map_nearest);

void mesh_extract_hall(benchmark::State& state) {
  test::MappingScene scene({}, {10'000, 12'000, 10'000, 30'000}, {12'000, 300'000, 100'000, 200'000, 50'000});
  for (unsigned seed = 0; seed < 20; ++seed)
    scene.sub_mesh.insert(hall_sweep(seed), Eigen::Vector3d::Zero(), {0, 0, 0}, seed);
  MeshExtraction::Mesh mesh;
  for (auto _ : state) mesh = scene.mesh();
  state.counters["faces"] = static_cast<double>(mesh.faces.size());
}
BENCHMARK(mesh_extract_hall)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lxd

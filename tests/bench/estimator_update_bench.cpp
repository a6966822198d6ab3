// SPDX-License-Identifier: Apache-2.0
// What the filter costs: rows and sums of an iteration, thinning and deskewing a sweep, a whole update, a whole sweep.
#include <vector>

#include <benchmark/benchmark.h>

#include "estimator/ieskf.hpp"
#include "mapping/lattice.hpp"
#include "tests/support/room_sweeps.hpp"

namespace lxd {
namespace {

constexpr int kBenchBeams = 64, kBenchColumns = 1024;
constexpr double kEdge_m = 0.36;  // about 2500 points of the room
constexpr ConstantVelocityNoise kNoise{1.0, 2.0};

State walking() {
  State x;
  x.v = {0.8, 0.1, 0.0};
  x.b_g = {0, 0, -0.3};
  return x;
}

// A sweep of the room, its thinned points, and a map that has seen ten.
class RoomBench {
 public:
  RoomBench() : arena_(std::size_t{64} << 20), map({}, {kCapacity, kCapacity}, *arena_), slots_(16'384) {
    sweeps.beams = kBenchBeams;
    sweeps.columns = kBenchColumns;
    path.set(propagate(walking(), test::kSweepSpan.seconds()), test::kSweepSpan);
    for (int i = 0; i < 10; ++i) insert(sweeps.next(walking(), 0));
    thin();
    residuals.resize(points.size());
  }

  void thin() {
    VoxelSet voxels(slots_);
    points.clear();
    for (const LidarPoint& p : sweeps.points()) {
      const Eigen::Vector3f q(p.x_m, p.y_m, p.z_m);
      if (voxels.insert(pack((q / static_cast<float>(kEdge_m)).array().floor().cast<int>().matrix())))
        points.push_back({q.cast<double>(), p.offset_ns, 1e-4F});
    }
  }

  test::RoomSweeps sweeps;
  SweepPath path;
  std::vector<RegistrationPoint> points;
  std::vector<PointResidual> residuals;

 private:
  static constexpr SubMeshCapacity kCapacity{8000, 10'000, 4000, kBenchBeams* kBenchColumns};

  void insert(const Sweep& sweep) {
    deskewed_.clear();
    for (const LidarPoint& p : sweep.points())
      deskewed_.push_back({path.to_local({p.x_m, p.y_m, p.z_m}, p.offset_ns), 1e-4F});
    map.insert({deskewed_, {}, path.origin(), {0, 0, 0}, sweep.end});
  }

  test::OwnedArena arena_;
  std::vector<MapPoint> deskewed_;

 public:
  SurfaceMap map;

 private:
  std::vector<VoxelSet::Slot> slots_;
};

RoomBench& room() {
  static RoomBench bench;
  return bench;
}

void estimator_associate(benchmark::State& state) {
  RoomBench& b = room();
  std::size_t found = 0;
  for (auto _ : state) found = associate(b.points, b.path, Eigen::Vector3d::Zero(), b.map, b.residuals).size();
  state.counters["points"] = static_cast<double>(b.points.size());
  state.counters["residuals"] = static_cast<double>(found);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(b.points.size()));
}
BENCHMARK(estimator_associate)->Unit(benchmark::kMicrosecond);

void estimator_normal_equations(benchmark::State& state) {
  RoomBench& b = room();
  const auto residuals = associate(b.points, b.path, Eigen::Vector3d::Zero(), b.map, b.residuals);
  std::vector<float> scratch(residuals.size());
  for (auto _ : state) {
    const double scale = residual_scale(residuals, scratch);
    benchmark::DoNotOptimize(accumulate(residuals, scale, kernel_sigmas(3)));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(residuals.size()));
}
BENCHMARK(estimator_normal_equations)->Unit(benchmark::kMicrosecond);

void estimator_degeneracy(benchmark::State& state) {
  RoomBench& b = room();
  const auto residuals = associate(b.points, b.path, Eigen::Vector3d::Zero(), b.map, b.residuals);
  NormalEquations measured = accumulate(residuals, 1, 2.5);
  const LidarMatrix prior_root = 0.1 * LidarMatrix::Identity();
  for (auto _ : state) {
    measured.motion = motion_of(residuals, b.points, b.path);
    NormalEquations sums = measured;
    discount(find_degeneracy(sums, prior_root, 9e-4), sums);
    benchmark::DoNotOptimize(sums);
  }
}
BENCHMARK(estimator_degeneracy)->Unit(benchmark::kMicrosecond);

void estimator_downsample(benchmark::State& state) {
  RoomBench& b = room();
  for (auto _ : state) b.thin();
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(b.sweeps.points().size()));
}
BENCHMARK(estimator_downsample)->Unit(benchmark::kMicrosecond);

void estimator_deskew(benchmark::State& state) {
  RoomBench& b = room();
  SweepPath path;
  std::vector<Eigen::Vector3f> out(b.sweeps.points().size());
  for (auto _ : state) {
    path.set(walking(), test::kSweepSpan);
    std::size_t i = 0;
    for (const LidarPoint& p : b.sweeps.points()) out[i++] = path.to_local({p.x_m, p.y_m, p.z_m}, p.offset_ns);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(out.size()));
}
BENCHMARK(estimator_deskew)->Unit(benchmark::kMicrosecond);

// Prediction and one iteration's algebra, without points.
void estimator_filter_algebra(benchmark::State& state) {
  RoomBench& b = room();
  const NormalEquations sums =
      accumulate(associate(b.points, b.path, Eigen::Vector3d::Zero(), b.map, b.residuals), 1, 2.5);
  Ieskf filter;
  StateMatrix P = StateMatrix::Zero();
  P.diagonal().head<kLidarDim>().setConstant(1e-4);
  filter.reset(walking(), P);
  for (auto _ : state) {
    filter.predict(0.1, kNoise);
    filter.begin_update();
    benchmark::DoNotOptimize(filter.iterate(sums));
    benchmark::DoNotOptimize(filter.conclude());
  }
}
BENCHMARK(estimator_filter_algebra)->Unit(benchmark::kMicrosecond);

// A sweep's whole life in the room, map included; the carrier stands.
void estimator_sweep(benchmark::State& state) {
  const auto points_max = static_cast<std::uint32_t>(kBenchBeams * kBenchColumns);
  test::OwnedOdometry odometry(test::small_setup(points_max));
  Sweep sweep = room().sweeps.next(State{}, 0);
  double iterations = 0;
  for (auto _ : state) {
    const SweepOutcome& outcome = odometry->step(sweep);
    iterations += outcome.iterations;
    for (RigTime* time : {&sweep.begin, &sweep.end, &sweep.stamp}) *time = *time + test::kSweepSpan;
  }
  state.counters["iterations"] = iterations / static_cast<double>(state.iterations());
}
BENCHMARK(estimator_sweep)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// What measuring costs the real-time thread, and the rotation group.
#include <cstdint>

#include <benchmark/benchmark.h>

#include "rt/allocation_guard.hpp"
#include "rt/latency_histogram.hpp"
#include "rt/page_faults.hpp"
#include "rt/so3.hpp"
#include "rt/stopwatch.hpp"

namespace lxd {
namespace {

void histogram_add(benchmark::State& state) {
  LatencyHistogram histogram;
  std::int64_t ns = 1;
  for (auto _ : state) {
    histogram.add(Duration::from_ns(ns));
    ns = (ns * 5 + 3) & 0xFFFFFFF;
  }
  benchmark::DoNotOptimize(histogram.count());
}
BENCHMARK(histogram_add);

void histogram_quantile(benchmark::State& state) {
  LatencyHistogram histogram;
  for (std::int64_t ns = 1; ns < 100'000'000; ns = ns * 9 / 8 + 1) histogram.add(Duration::from_ns(ns));
  for (auto _ : state) benchmark::DoNotOptimize(histogram.p99());
}
BENCHMARK(histogram_quantile);

void stopwatch_lap(benchmark::State& state) {
  Stopwatch watch;
  for (auto _ : state) benchmark::DoNotOptimize(watch.lap());
}
BENCHMARK(stopwatch_lap);

void allocation_guard_count(benchmark::State& state) {
  const AllocationGuard guard;
  for (auto _ : state) benchmark::DoNotOptimize(guard.count());
}
BENCHMARK(allocation_guard_count);

void page_fault_count(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(thread_page_faults());
}
BENCHMARK(page_fault_count);

template <auto Map>
void tangent_map(benchmark::State& state) {
  Eigen::Vector3d theta(0.1, -0.2, 0.3);
  for (auto _ : state) {
    benchmark::DoNotOptimize(theta);
    benchmark::DoNotOptimize(Map(theta));
  }
}
BENCHMARK(tangent_map<Exp>)->Name("so3_Exp");
BENCHMARK(tangent_map<Jr>)->Name("so3_Jr");
BENCHMARK(tangent_map<Jr_inverse>)->Name("so3_Jr_inverse");

void so3_Log(benchmark::State& state) {
  Eigen::Matrix3d R = Exp(Eigen::Vector3d(0.1, -0.2, 0.3));
  for (auto _ : state) {
    benchmark::DoNotOptimize(R);
    benchmark::DoNotOptimize(Log(R));
  }
}
BENCHMARK(so3_Log);

}  // namespace
}  // namespace lxd

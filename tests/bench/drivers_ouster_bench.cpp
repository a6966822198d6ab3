// SPDX-License-Identifier: Apache-2.0
// An OS1-128's packets into sweeps on one core: the counter `times_real_time` says how many such sensors at 20 Hz one
// core keeps up with.
#include <vector>

#include <benchmark/benchmark.h>

#include "drivers/ouster/sweep_builder.hpp"
#include "tests/bench/os1_128.hpp"

namespace lxd {
namespace {

using namespace bench;

void parse_into_sweeps(benchmark::State& state, const char* profile) {
  const OusterMetadata metadata = os1_128(profile);
  const auto packets = turns_of(metadata.format);
  OusterPacketParser parser(metadata.format, kColumns, std::nullopt);
  OusterFrameAssembler assembler(metadata.format, kColumns);
  OusterSweepBuilder builder(metadata);
  std::vector<LidarPoint> storage(std::size_t{2} * kColumns * kRows);
  Sweep sweep;
  sweep.storage = storage;
  OusterPacket packet;
  std::size_t at = 0, parsed = 0, sweeps = 0;
  for (auto unused : state) {
    (void)unused;
    if (parser.parse(packets[at], packet)) {
      const OusterFrame* const frame = assembler.add(packet);
      if (frame != nullptr) sweeps += builder.build(*frame, sweep);
    }
    at = (at + 1) % packets.size();
    ++parsed;
  }
  if (sweeps + 1 < parsed / (kColumns / kColumnsPerPacket)) state.SkipWithError("packets did not become sweeps");
  state.counters["times_real_time"] =
      benchmark::Counter(static_cast<double>(parsed) / kPacketsPerSecond, benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(parse_into_sweeps, legacy, "LEGACY");
BENCHMARK_CAPTURE(parse_into_sweeps, single, "RNG19_RFL8_SIG16_NIR16");
BENCHMARK_CAPTURE(parse_into_sweeps, low_bandwidth, "RNG15_RFL8_NIR8");
BENCHMARK_CAPTURE(parse_into_sweeps, dual, "RNG19_RFL8_SIG16_NIR16_DUAL");

}  // namespace
}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// What a datagram of an OS1-128 costs the thread that reads: from the socket through parser, assembler and clock into
// the sweep that the filter's ring gets, as a live rig does it. Counters: microseconds a datagram at 64 and at one that
// wait, allocations (they must be none), and how many such sensors at 20 Hz one core keeps up with.
#include <cstdlib>

#include <arpa/inet.h>
#include <benchmark/benchmark.h>
#include <sys/socket.h>

#include "board/default/capacities.hpp"
#include "board/live_intake.hpp"
#include "drivers/device/file_descriptor.hpp"
#include "drivers/device/udp_socket.hpp"
#include "rt/allocation_guard.hpp"
#include "tests/bench/os1_128.hpp"

namespace lxd {
namespace {

LiveRig rig_of(const OusterMetadata& metadata, std::uint16_t port) {
  LiveRig live;
  LiveLidar lidar;
  lidar.metadata = metadata;
  lidar.wire.port = port;
  live.lidars.push_back(std::move(lidar));
  return live;
}

class Sender {
 public:
  explicit Sender(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    end_.sin_family = AF_INET;
    end_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    end_.sin_port = htons(port);
  }
  void send(const std::vector<std::uint8_t>& bytes) const {
    (void)::sendto(socket_.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&end_), sizeof end_);
  }

 private:
  FileDescriptor socket_;
  sockaddr_in end_{};
};

void socket_to_ring(benchmark::State& state, const char* profile) {
  const OusterMetadata metadata = bench::os1_128(profile);
  const auto packets = bench::turns_of(metadata.format);
  const HostClock clock;
  UdpConfig config;
  config.sources = {{0, static_cast<std::uint8_t>(index_of(LiveChannel::lidar0))}};
  auto socket = UdpSocket::open(config, clock);
  if (!socket) return state.SkipWithError(socket.error().message.c_str());
  const LiveRig live = rig_of(metadata, (*socket)->port());
  constexpr SweepIndex kSweeps = 4;
  std::vector<std::byte> block(kSweeps * (capacities::kSweepPointsMax * sizeof(LidarPoint) + 4096));
  Arena arena(block);
  SweepPool pool(arena, "sweeps", kSweeps, capacities::kSweepPointsMax);
  EventLog events;
  SensorWatch watch(live, events);
  LiveIntake intake(live, pool, watch);
  const Sender sender((*socket)->port());
  const auto together = static_cast<std::size_t>(state.range(0));
  std::uint64_t allocations = 0, sweeps = 0;
  std::size_t at = 0;
  for (auto unused : state) {
    (void)unused;
    state.PauseTiming();
    for (std::size_t i = 0; i < together; ++i, at = (at + 1) % packets.size()) sender.send(packets[at]);
    state.ResumeTiming();
    const AllocationGuard guard;
    (*socket)->read(intake);
    allocations += guard.count();
    while (const auto index = intake.pop_sweep()) {
      pool.release(*index);
      ++sweeps;
    }
  }
  const DeviceCounts& counts = (*socket)->counts();
  const auto datagrams = static_cast<double>(counts.chunks);
  constexpr double kMicro = 1e-6;
  if (counts.kernel_overflow > 0 || sweeps == 0) state.SkipWithError("datagrams were lost, or did not become sweeps");
  state.counters["us_a_datagram"] =
      benchmark::Counter(datagrams * kMicro, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["times_real_time"] =
      benchmark::Counter(datagrams / bench::kPacketsPerSecond, benchmark::Counter::kIsRate);
  state.counters["allocations"] = AllocationGuard::active() ? static_cast<double>(allocations) : -1;
}

BENCHMARK_CAPTURE(socket_to_ring, single, "RNG19_RFL8_SIG16_NIR16")->Arg(64)->Arg(1);
BENCHMARK_CAPTURE(socket_to_ring, low_bandwidth, "RNG15_RFL8_NIR8")->Arg(64)->Arg(1);
BENCHMARK_CAPTURE(socket_to_ring, dual, "RNG19_RFL8_SIG16_NIR16_DUAL")->Arg(64)->Arg(1);

}  // namespace
}  // namespace lxd

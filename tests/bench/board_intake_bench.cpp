// SPDX-License-Identifier: Apache-2.0
// What a datagram of an OS1-128 costs the thread that reads, of 64 and of one that wait: from the socket into the ring
// of `record`, and through parser, assembler and clock into the sweep that the filter's ring gets in `run`. Counters:
// microseconds a datagram, allocations (they must be none), and how many such sensors at 20 Hz one core keeps up with.
#include <array>
#include <memory>
#include <vector>

#include <arpa/inet.h>
#include <benchmark/benchmark.h>
#include <sys/socket.h>

#include "board/default/capacities.hpp"
#include "board/live_intake.hpp"
#include "drivers/device/file_descriptor.hpp"
#include "drivers/device/udp_socket.hpp"
#include "rt/allocation_guard.hpp"
#include "rt/byte_ring.hpp"
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

// As if it had been measured just now, so that the clock model has nothing to refuse.
void stamp(const OusterPacketFormat& format, RigTime now, std::vector<std::uint8_t>& packet) {
  const OusterFraming& framing = format.framing();
  for (std::size_t c = 0; c < format.columns_per_packet; ++c)
    framing.timestamp_ns.set(packet.data() + format.column_offset(c), static_cast<std::uint64_t>(now.ns()) + c);
  if (framing.crc.present())
    framing.crc.set(packet.data() + format.footer_offset(), crc64(std::span(packet).first(packet.size() - 8)));
}

// Sends `together` packets at a time, and measures how long it takes to hand them from the socket to what `make` gives
// for the port: a sink, which is emptied unmeasured.
template <typename Make>
void read_socket(benchmark::State& state, const char* profile, const Make& make) {
  const OusterMetadata metadata = bench::os1_128(profile);
  auto packets = bench::turns_of(metadata.format);
  const HostClock clock;
  UdpConfig config;
  config.sources = {{0, static_cast<std::uint8_t>(index_of(LiveChannel::lidar0))}};
  auto socket = UdpSocket::open(config, clock);
  if (!socket) return state.SkipWithError(socket.error().message.c_str());
  const auto sink = make(metadata, (*socket)->port());
  const Sender sender((*socket)->port());
  const auto together = static_cast<std::size_t>(state.range(0));
  std::uint64_t allocations = 0;
  std::size_t at = 0;
  for (auto unused : state) {
    (void)unused;
    state.PauseTiming();
    sink->empty();
    for (std::size_t i = 0; i < together; ++i, at = (at + 1) % packets.size()) {
      stamp(metadata.format, clock.now(), packets[at]);
      sender.send(packets[at]);
    }
    state.ResumeTiming();
    const AllocationGuard guard;
    (*socket)->read(*sink);
    allocations += guard.count();
  }
  const DeviceCounts& counts = (*socket)->counts();
  const auto datagrams = static_cast<double>(counts.chunks);
  constexpr double kMicro = 1e-6;
  if (counts.kernel_overflow > 0 || sink->lost()) state.SkipWithError("datagrams were lost");
  state.counters["us_a_datagram"] =
      benchmark::Counter(datagrams * kMicro, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["times_real_time"] =
      benchmark::Counter(datagrams / bench::kPacketsPerSecond, benchmark::Counter::kIsRate);
  state.counters["allocations"] = AllocationGuard::active() ? static_cast<double>(allocations) : -1;
}

// As `record` takes them: copied into a ring.
class RecordSink final : public ChunkSink {
 public:
  RecordSink() : storage_(kBytes), ring_(storage_), out_(kBytes) {}

  void take(const Chunk& chunk) override {
    const std::array<std::uint8_t, 16> head{};
    lost_ += !ring_.push(head, chunk.bytes);
  }
  void empty() {
    while (!ring_.pop(out_).empty()) {
    }
  }
  [[nodiscard]] bool lost() const { return lost_ > 0; }

 private:
  static constexpr std::size_t kBytes = 32U << 20U;  // as a LiDAR's in the recorder
  std::vector<std::uint8_t> storage_;
  ByteRing ring_;
  std::vector<std::uint8_t> out_;
  std::uint64_t lost_ = 0;
};

// As `run` takes them: parsed into sweeps, whose indices go through a ring.
class RunSink final : public ChunkSink {
 public:
  RunSink(const OusterMetadata& metadata, std::uint16_t port) : live_(rig_of(metadata, port)) {}

  void take(const Chunk& chunk) override {
    ++packets_;
    intake_.take(chunk);
  }
  void empty() {
    while (const auto index = intake_.pop_sweep()) {
      pool_.release(*index);
      ++sweeps_;
    }
  }
  [[nodiscard]] bool lost() const {
    return sweeps_ + 2 < packets_ * bench::kColumnsPerPacket / bench::kColumns * 9 / 10;
  }

 private:
  static constexpr SweepIndex kSweeps = 4;
  LiveRig live_;
  std::vector<std::byte> block_ =
      std::vector<std::byte>(kSweeps * (capacities::kSweepPointsMax * sizeof(LidarPoint) + 4096));
  Arena arena_{block_};
  SweepPool pool_{arena_, "sweeps", kSweeps, capacities::kSweepPointsMax};
  EventLog events_;
  SensorWatch watch_{live_, events_};
  LiveIntake intake_{live_, pool_, watch_};
  std::uint64_t packets_ = 0, sweeps_ = 0;
};

void socket_to_record(benchmark::State& state, const char* profile) {
  read_socket(state, profile, [](const OusterMetadata&, std::uint16_t) { return std::make_unique<RecordSink>(); });
}

void socket_to_sweep(benchmark::State& state, const char* profile) {
  read_socket(state, profile, [](const OusterMetadata& metadata, std::uint16_t port) {
    return std::make_unique<RunSink>(metadata, port);
  });
}

BENCHMARK_CAPTURE(socket_to_record, single, "RNG19_RFL8_SIG16_NIR16")->Arg(64)->Arg(1);
BENCHMARK_CAPTURE(socket_to_record, dual, "RNG19_RFL8_SIG16_NIR16_DUAL")->Arg(64)->Arg(1);
BENCHMARK_CAPTURE(socket_to_sweep, single, "RNG19_RFL8_SIG16_NIR16")->Arg(64)->Arg(1);
BENCHMARK_CAPTURE(socket_to_sweep, low_bandwidth, "RNG15_RFL8_NIR8")->Arg(64)->Arg(1);
BENCHMARK_CAPTURE(socket_to_sweep, dual, "RNG19_RFL8_SIG16_NIR16_DUAL")->Arg(64)->Arg(1);

}  // namespace
}  // namespace lxd

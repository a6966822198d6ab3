// SPDX-License-Identifier: Apache-2.0
// An OS1-128's packets into sweeps on one core: the counter `times_real_time` says how many such sensors at 20 Hz one
// core keeps up with.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "drivers/crc.hpp"
#include "drivers/ouster/sweep_builder.hpp"

namespace lxd {
namespace {

constexpr std::uint16_t kColumns = 1024, kRows = 128, kColumnsPerPacket = 16;
constexpr double kRate_hz = 20;

OusterMetadata os1_128(const char* profile) {
  OusterMetadata metadata;
  metadata.format = {find_ouster_profile(profile), kColumnsPerPacket, kRows};
  metadata.columns_per_frame = kColumns;
  metadata.rate_hz = kRate_hz;
  for (int row = 0; row < kRows; ++row) {
    metadata.altitude_rad.push_back(0.39 - 0.78 * row / (kRows - 1));
    metadata.azimuth_rad.push_back(0.01 * (row % 4));
  }
  return metadata;
}

std::vector<std::uint8_t> packet_of(const OusterPacketFormat& format, std::uint32_t frame_id, std::uint16_t first) {
  constexpr std::uint64_t kTurn_ns = 50'000'000;
  const OusterFraming& framing = format.framing();
  std::vector<std::uint8_t> packet(format.packet_bytes());
  framing.packet_type.set(packet.data(), kOusterLidarPacket);
  framing.packet_frame_id.set(packet.data(), frame_id);
  for (std::uint16_t c = 0; c < kColumnsPerPacket; ++c) {
    std::uint8_t* const column = packet.data() + format.column_offset(c);
    const unsigned id = first + c;
    framing.timestamp_ns.set(column, frame_id * kTurn_ns + id * kTurn_ns / kColumns);
    framing.measurement_id.set(column, id);
    framing.column_frame_id.set(column, frame_id);
    framing.header_status.set(column, 1);
    framing.footer_status.set(column + format.column_bytes() - framing.column_footer_bytes, ~0U);
    for (unsigned row = 0; row < kRows; ++row) {
      std::uint8_t* const block = column + framing.column_header_bytes + row * format.profile->channel_bytes;
      format.profile->fields.range_mm.set(block, 1000 + 40 * row + id);
      format.profile->fields.reflectivity.set(block, row);
      format.profile->fields.range2_mm.set(block, row % 4 == 0 ? 9000 + id : 0);
    }
  }
  if (framing.crc.present()) {
    const auto sealed = std::span(packet).first(packet.size() - 8);
    framing.crc.set(packet.data() + format.footer_offset(), crc64(sealed));
  }
  return packet;
}

void parse_into_sweeps(benchmark::State& state, const char* profile) {
  const OusterMetadata metadata = os1_128(profile);
  std::vector<std::vector<std::uint8_t>> packets;
  // So many that frame 1 after the last one is no packet that comes late.
  for (std::uint32_t frame = 1; frame <= 16; ++frame) {
    for (std::uint16_t first = 0; first < kColumns; first += kColumnsPerPacket)
      packets.push_back(packet_of(metadata.format, frame, first));
  }
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
  constexpr double kPacketsPerSecond = kRate_hz * kColumns / kColumnsPerPacket;
  state.counters["times_real_time"] =
      benchmark::Counter(static_cast<double>(parsed) / kPacketsPerSecond, benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(parse_into_sweeps, legacy, "LEGACY");
BENCHMARK_CAPTURE(parse_into_sweeps, single, "RNG19_RFL8_SIG16_NIR16");
BENCHMARK_CAPTURE(parse_into_sweeps, low_bandwidth, "RNG15_RFL8_NIR8");
BENCHMARK_CAPTURE(parse_into_sweeps, dual, "RNG19_RFL8_SIG16_NIR16_DUAL");

}  // namespace
}  // namespace lxd

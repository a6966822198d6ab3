// SPDX-License-Identifier: Apache-2.0
// A small simulated Ouster without errors, and what a driver makes of its capture.
#pragma once

#include "drivers/ouster/frame_assembler.hpp"
#include "drivers/replay/ouster_metadata_file.hpp"
#include "tests/support/captured_datagrams.hpp"
#include "tests/support/lidar_rig.hpp"
#include "tools/simulator/lidar/ouster_writer.hpp"

namespace lxd::test {

inline sim::OusterConfig small_ouster() {
  sim::OusterConfig config;
  config.beams = 16;
  config.columns = 512;
  config.clock_source = "TIME_FROM_PTP_1588";
  return without_errors(config);
}

// What a driver makes of a capture.
struct DecodedOuster {
  OusterMetadata metadata;
  Capture capture;
  OusterParserCounts counts;
  std::uint64_t repeated_columns = 0, stale_packets = 0;
  struct Pixel {
    std::int64_t stamp_ns;
    std::uint32_t frame_id;
    std::size_t column, row;
    std::uint32_t range_mm;
  };
  std::vector<Pixel> pixels;
};

inline DecodedOuster decode_ouster(const std::filesystem::path& pcap) {
  DecodedOuster d;
  const auto metadata = read_ouster_metadata(std::filesystem::path(pcap).replace_extension(".json"));
  if (!metadata) {
    ADD_FAILURE() << metadata.error().message;
    return d;
  }
  d.metadata = *metadata;
  d.capture = read_capture(pcap);
  OusterPacketParser parser(d.metadata.format, d.metadata.columns_per_frame, d.metadata.init_id, d.metadata.serial);
  OusterFrameAssembler assembler(d.metadata.format, d.metadata.columns_per_frame);
  OusterPacket packet;
  const BitField range = d.metadata.format.profile->fields.range_mm;
  for (const CapturedDatagram* const datagram : d.capture.to(*d.metadata.lidar_port)) {
    if (!parser.parse(datagram->bytes, packet)) continue;
    assembler.add(packet);
    for (const OusterColumn& column : packet.columns()) {
      for (std::size_t row = 0; row < d.metadata.format.pixels_per_column; ++row) {
        const auto range_mm = range.get(column.channels + row * d.metadata.format.profile->channel_bytes);
        d.pixels.push_back({static_cast<std::int64_t>(column.timestamp_ns), packet.frame_id, column.measurement_id, row,
                            static_cast<std::uint32_t>(range_mm)});
      }
    }
  }
  d.counts = parser.counts();
  d.repeated_columns = assembler.repeated_columns();
  d.stale_packets = assembler.stale_packets();
  return d;
}

inline sim::LidarLog must_write(const LidarRig& rig, const sim::OusterConfig& config,
                                const std::filesystem::path& folder, const sim::LidarOutput& output = {}) {
  const auto log = write_ouster(rig.context, config, folder, output);
  if (!log) {
    ADD_FAILURE() << log.error().message;
    return {};
  }
  return *log;
}

}  // namespace lxd::test

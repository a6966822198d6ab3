// SPDX-License-Identifier: Apache-2.0
// Any bytes as a packet of each profile, through parser, assembler and sweep builder. The first byte picks the profile.
#include <cstdlib>

#include "drivers/ouster/sweep_builder.hpp"

namespace {

using namespace lxd;

OusterMetadata metadata_for(const OusterProfile& profile) {
  OusterMetadata metadata;
  metadata.format = {&profile, 2, 2};
  metadata.columns_per_frame = 8;
  metadata.altitude_rad = {0.1, -0.1};
  metadata.azimuth_rad = {0, 0};
  return metadata;
}

struct Pipeline {
  explicit Pipeline(const OusterMetadata& metadata)
      : parser(metadata.format, metadata.columns_per_frame, {}),
        assembler(metadata.format, metadata.columns_per_frame),
        builder(metadata) {}

  void build(const OusterFrame* frame) {
    if (frame == nullptr) return;
    std::array<LidarPoint, 12> storage;  // fewer than a frame has, so that the overflow is met too
    Sweep sweep;
    sweep.storage = storage;
    if (!builder.build(*frame, sweep)) return;
    for (const LidarPoint& p : sweep.points()) {
      if (sweep.begin + Duration::from_ns(p.offset_ns) > sweep.end) std::abort();
    }
  }

  OusterPacketParser parser;
  OusterFrameAssembler assembler;
  OusterSweepBuilder builder;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto profiles = ouster_profiles();
  const OusterMetadata metadata = metadata_for(profiles[data[0] % profiles.size()]);
  Pipeline pipeline(metadata);
  OusterPacket packet;
  std::span<const std::uint8_t> rest(data + 1, size - 1);
  while (!rest.empty()) {
    const std::size_t bytes = std::min(rest.size(), metadata.format.packet_bytes());
    const std::vector<std::uint8_t> datagram(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(bytes));
    if (pipeline.parser.parse(datagram, packet)) pipeline.build(pipeline.assembler.add(packet));
    rest = rest.subspan(bytes);
  }
  pipeline.build(pipeline.assembler.flush());
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
// Any bytes as a capture file, through libpcap, reassembly and the Ouster source.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "drivers/replay/ouster_pcap.hpp"

namespace {

lxd::OusterMetadata small_sensor() {
  lxd::OusterMetadata metadata;
  metadata.format = {lxd::find_ouster_profile("LEGACY"), 1, 1};
  metadata.columns_per_frame = 4;
  metadata.altitude_rad = {0};
  metadata.azimuth_rad = {0};
  return metadata;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lxd;
  if (size == 0) return 0;
  std::FILE* const stream = fmemopen(const_cast<std::uint8_t*>(data), size, "rb");
  if (stream == nullptr) return 0;
  auto pcap = PcapFile::from_stream(stream, "fuzz.pcap");
  if (!pcap) return 0;
  const auto source = make_ouster_source(std::move(*pcap), small_sensor());
  std::array<LidarPoint, 4> storage;
  Sweep sweep;
  sweep.storage = storage;
  RigTime last = RigTime::from_seconds(-1e9);
  for (;;) {
    const auto more = source->next(sweep);
    if (!more.ok()) std::abort();
    if (!*more) return 0;
    if (sweep.count == 0 || sweep.stamp <= last || sweep.end < sweep.begin) std::abort();
    last = sweep.stamp;
  }
}

// SPDX-License-Identifier: Apache-2.0
// The form of the file is that of libpcap (pcap-savefile(5)), in the host's byte order; written without the library,
// whose writer cannot say which records are whole when a disk is full.
#include "drivers/replay/pcap_writer.hpp"

#include <algorithm>
#include <cstring>

namespace lxd {
namespace {

struct FileHeader {
  std::uint32_t magic = 0xA1B23C4D;  // stamps are in nanoseconds
  std::uint16_t major = 2, minor = 4;
  std::uint32_t reserved[2] = {0, 0};
  std::uint32_t snapshot_bytes = 65'535;
  std::uint32_t link_type = 1;  // Ethernet
};
static_assert(sizeof(FileHeader) == 24);

struct RecordHeader {
  std::uint32_t seconds, nanoseconds, captured_bytes, wire_bytes;
};
static_assert(sizeof(RecordHeader) == 16);

constexpr std::int64_t kWire_nsPerByte = 8;  // 1 Gbit/s
constexpr std::size_t kGapBytes = 24;        // preamble, check sequence and gap of a frame

template <typename Header>
std::span<const std::uint8_t> bytes_of(const Header& header) {
  return {reinterpret_cast<const std::uint8_t*>(&header), sizeof(header)};
}

}  // namespace

Result<PcapWriter> PcapWriter::create(const std::filesystem::path& path, PcapStamps stamps) {
  auto file = GrowingFile::create(path);
  if (!file) return file.error();
  const FileHeader header;
  if (const Status written = file->append({bytes_of(header)}); !written) return written.error();
  return PcapWriter(std::move(*file), stamps);
}

Status PcapWriter::write(const UdpRoute& route, std::span<const std::uint8_t> payload, RigTime received,
                         std::optional<std::uint64_t> lost_fragment) {
  wire_free_ = std::max(wire_free_, received);
  const auto frames = framer_.frames(route, payload);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (lost_fragment && *lost_fragment % frames.size() == i) continue;
    Status written = write_frame(frames[i], received);
    if (!written) return written;
  }
  return success();
}

Status PcapWriter::write_frame(std::span<const std::uint8_t> frame, RigTime received) {
  const RigTime stamp = stamps_ == PcapStamps::of_wire ? wire_free_ : received;
  const auto bytes = static_cast<std::uint32_t>(frame.size());
  const RecordHeader header{static_cast<std::uint32_t>(stamp.ns() / kNanosPerSecond),
                            static_cast<std::uint32_t>(stamp.ns() % kNanosPerSecond), bytes, bytes};
  wire_free_ = wire_free_ + Duration::from_ns(kWire_nsPerByte * static_cast<std::int64_t>(frame.size() + kGapBytes));
  return file_.append({bytes_of(header), frame});
}

}  // namespace lxd

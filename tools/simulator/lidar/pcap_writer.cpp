// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/pcap_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <pcap/pcap.h>
#include <unistd.h>

namespace lxd::sim {
namespace {

constexpr int kSnapshotBytes = 65535;
constexpr std::int64_t kWire_nsPerByte = 8;  // 1 Gbit/s
constexpr std::size_t kGapBytes = 24;        // preamble, check sequence and gap of a frame

}  // namespace

void PcapWriter::CloseDumper::operator()(pcap_dumper* dumper) const { pcap_dump_close(dumper); }
void PcapWriter::ClosePcap::operator()(pcap* handle) const { pcap_close(handle); }

Result<PcapWriter> PcapWriter::create(const std::filesystem::path& path) {
  std::FILE* const stream = std::fopen(path.c_str(), "wb");
  if (stream == nullptr) return Error{fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno))};
  pcap* const handle = pcap_open_dead_with_tstamp_precision(DLT_EN10MB, kSnapshotBytes, PCAP_TSTAMP_PRECISION_NANO);
  pcap_dumper* const dumper = handle == nullptr ? nullptr : pcap_dump_fopen(handle, stream);
  if (dumper == nullptr) {
    std::fclose(stream);
    if (handle != nullptr) pcap_close(handle);
    return Error{fmt::format("{}: cannot be written as a packet capture", path.string())};
  }
  return PcapWriter(path, handle, dumper, stream);
}

Status PcapWriter::write(const UdpRoute& route, std::span<const std::uint8_t> payload, RigTime received,
                         std::optional<std::uint64_t> lost_fragment) {
  wire_free_ = std::max(wire_free_, received);
  const auto frames = framer_.frames(route, payload);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!lost_fragment || *lost_fragment % frames.size() != i) write_frame(frames[i]);
  }
  return cause_ == 0 ? success() : failure();
}

void PcapWriter::write_frame(std::span<const std::uint8_t> frame) {
  pcap_pkthdr header{};
  header.ts.tv_sec = wire_free_.ns() / kNanosPerSecond;
  header.ts.tv_usec = wire_free_.ns() % kNanosPerSecond;  // nanoseconds, as the file's precision says
  header.caplen = header.len = static_cast<bpf_u_int32>(frame.size());
  pcap_dump(reinterpret_cast<unsigned char*>(dumper_.get()), &header, frame.data());
  if (cause_ == 0 && std::ferror(stream_) != 0) cause_ = errno;
  wire_free_ = wire_free_ + Duration::from_ns(kWire_nsPerByte * static_cast<std::int64_t>(frame.size() + kGapBytes));
}

Status PcapWriter::close() {
  if (cause_ == 0 && (pcap_dump_flush(dumper_.get()) != 0 || ::fsync(::fileno(stream_)) != 0)) cause_ = errno;
  if (cause_ != 0) return failure();
  stream_ = nullptr;
  dumper_.reset();
  return success();
}

Status PcapWriter::failure() const {
  return Error{fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(cause_))};
}

}  // namespace lxd::sim

// SPDX-License-Identifier: Apache-2.0
// See pcap_file.hpp.
#include "drivers/replay/pcap_file.hpp"

#include <array>
#include <optional>

#include <fmt/format.h>
#include <pcap/pcap.h>

namespace lxd {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr unsigned kEtherTypeIpv4 = 0x0800;
constexpr unsigned kEtherTypeVlan = 0x8100;
constexpr std::size_t kVlanTagBytes = 4;

// Where a link type keeps its EtherType, and where the network packet begins.
struct LinkHeader {
  int type;
  std::optional<std::size_t> ether_type_at;
  std::size_t bytes;
};
constexpr std::array kLinkHeaders{LinkHeader{DLT_EN10MB, 12, 14}, LinkHeader{DLT_LINUX_SLL, 14, 16},
                                  LinkHeader{DLT_LINUX_SLL2, 0, 20}, LinkHeader{DLT_RAW, std::nullopt, 0}};

const LinkHeader* find_link_header(int type) {
  for (const LinkHeader& header : kLinkHeaders) {
    if (header.type == type) return &header;
  }
  return nullptr;
}

unsigned big_endian_16(Bytes bytes, std::size_t at) { return static_cast<unsigned>(bytes[at] << 8U | bytes[at + 1]); }

// Empty when the frame carries something else.
Bytes ipv4_of(const LinkHeader& link, Bytes frame) {
  std::size_t header = link.bytes;
  if (frame.size() < header) return {};
  if (link.ether_type_at) {
    unsigned type = big_endian_16(frame, *link.ether_type_at);
    while (type == kEtherTypeVlan && frame.size() >= header + kVlanTagBytes) {
      type = big_endian_16(frame, header + 2);
      header += kVlanTagBytes;
    }
    if (type != kEtherTypeIpv4) return {};
  }
  return frame.subspan(header);
}

}  // namespace

void PcapFile::Close::operator()(pcap* handle) const { pcap_close(handle); }

Result<PcapFile> PcapFile::open(const std::filesystem::path& path) {
  std::FILE* const stream = std::fopen(path.c_str(), "rb");
  if (stream == nullptr) return Error{fmt::format("{}: cannot be read", path.string())};
  return from_stream(stream, path.string());
}

Result<PcapFile> PcapFile::from_stream(std::FILE* stream, const std::string& name) {
  std::array<char, PCAP_ERRBUF_SIZE> reason{};
  pcap* const handle = pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, reason.data());
  if (handle == nullptr) {
    std::fclose(stream);
    return Error{fmt::format("{}: no readable packet capture ({})", name, reason.data())};
  }
  PcapFile file(handle, pcap_datalink(handle));
  if (find_link_header(file.link_type_) == nullptr) {
    return Error{fmt::format("{}: found link type {}, wanted Ethernet (1), raw IP (101), Linux cooked (113, 276)", name,
                             file.link_type_)};
  }
  return file;
}

bool PcapFile::next(CapturedPacket& packet, Rejections& rejected) {
  const LinkHeader& link = *find_link_header(link_type_);
  pcap_pkthdr* header = nullptr;
  const unsigned char* data = nullptr;
  int status = 0;
  while ((status = pcap_next_ex(handle_.get(), &header, &data)) == 1) {
    if (header->caplen < header->len) {
      count_rejected(rejected, "short_capture");
      continue;
    }
    packet.ipv4 = ipv4_of(link, {data, header->caplen});
    if (packet.ipv4.empty()) continue;
    packet.received = RigTime::from_ns(header->ts.tv_sec * kNanosPerSecond + header->ts.tv_usec);
    return true;
  }
  if (status == PCAP_ERROR) count_rejected(rejected, "truncated_file");
  return false;
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// See livox_stream.hpp.
#include "drivers/replay/livox_stream.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "drivers/replay/pcap_file.hpp"

namespace lxd {
namespace {

constexpr int kSearchedDatagrams = 1000;
constexpr std::size_t kWitnesses = 8;
constexpr double kStepTolerance = 0.2;  // of the time between two packets; lost ones leave no witness

// Calls visit(datagram) until it is true.
template <typename Visit>
void search(const std::filesystem::path& path, Visit&& visit) {
  auto pcap = PcapFile::open(path);
  if (!pcap) return;
  IpReassembler reassembler;
  CapturedPacket captured;
  Rejections counted_when_read;
  for (int datagrams = 0; datagrams < kSearchedDatagrams && pcap->next(captured, counted_when_read);) {
    const auto datagram = reassembler.add(captured.ipv4);
    if (!datagram) continue;
    ++datagrams;
    if (visit(*datagram)) return;
  }
}

// One sender's point packets of SDK1 so far.
struct Candidate {
  LivoxSender sender;
  std::uint64_t last_ns = 0;
  std::uint32_t last_count = 0;
  std::uint32_t shot_ns = 0;
  std::size_t witnesses = 0;
};

// The rate whose packet would last as long as the next one is later; 0: neither.
std::uint32_t shot_of(const Candidate& last, std::uint64_t now_ns) {
  if (now_ns <= last.last_ns) return 0;
  const double step_ns = static_cast<double>(now_ns - last.last_ns);
  for (const std::uint32_t shot_ns : {kLivoxMidShot_ns, kLivoxHorizonShot_ns}) {
    const double packet_ns = static_cast<double>(shot_ns) * last.last_count;
    if (std::abs(step_ns - packet_ns) < kStepTolerance * packet_ns) return shot_ns;
  }
  return 0;
}

// True: there are enough witnesses.
bool note(Candidate& candidate, const LivoxPacket& packet) {
  const std::uint32_t shot_ns = shot_of(candidate, packet.timestamp_ns);
  candidate.witnesses = shot_ns == 0 || shot_ns != candidate.shot_ns ? 1 : candidate.witnesses + 1;
  candidate.shot_ns = shot_ns;
  candidate.last_ns = packet.timestamp_ns;
  candidate.last_count = packet.count;
  return candidate.witnesses >= kWitnesses;
}

std::optional<LivoxStream> find_sdk2(const std::filesystem::path& path) {
  LivoxPacketParser parser(kMid360Lines);
  LivoxPacket packet;
  std::optional<LivoxStream> found;
  search(path, [&](const UdpDatagram& datagram) {
    if (!parser.parse(datagram.payload, packet) || packet.is_imu()) return false;
    found = LivoxStream{sender_of(datagram), {LivoxPacketParser(kMid360Lines)}};
    return true;
  });
  return found;
}

std::optional<LivoxStream> find_sdk1(const std::filesystem::path& path) {
  LivoxSdk1Parser parser(kLivoxHorizonShot_ns);
  LivoxPacket packet;
  std::vector<Candidate> candidates;
  std::optional<LivoxStream> found;
  search(path, [&](const UdpDatagram& datagram) {
    if (!parser.parse(datagram.payload, packet) || packet.is_imu()) return false;
    const LivoxSender sender = sender_of(datagram);
    auto candidate = std::ranges::find(candidates, sender, &Candidate::sender);
    if (candidate == candidates.end()) candidate = candidates.insert(candidate, Candidate{sender});
    if (!note(*candidate, packet)) return false;
    found = LivoxStream{sender, {LivoxSdk1Parser(candidate->shot_ns)}};
    return true;
  });
  return found;
}

}  // namespace

LivoxSender sender_of(const UdpDatagram& datagram) { return {datagram.source_address, datagram.source_port}; }

std::optional<LivoxStream> find_livox_stream(const std::filesystem::path& path) {
  auto stream = find_sdk2(path);
  return stream ? stream : find_sdk1(path);
}

}  // namespace lxd

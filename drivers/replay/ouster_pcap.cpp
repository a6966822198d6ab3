// SPDX-License-Identifier: Apache-2.0
// See ouster_pcap.hpp.
#include "drivers/replay/ouster_pcap.hpp"

#include <algorithm>
#include <array>
#include <fstream>

#include "drivers/lidar/ouster_sweeps.hpp"
#include "drivers/replay/datagram_capture.hpp"
#include "drivers/replay/ouster_metadata_file.hpp"
#include "drivers/replay/ouster_stream.hpp"
#include "drivers/replay/stream_clock.hpp"

namespace lxd {
namespace {

constexpr const char* kKind = "ouster-pcap";

Duration nominal_period(const OusterMetadata& metadata) {
  return metadata.rate_hz > 0 ? Duration::from_seconds(1 / metadata.rate_hz) : Duration();
}

class OusterPcapSource final : public SweepSource {
 public:
  OusterPcapSource(PcapFile pcap, const OusterMetadata& metadata, std::optional<OusterStream> stream,
                   std::unique_ptr<SweepClock> clock, std::string kind)
      : capture_(std::move(pcap)),
        stream_(stream),
        imu_port_(metadata.imu_port == metadata.lidar_port ? std::nullopt : metadata.imu_port),
        sweeps_(metadata, std::move(clock)),
        kind_(std::move(kind)),
        traits_{metadata.format.pixels_per_column, metadata.columns_per_frame, metadata.rate_hz},
        notes_(metadata.notes) {}

  Result<bool> next(Sweep& sweep) override {
    const bool found = !ended_ && next_sweep(sweep);
    sweeps_.report(rejected_);
    capture_.report(rejected_);
    return found;
  }

  [[nodiscard]] std::optional<std::uint64_t> size() const override { return std::nullopt; }
  [[nodiscard]] std::string kind() const override { return kind_; }
  [[nodiscard]] LidarTraits traits() const override { return traits_; }
  [[nodiscard]] const Rejections& rejected() const override { return rejected_; }
  [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }

 private:
  bool next_sweep(Sweep& sweep) {
    while (const auto datagram = capture_.next(rejected_)) {
      if (is_imu(datagram->udp)) continue;
      if (!sweeps_.parse(datagram->udp.payload) || !is_ours(datagram->udp)) continue;
      if (sweeps_.take(datagram->received, sweep)) return true;
    }
    ended_ = true;
    return sweeps_.flush(sweep);
  }

  // The sensor's inertial packets: by port, or where the port was forwarded by the size that no LiDAR packet has.
  [[nodiscard]] bool is_imu(const UdpDatagram& datagram) const {
    constexpr std::size_t kLegacyImuBytes = 48;
    const bool imu_port = imu_port_ && datagram.destination_port == *imu_port_;
    return imu_port || datagram.payload.size() == kLegacyImuBytes;
  }

  // With no stream chosen at opening: the first that sends a LiDAR packet.
  bool is_ours(const UdpDatagram& datagram) {
    if (!stream_) stream_ = stream_of(datagram);
    const bool ours = stream_of(datagram) == *stream_;
    if (!ours) count_rejected(rejected_, "other_sensor");
    return ours;
  }

  DatagramCapture capture_;
  std::optional<OusterStream> stream_;
  std::optional<std::uint16_t> imu_port_;  // none: not said, or shared with the LiDAR's packets
  OusterSweeps sweeps_;
  std::string kind_;
  bool ended_ = false;
  LidarTraits traits_;
  std::vector<std::string> notes_;
  Rejections rejected_;
};

}  // namespace

bool looks_like_pcap(const std::filesystem::path& path) {
  // Microseconds and nanoseconds in either byte order, and pcapng's section header.
  using Magic = std::array<unsigned char, 4>;
  constexpr std::array kMagics{Magic{0xA1, 0xB2, 0xC3, 0xD4}, Magic{0xD4, 0xC3, 0xB2, 0xA1},
                               Magic{0xA1, 0xB2, 0x3C, 0x4D}, Magic{0x4D, 0x3C, 0xB2, 0xA1},
                               Magic{0x0A, 0x0D, 0x0D, 0x0A}};
  Magic magic{};
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(magic.data()), magic.size());
  return file.good() && std::find(kMagics.begin(), kMagics.end(), magic) != kMagics.end();
}

Result<OusterCapture> open_ouster_capture(const std::filesystem::path& path) {
  const auto json = find_ouster_metadata(path);
  if (!json) return json.error();
  auto metadata = read_ouster_metadata(*json);
  if (!metadata) return metadata.error();
  auto searched = PcapFile::open(path);
  if (!searched) return searched.error();
  const auto stream = find_ouster_stream(std::move(*searched), *metadata);
  auto pcap = PcapFile::open(path);
  if (!pcap) return pcap.error();
  return OusterCapture{std::move(*pcap), std::move(*metadata), stream};
}

Result<std::unique_ptr<SweepSource>> open_ouster_pcap(const std::filesystem::path& path,
                                                      std::unique_ptr<SweepClock> clock, const std::string& kind) {
  auto opened = open_ouster_capture(path);
  if (!opened) return opened.error();
  if (!clock) clock = std::make_unique<StreamClock>(nominal_period(opened->metadata));
  return std::unique_ptr<SweepSource>(std::make_unique<OusterPcapSource>(std::move(opened->pcap), opened->metadata,
                                                                         opened->stream, std::move(clock), kind));
}

Result<std::unique_ptr<SweepSource>> open_ouster_pcap(const std::filesystem::path& path) {
  return open_ouster_pcap(path, nullptr, kKind);
}

std::unique_ptr<SweepSource> make_ouster_source(PcapFile pcap, const OusterMetadata& metadata,
                                                std::optional<OusterStream> stream) {
  return std::make_unique<OusterPcapSource>(std::move(pcap), metadata, stream,
                                            std::make_unique<StreamClock>(nominal_period(metadata)), kKind);
}

}  // namespace lxd

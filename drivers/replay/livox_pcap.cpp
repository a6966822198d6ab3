// SPDX-License-Identifier: Apache-2.0
// See livox_pcap.hpp.
#include "drivers/replay/livox_pcap.hpp"

#include <optional>

#include <fmt/format.h>

#include "drivers/lidar/livox_sweeps.hpp"
#include "drivers/replay/datagram_capture.hpp"
#include "drivers/replay/livox_stream.hpp"
#include "drivers/replay/stream_clock.hpp"

namespace lxd {
namespace {

class LivoxPcapSource final : public SweepSource {
 public:
  LivoxPcapSource(PcapFile pcap, const LivoxStream& stream, std::unique_ptr<SweepClock> clock, std::string kind)
      : capture_(std::move(pcap)),
        sender_(stream.sender),
        sweeps_(stream.parser, std::move(clock)),
        kind_(std::move(kind)) {}

  Result<bool> next(Sweep& sweep) override {
    const bool found = !ended_ && next_sweep(sweep);
    sweeps_.report(rejected_);
    capture_.report(rejected_);
    return found;
  }

  [[nodiscard]] std::optional<std::uint64_t> size() const override { return std::nullopt; }
  [[nodiscard]] std::string kind() const override { return kind_; }
  [[nodiscard]] LidarTraits traits() const override { return {0, 0, kLivoxSweepRate_hz}; }
  [[nodiscard]] const Rejections& rejected() const override { return rejected_; }

 private:
  bool next_sweep(Sweep& sweep) {
    while (const auto datagram = capture_.next(rejected_)) {
      if (is_point_packet(datagram->udp) && sweeps_.take(datagram->received, sweep)) return true;
    }
    ended_ = true;
    return sweeps_.flush(sweep);
  }

  bool is_point_packet(const UdpDatagram& datagram) {
    if (!sweeps_.parse(datagram.payload)) return false;
    if (sender_ == sender_of(datagram)) return true;
    count_rejected(rejected_, "other_sensor");
    return false;
  }

  DatagramCapture capture_;
  LivoxSender sender_;
  LivoxSweeps sweeps_;
  std::string kind_;
  bool ended_ = false;
  Rejections rejected_;
};

}  // namespace

Result<std::unique_ptr<SweepSource>> open_livox_pcap(const std::filesystem::path& path,
                                                     std::unique_ptr<SweepClock> clock, const std::string& kind) {
  auto pcap = PcapFile::open(path);
  if (!pcap) return pcap.error();
  const auto stream = find_livox_stream(path);
  if (!stream) return Error{fmt::format("{}: found no point packets of a Livox sensor", path.string())};
  if (!clock) clock = std::make_unique<StreamClock>(Duration::from_seconds(1 / kLivoxSweepRate_hz));
  return std::unique_ptr<SweepSource>(
      std::make_unique<LivoxPcapSource>(std::move(*pcap), *stream, std::move(clock), kind));
}

}  // namespace lxd

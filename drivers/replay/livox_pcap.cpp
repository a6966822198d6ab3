// SPDX-License-Identifier: Apache-2.0
// See livox_pcap.hpp.
#include "drivers/replay/livox_pcap.hpp"

#include <optional>
#include <vector>

#include <fmt/format.h>

#include "drivers/livox/sweep_builder.hpp"
#include "drivers/replay/datagram_capture.hpp"
#include "drivers/replay/livox_stream.hpp"
#include "drivers/replay/stream_clock.hpp"

namespace lxd {
namespace {

constexpr double kSweepRate_hz = 10;  // a scan without repetition has no turns: it is cut into sweeps of this rate
constexpr std::size_t kSweepPointsMax = 65'536;  // twice what 200,000 points a second fill
class LivoxPcapSource final : public SweepSource {
 public:
  LivoxPcapSource(PcapFile pcap, const LivoxStream& stream, std::unique_ptr<SweepClock> clock, std::string kind)
      : capture_(std::move(pcap)),
        stream_(stream),
        clock_(std::move(clock)),
        kind_(std::move(kind)),
        storage_(kSweepPointsMax) {
    building_.storage = storage_;
  }

  Result<bool> next(Sweep& sweep) override {
    bool found = false;
    while (!found && !ended_) found = next_sweep() && deliver(sweep);
    report_counts();
    return found;
  }

  [[nodiscard]] std::optional<std::uint64_t> size() const override { return std::nullopt; }
  [[nodiscard]] std::string kind() const override { return kind_; }
  [[nodiscard]] LidarTraits traits() const override { return {0, 0, kSweepRate_hz}; }
  [[nodiscard]] const Rejections& rejected() const override { return rejected_; }

 private:
  // True: `building_` holds a whole sweep; the packet that ended it waits in the parser's place.
  bool next_sweep() {
    if (pending_) begin_with_pending();
    while (const auto datagram = capture_.next(rejected_)) {
      if (!is_point_packet(datagram->udp)) continue;
      observe_time(datagram->received);
      if (builder_.completes(packet_)) {
        keep(datagram->udp);
        return builder_.close(building_);
      }
      builder_.add(packet_, building_);
    }
    ended_ = true;
    return builder_.close(building_);
  }

  bool is_point_packet(const UdpDatagram& datagram) {
    if (!stream_.parse(datagram.payload, packet_) || packet_.is_imu()) return false;
    if (stream_.sender == sender_of(datagram)) return true;
    count_rejected(rejected_, "other_sensor");
    return false;
  }

  void observe_time(RigTime received) {
    if (packet_.count == 0) return;
    clock_->observe(static_cast<std::int64_t>(packet_.timestamp_ns + packet_.duration_ns), received);
  }

  // The packet points into bytes that the next read overwrites.
  void keep(const UdpDatagram& datagram) {
    pending_bytes_.assign(datagram.payload.begin(), datagram.payload.end());
    pending_ = packet_;
    pending_->data = pending_bytes_.data() + (packet_.data - datagram.payload.data());
  }

  void begin_with_pending() {
    building_.count = 0;
    builder_.add(*pending_, building_);
    pending_.reset();
  }

  bool deliver(Sweep& sweep) {
    sweep.begin = building_.begin;
    sweep.end = building_.end;
    sweep.stamp = building_.stamp;
    if (!clock_->place(sweep, rejected_)) return false;
    for (const LidarPoint& point : building_.points()) {
      if (!sweep.push(point)) ++no_room_;
    }
    sweep.lidar = 0;
    sweep.sequence = sequence_++;
    return true;
  }

  // The parts count for themselves, in numbers that only grow; here they get their names.
  void report_counts() {
    const LivoxParserCounts& parser = stream_.counts();
    const LivoxSweepCounts& sweep = builder_.counts();
    set_rejected(rejected_, {{"bad_size", parser.bad_size},
                             {"bad_type", parser.bad_type},
                             {"bad_time_type", parser.bad_time_type},
                             {"bad_count", parser.bad_count},
                             {"bad_crc", parser.bad_crc},
                             {"bad_time", parser.bad_time},
                             {"bad_imu_values", parser.bad_imu_values},
                             {"no_return", sweep.no_return},
                             {"noise_tag", sweep.noise_tag},
                             {"above_capacity", sweep.above_capacity + no_room_},
                             {"repeated_packet", sweep.repeated_packets},
                             {"stale_packet", sweep.late_packets},
                             {"missing_packet", sweep.missing_packets}});
    capture_.report(rejected_);
  }

  DatagramCapture capture_;
  LivoxStream stream_;
  LivoxPacket packet_;
  LivoxSweepBuilder builder_{Duration::from_seconds(1 / kSweepRate_hz)};
  std::unique_ptr<SweepClock> clock_;
  std::string kind_;
  std::vector<LidarPoint> storage_;
  Sweep building_;
  std::optional<LivoxPacket> pending_;
  std::vector<std::uint8_t> pending_bytes_;
  std::uint64_t no_room_ = 0;  // points, in the sweep that was lent
  std::uint32_t sequence_ = 0;
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
  if (!clock) clock = std::make_unique<StreamClock>(Duration::from_seconds(1 / kSweepRate_hz));
  return std::unique_ptr<SweepSource>(
      std::make_unique<LivoxPcapSource>(std::move(*pcap), *stream, std::move(clock), kind));
}

}  // namespace lxd

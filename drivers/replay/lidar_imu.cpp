// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/lidar_imu.hpp"

#include <vector>

#include <fmt/format.h>

#include "drivers/lidar/livox_sweeps.hpp"
#include "drivers/lidar/ouster_sweeps.hpp"
#include "drivers/replay/datagram_capture.hpp"
#include "drivers/replay/livox_stream.hpp"
#include "drivers/replay/ouster_metadata_file.hpp"
#include "drivers/replay/ouster_pcap.hpp"
#include "drivers/replay/pps_log.hpp"
#include "drivers/replay/rig_clock.hpp"
#include "drivers/replay/rig_recording.hpp"
#include "drivers/replay/stream_clock.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;
using Opened = Result<std::unique_ptr<ImuSource>>;

constexpr std::size_t kSweepPointsMax = 262'144;  // of any sensor; the sweeps are built for their times only

class LidarImu final : public ImuSource {
 public:
  // address: the sensor's, IPv4.
  LidarImu(PcapFile pcap, std::uint32_t address, std::unique_ptr<PacketSweeps> sweeps)
      : capture_(std::move(pcap)), address_(address), sweeps_(std::move(sweeps)), storage_(kSweepPointsMax) {}

  bool next(ImuSample& sample) override {
    while (given_ == samples_.size()) {
      const auto datagram = capture_.next(counted_by_the_lidar_);
      if (!datagram) return false;
      if (datagram->udp.source_address == address_) take(*datagram);
    }
    sample = samples_[given_++];
    return true;
  }

  [[nodiscard]] Rejections rejected() const override {
    Rejections rejected;
    sweeps_->report_inertial(rejected);
    return rejected;
  }

 private:
  void take(const ReceivedDatagram& datagram) {
    samples_ = sweeps_->inertial(datagram.udp.payload, datagram.received);
    given_ = 0;
    if (!samples_.empty() || !sweeps_->parse(datagram.udp.payload)) return;
    Sweep sweep;
    sweep.storage = storage_;
    (void)sweeps_->take(datagram.received, sweep);
  }

  DatagramCapture capture_;
  std::uint32_t address_;
  std::unique_ptr<PacketSweeps> sweeps_;
  std::vector<LidarPoint> storage_;
  std::span<const ImuSample> samples_;
  std::size_t given_ = 0;
  Rejections counted_by_the_lidar_;
};

Opened open_ouster(const fs::path& path, std::unique_ptr<SweepClock> clock) {
  auto opened = open_ouster_capture(path);
  if (!opened) return opened.error();
  if (!opened->stream)
    return Error{fmt::format("{}: found no packet of the LiDAR that the metadata describes", path.string())};
  return Opened(std::make_unique<LidarImu>(std::move(opened->pcap), opened->stream->source_address,
                                           std::make_unique<OusterSweeps>(opened->metadata, std::move(clock))));
}

}  // namespace

Opened open_lidar_imu(const fs::path& recording, bool pulsed) {
  const bool rig = is_rig_recording(recording);
  const fs::path path = rig ? recording / "lidar0.pcap" : recording;
  auto pulses = recorded_pulses(recording, rig && pulsed);
  if (!pulses) return pulses.error();
  std::unique_ptr<SweepClock> clock;
  if (rig)
    clock = std::make_unique<RigClock>(ClockModelConfig{}, std::move(*pulses));
  else
    clock = std::make_unique<StreamClock>(Duration());
  if (find_ouster_metadata(path)) return open_ouster(path, std::move(clock));
  auto pcap = PcapFile::open(path);
  if (!pcap) return pcap.error();
  const auto stream = find_livox_stream(path);
  if (!stream) return Error{fmt::format("{}: found no point packets of a Livox sensor", path.string())};
  return Opened(std::make_unique<LidarImu>(std::move(*pcap), stream->sender.address,
                                           std::make_unique<LivoxSweeps>(stream->parser, std::move(clock))));
}

}  // namespace lxd

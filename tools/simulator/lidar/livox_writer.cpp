// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/livox_writer.hpp"

#include <algorithm>

#include "tools/recording/scan_folder_writer.hpp"
#include "tools/simulator/lidar/lidar_run.hpp"
#include "tools/simulator/lidar/livox_sender.hpp"
#include "tools/simulator/lidar/packet_run.hpp"

namespace lxd::sim {
namespace {

constexpr double kFrameRate_hz = static_cast<double>(kNanosPerSecond) / kLivoxFrame_ns;
constexpr std::uint16_t kPointSource = 56300, kPointPort = 56301, kImuSource = 56400, kImuPort = 56401;

class LivoxRun {
 public:
  LivoxRun(const Context& context, const LivoxConfig& config)
      : context_(context),
        config_(config),
        faults_(context.faults, config.sensor),
        clock_(config.clock, config.own_epoch(), context, faults_),
        scanner_(context, config),
        sender_(context, config, clock_, faults_) {}

  Status write_packets(const std::filesystem::path& folder, const LidarOutput& output) {
    auto pcap = PcapWriter::create(folder / (config_.sensor + ".pcap"), PcapStamps::of_wire);
    if (!pcap) return pcap.error();
    LidarWire wire(std::move(*pcap), lidar_route(config_.sensor, kPointSource, kPointPort),
                   lidar_route(config_.sensor, kImuSource, kImuPort), clock_, faults_,
                   Random(context_.seed, config_.sensor + "/wire"));
    LivoxImuSender imu(context_, config_, sender_.clock_type(), clock_);
    const auto make = [this](std::size_t i) {
      MadePackets made;
      made.datagrams = sender_.send(scan(i, made.log), made.log);
      return made;
    };
    return run_packets(context_, frames(), output, make, wire, imu, log_);
  }

  Status write_scans(const std::filesystem::path& folder, const LidarOutput& output) {
    auto scans = ScanFolderWriter::create(folder / config_.sensor);
    if (!scans) return scans.error();
    const auto make = [this](std::size_t i) { return make_scan(i); };
    return run_scans(frames(), output, make, *scans, log_);
  }

  [[nodiscard]] const LidarLog& log() const { return log_; }

 private:
  [[nodiscard]] std::uint64_t frames() const { return whole_periods(context_, kFrameRate_hz); }
  [[nodiscard]] static double begin_s(std::uint64_t number) { return livox_shot_s(livox_first_packet(number), 0); }

  [[nodiscard]] LivoxFrame scan(std::uint64_t number, LidarLog& log) const {
    LivoxFrame frame = scanner_.scan(number, faults_.shots(begin_s(number)));
    log.sweeps = 1;
    log.shots = frame.shots.size();
    log.returns = static_cast<std::uint64_t>(
        std::count_if(frame.shots.begin(), frame.shots.end(), [](const LivoxReturn& r) { return !r.p_m.isZero(0); }));
    return frame;
  }

  [[nodiscard]] MadeScan make_scan(std::uint64_t number) const {
    MadeScan made;
    if (faults_.silent(begin_s(number))) return made;
    const LivoxFrame frame = scan(number, made.log);
    made.scan.begin = context_.rig_time(begin_s(number));
    for (std::size_t i = 0; i < frame.shots.size(); ++i) {
      const LivoxReturn& shot = frame.shots[i];
      if (shot.p_m.isZero(0) || livox_tag_is_noise(shot.tag)) continue;
      const Eigen::Vector3f p = shot.p_m.cast<float>();
      made.scan.push(p.x(), p.y(), p.z(), static_cast<float>(shot.reflectivity), livox_shot_s(0, i));
    }
    return made;
  }

  const Context& context_;
  LivoxConfig config_;
  LidarFaults faults_;
  LidarClock clock_;
  LivoxScanner scanner_;
  LivoxSender sender_;
  LidarLog log_;
};

}  // namespace

Status check_livox(const Context& context, const LivoxConfig& config) {
  return check_lidar(context, config, kFrameRate_hz);
}

Result<LidarLog> write_livox(const Context& context, const LivoxConfig& config, const std::filesystem::path& folder,
                             const LidarOutput& output) {
  const Status sound = check_livox(context, config);
  if (!sound) return sound.error();
  LivoxRun run(context, config);
  const Status written =
      output.form == LidarForm::kPackets ? run.write_packets(folder, output) : run.write_scans(folder, output);
  if (!written) return written.error();
  return run.log();
}

}  // namespace lxd::sim

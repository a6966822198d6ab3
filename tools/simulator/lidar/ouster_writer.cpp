// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/ouster_writer.hpp"

#include <algorithm>

#include "drivers/ouster/xyz_table.hpp"
#include "tools/recording/scan_folder_writer.hpp"
#include "tools/recording/whole_file.hpp"
#include "tools/simulator/lidar/lidar_run.hpp"
#include "tools/simulator/lidar/ouster_encoder.hpp"
#include "tools/simulator/lidar/ouster_metadata.hpp"
#include "tools/simulator/lidar/ouster_sender.hpp"
#include "tools/simulator/lidar/packet_run.hpp"

namespace lxd::sim {
namespace {

class OusterRun {
 public:
  OusterRun(const Context& context, const OusterConfig& config, OusterMetadata metadata)
      : context_(context),
        config_(config),
        metadata_(std::move(metadata)),
        faults_(context.faults, config.sensor),
        clock_(config.clock, config.own_epoch(), context, faults_),
        scanner_(context, config, metadata_),
        sender_(context, config, metadata_, scanner_, clock_, faults_) {}

  Status write_packets(const std::filesystem::path& folder, const LidarOutput& output) {
    const std::string metadata = ouster_metadata_json(config_, context_.seed);
    const Status described = write_whole_file(folder / (config_.sensor + ".json"),
                                              std::as_bytes(std::span(metadata.data(), metadata.size())));
    if (!described) return described;
    auto pcap = PcapWriter::create(folder / (config_.sensor + ".pcap"), PcapStamps::of_wire);
    if (!pcap) return pcap.error();
    LidarWire wire(std::move(*pcap), route(config_.lidar_port), route(config_.imu_port), clock_, faults_,
                   Random(context_.seed, config_.sensor + "/wire"));
    OusterImuSender imu(context_, config_, sender_, clock_);
    const auto make = [this](std::size_t i) {
      MadePackets made;
      made.datagrams = sender_.send(scan(i, made.log), made.log);
      return made;
    };
    return run_packets(context_, turns(), output, make, wire, imu, log_);
  }

  Status write_scans(const std::filesystem::path& folder, const LidarOutput& output) {
    auto scans = ScanFolderWriter::create(folder / config_.sensor);
    if (!scans) return scans.error();
    const OusterXyzTable table(metadata_);
    const auto make = [&](std::size_t i) { return make_scan(i, table); };
    return run_scans(turns(), output, make, *scans, log_);
  }

  [[nodiscard]] const LidarLog& log() const { return log_; }

 private:
  [[nodiscard]] std::uint64_t turns() const { return whole_periods(context_, config_.rate_hz); }
  [[nodiscard]] UdpRoute route(std::uint32_t port) const {
    return lidar_route(config_.sensor, static_cast<std::uint16_t>(port), static_cast<std::uint16_t>(port));
  }

  [[nodiscard]] OusterTurn scan(std::uint64_t number, LidarLog& log) const {
    OusterTurn turn = scanner_.scan(number, faults_.shots(scanner_.column_s(number, 0)));
    log.sweeps = 1;
    log.shots = turn.pixels.size();
    log.returns = static_cast<std::uint64_t>(
        std::count_if(turn.pixels.begin(), turn.pixels.end(), [](const Return& r) { return r.found(); }));
    return turn;
  }

  [[nodiscard]] MadeScan make_scan(std::uint64_t number, const OusterXyzTable& table) const {
    MadeScan made;
    const double begin_s = scanner_.column_s(number, 0);
    if (faults_.silent(begin_s)) return made;
    const OusterTurn turn = scan(number, made.log);
    const std::size_t rows = metadata_.format.pixels_per_column;
    made.scan.begin = context_.rig_time(begin_s);
    for (std::size_t i = 0; i < turn.pixels.size(); ++i) {
      const Return& pixel = turn.pixels[i];
      if (!pixel.found()) continue;
      const auto range_mm = ouster_wire_range_mm(metadata_.format.profile->fields, scanner_.wire_range_m(pixel));
      const Eigen::Vector3f p = table.point(i, static_cast<std::uint32_t>(range_mm));
      const double offset_s = static_cast<double>(i / rows) * config_.column_period_s();
      made.scan.push(p.x(), p.y(), p.z(), static_cast<float>(ouster_wire_reflectivity(pixel)), offset_s);
    }
    return made;
  }

  const Context& context_;
  OusterConfig config_;
  OusterMetadata metadata_;
  LidarFaults faults_;
  LidarClock clock_;
  OusterScanner scanner_;
  OusterSender sender_;
  LidarLog log_;
};

}  // namespace

Status check_ouster(const Context& context, const OusterConfig& config) {
  return check_lidar(context, config, config.rate_hz);
}

Result<LidarLog> write_ouster(const Context& context, const OusterConfig& config, const std::filesystem::path& folder,
                              const LidarOutput& output) {
  auto metadata = ouster_metadata(config, context.seed);
  if (!metadata) return metadata.error();
  const Status sound = check_ouster(context, config);
  if (!sound) return sound.error();
  OusterRun run(context, config, std::move(*metadata));
  const Status written =
      output.form == LidarForm::kPackets ? run.write_packets(folder, output) : run.write_scans(folder, output);
  if (!written) return written.error();
  return run.log();
}

}  // namespace lxd::sim

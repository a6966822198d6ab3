// SPDX-License-Identifier: Apache-2.0
// Key names and shapes: metadata of firmware 2.x and 3.x in ouster-sdk 46b7bcee, tests/metadata.
#include "tools/simulator/lidar/ouster_metadata.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/simulator/random.hpp"

namespace lxd::sim {
namespace {

using nlohmann::json;

// Angles in degrees, lengths in mm, as of calibrated sensors: beams of four neighbouring rows are staggered in azimuth.
struct Optics {
  double top_deg, bottom_deg, stagger_deg, beam_origin_mm;
};
constexpr Optics kOs0{45.0, -45.0, 10.5, 27.67}, kOs1{21.0, -22.0, 4.22, 15.806};
constexpr std::array kStagger{1.0, 1.0 / 3, -1.0 / 3, -1.0};  // of the outermost, row by row
constexpr double kTolerance_deg = 0.05;
constexpr double kLidarHeight_mm = 36.18;
constexpr std::array kImuPosition_mm{6.253, -11.775, 7.645};
constexpr std::uint64_t kFirstSerial = 122'200'000'000, kSerials = 100'000'000;
constexpr std::uint32_t kInitIds = 0xFFFFFF;
constexpr double kMetersPerMillimeter = 1e-3;

const Optics& optics(const OusterConfig& config) { return config.product == "OS0" ? kOs0 : kOs1; }

double two_decimals(double value) { return std::round(value * 100) / 100; }

json transform(double diagonal_xy, double x_mm, double y_mm, double z_mm) {
  return {diagonal_xy, 0, 0, x_mm, 0, diagonal_xy, 0, y_mm, 0, 0, 1, z_mm, 0, 0, 0, 1};
}

std::string lidar_mode(const OusterConfig& config) { return fmt::format("{}x{}", config.columns, config.rate_hz); }
// A sensor without recorded IMU still has the profile.
std::string imu_profile(const OusterConfig& config) { return config.imu == "NONE" ? "LEGACY" : config.imu; }

json data_format(const OusterConfig& config, const OusterUnit& unit) {
  json shifts = json::array();
  for (const double azimuth : unit.azimuth_deg) shifts.push_back(std::lround(azimuth * config.columns / 360));
  return {{"column_window", {0, config.columns - 1}},
          {"columns_per_frame", config.columns},
          {"columns_per_packet", kOusterColumnsPerPacket},
          {"fps", config.rate_hz},
          {"pixel_shift_by_row", shifts},
          {"pixels_per_column", config.beams},
          {"udp_profile_imu", imu_profile(config)},
          {"udp_profile_lidar", config.profile}};
}

json config_params(const OusterConfig& config) {
  return {{"azimuth_window", {0, 360000}},
          {"columns_per_packet", kOusterColumnsPerPacket},
          {"lidar_mode", lidar_mode(config)},
          {"multipurpose_io_mode", "OFF"},
          {"operating_mode", "NORMAL"},
          {"phase_lock_enable", false},
          {"phase_lock_offset", 0},
          {"signal_multiplier", 1},
          {"timestamp_mode", config.clock_source},
          {"udp_dest", "192.168.1.5"},
          {"udp_port_imu", config.imu_port},
          {"udp_port_lidar", config.lidar_port},
          {"udp_profile_imu", imu_profile(config)},
          {"udp_profile_lidar", config.profile}};
}

json sensor_info(const OusterConfig& config, const OusterUnit& unit, std::uint32_t init_id) {
  return {{"build_date", "2026-01-01T00:00:00Z"},
          {"build_rev", "simulated"},
          {"image_rev", "lxd-slam-simulator"},
          {"initialization_id", init_id},
          {"prod_line", fmt::format("OS-{}-{}", config.product.back(), config.beams)},
          {"prod_pn", "000-000000-00"},
          {"prod_sn", std::to_string(unit.serial)},
          {"status", "RUNNING"}};
}

}  // namespace

OusterUnit ouster_unit(const OusterConfig& config, std::uint64_t seed, std::uint64_t number) {
  Random random(seed, config.sensor + "/unit", number);
  const Optics& o = optics(config);
  OusterUnit unit;
  unit.serial = kFirstSerial + random.bits() % kSerials;
  for (std::uint32_t row = 0; row < config.beams; ++row) {
    const double part = static_cast<double>(row) / (config.beams - 1);
    const double altitude = o.top_deg + (o.bottom_deg - o.top_deg) * part;
    const double azimuth = o.stagger_deg * kStagger[row % kStagger.size()];
    unit.altitude_deg.push_back(two_decimals(altitude + random.uniform(-kTolerance_deg, kTolerance_deg)));
    unit.azimuth_deg.push_back(two_decimals(azimuth + random.uniform(-kTolerance_deg, kTolerance_deg)));
  }
  return unit;
}

std::uint32_t ouster_init_id(const OusterConfig& config, std::uint64_t seed, std::uint32_t boot) {
  return static_cast<std::uint32_t>(1 + Random(seed, config.sensor + "/init", boot).bits() % kInitIds);
}

std::string ouster_metadata_json(const OusterConfig& config, std::uint64_t seed) {
  const OusterUnit unit = ouster_unit(config, seed);
  const Optics& o = optics(config);
  json file;
  file["beam_intrinsics"] = {{"beam_altitude_angles", unit.altitude_deg},
                             {"beam_azimuth_angles", unit.azimuth_deg},
                             {"beam_to_lidar_transform", transform(1, o.beam_origin_mm, 0, 0)},
                             {"lidar_origin_to_beam_origin_mm", o.beam_origin_mm}};
  file["calibration_status"] = {{"reflectivity", {{"timestamp", "2026-01-01T00:00:00"}, {"valid", true}}}};
  file["config_params"] = config_params(config);
  file["imu_data_format"] = {{"imu_measurements_per_packet", kOusterImuRecords},
                             {"imu_packets_per_frame", kOusterImuPacketsPerTurn}};
  file["imu_intrinsics"] = {
      {"imu_to_sensor_transform", transform(1, kImuPosition_mm[0], kImuPosition_mm[1], kImuPosition_mm[2])}};
  file["lidar_data_format"] = data_format(config, unit);
  file["lidar_intrinsics"] = {{"lidar_to_sensor_transform", transform(-1, 0, 0, kLidarHeight_mm)}};
  file["sensor_info"] = sensor_info(config, unit, ouster_init_id(config, seed, 0));
  file["user_data"] = "";
  return file.dump(4) + "\n";
}

Result<OusterMetadata> ouster_metadata(const OusterConfig& config, std::uint64_t seed) {
  return parse_ouster_metadata(ouster_metadata_json(config, seed), config.sensor + ".json");
}

std::pair<double, double> ouster_fov_deg(const OusterConfig& config, std::uint64_t seed) {
  const OusterUnit unit = ouster_unit(config, seed);
  const auto [low, high] = std::minmax_element(unit.altitude_deg.begin(), unit.altitude_deg.end());
  return {*low, *high};
}

Pose ouster_T_sensor_imu(const OusterConfig&) {
  Pose T;
  T.p = Eigen::Vector3d(kImuPosition_mm[0], kImuPosition_mm[1], kImuPosition_mm[2]) * kMetersPerMillimeter;
  return T;
}

}  // namespace lxd::sim

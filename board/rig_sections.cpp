// SPDX-License-Identifier: Apache-2.0
#include "board/rig_sections.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include <fmt/format.h>

#include "board/default/capacities.hpp"
#include "drivers/imu/imu_protocol.hpp"

namespace lxd {
namespace {

constexpr std::array<std::string_view, 2> kLidarModels{"spinning", "livox"};
constexpr std::array<std::string_view, 1> kCameraModels{"pinhole"};
constexpr std::array<std::string_view, 3> kDistortionModels{"radtan", "equidistant", "none"};

// Ranges: what sensors on the market do, with room on both sides.
constexpr ValueRange kImuRate{10, 10'000, "Hz", "is it a period?"};
constexpr ValueRange kLidarRate{1, 100, "Hz", "is it points or packets a second?"};
constexpr ValueRange kCameraRate{0.1, 1000, "Hz", ""};
constexpr ValueRange kGnssRate{0.1, 100, "Hz", ""};
constexpr ValueRange kRotationSigma{0, 5, "degrees", ""};
constexpr ValueRange kGyroscopeNoise{1e-7, 1, "rad/s/sqrt(Hz)", "is it in degrees?"};
constexpr ValueRange kAccelerometerNoise{1e-7, 1, "m/s^2/sqrt(Hz)", "is it in micro-g?"};
constexpr ValueRange kGyroscopeWalk{0, 1, "rad/s^2/sqrt(Hz)", "is it in degrees an hour?"};
constexpr ValueRange kAccelerometerWalk{0, 1, "m/s^3/sqrt(Hz)", "is it in micro-g?"};
constexpr ValueRange kBeams{1, 256, "beams", ""};
constexpr ValueRange kColumns{1, 8192, "columns", ""};
constexpr ValueRange kElevation{-180, 180, "degrees", ""};
constexpr ValueRange kRange{0, 1000, "m", "is it in millimetres?"};
constexpr ValueRange kRangeSigma{1e-4, 1, "m", "is it in millimetres?"};
constexpr ValueRange kBaudRate{1200, 4e6, "baud", ""};
constexpr ValueRange kPixels{1, 16'384, "pixels", ""};
constexpr ValueRange kFocal{1, 100'000, "pixels", ""};
constexpr ValueRange kDistortion{-100, 100, "", ""};
constexpr ValueRange kLeverArm{-100, 100, "m", "is it in millimetres?"};

// Half a turn in radians: no LiDAR sees less than this many degrees, none more than this many radians.
constexpr double kNarrowestField_deg = std::numbers::pi;

using Interval = std::array<double, 2>;

std::optional<Interval> read_interval(YamlSection& section, std::string_view key, const ValueRange& range) {
  const auto values = section.read_numbers(key, 2, range);
  if (!values) return std::nullopt;
  if ((*values)[0] < (*values)[1]) return Interval{(*values)[0], (*values)[1]};
  section.complain(key, fmt::format("found [{}, {}], wanted the lower number first", (*values)[0], (*values)[1]));
  return std::nullopt;
}

std::optional<Interval> read_field_of_view(YamlSection& section) {
  const auto field = read_interval(section, "fov_deg", kElevation);
  if (!field || (*field)[1] - (*field)[0] > kNarrowestField_deg) return field;
  section.complain("fov_deg",
                   fmt::format("found [{}, {}], wanted a field wider than {:.2f} degrees (it looks like radians)",
                               (*field)[0], (*field)[1], kNarrowestField_deg));
  return std::nullopt;
}

void check_sweep_fits(YamlSection& section, const LidarRig& lidar) {
  const std::size_t points = std::size_t{lidar.beams} * lidar.columns;
  if (points <= capacities::kSweepPointsMax) return;
  section.complain("columns",
                   fmt::format("found {} x {} = {} points a sweep, wanted at most {} (the board profile's capacity)",
                               lidar.beams, lidar.columns, points, capacities::kSweepPointsMax));
}

template <std::size_t N>
void read_array(YamlSection& section, std::string_view key, std::array<double, N>& values, const ValueRange& range) {
  if (const auto found = section.read_numbers(key, N, range)) std::ranges::copy(*found, values.begin());
}

}  // namespace

void read_keys(YamlSection& section, ImuRig& imu) {
  static constexpr auto kProtocols = [] {
    std::array<std::string_view, kImuProtocolNames.size() + 1> names{};
    std::ranges::copy(kImuProtocolNames, names.begin());
    names.back() = kLidarImuProtocol;
    return names;
  }();
  section.read("update_rate", imu.update_rate, kImuRate);
  section.read("gyroscope_noise_density", imu.gyroscope_noise_density, kGyroscopeNoise);
  section.read("accelerometer_noise_density", imu.accelerometer_noise_density, kAccelerometerNoise);
  section.read("gyroscope_random_walk", imu.gyroscope_random_walk, kGyroscopeWalk);
  section.read("accelerometer_random_walk", imu.accelerometer_random_walk, kAccelerometerWalk);
  section.read("delay_s", imu.delay_s, kDelay);
  section.read("delay_sigma_s", imu.delay_sigma_s, kDelaySigma);
  section.read("rotation_sigma_deg", imu.rotation_sigma_deg, kRotationSigma);
  section.read("protocol", imu.protocol, kProtocols);
  section.read("baud_rate", imu.baud_rate, kBaudRate);
  read_wire(section, imu.wire);
}

void read_keys(YamlSection& section, LidarRig& lidar) {
  section.read("model", lidar.model, kLidarModels);
  section.read("beams", lidar.beams, kBeams);
  section.read("columns", lidar.columns, kColumns);
  check_sweep_fits(section, lidar);
  section.read("rate_hz", lidar.rate_hz, kLidarRate);
  lidar.fov_deg = read_field_of_view(section);
  lidar.range_m = read_interval(section, "range_m", kRange);
  double sigma_m = 0;
  section.read("range_sigma_m", sigma_m, kRangeSigma);
  if (sigma_m > 0) lidar.range_sigma_m = sigma_m;
  read_wire(section, lidar.wire);
}

void read_keys(YamlSection& section, CameraRig& camera) {
  section.read("camera_model", camera.camera_model, kCameraModels);
  section.read("distortion_model", camera.distortion_model, kDistortionModels);
  section.require("resolution", "[width, height] in pixels: it has no default");
  std::array<double, 2> resolution{};
  read_array(section, "resolution", resolution, kPixels);
  camera.resolution = {static_cast<std::uint32_t>(resolution[0]), static_cast<std::uint32_t>(resolution[1])};
  section.require("intrinsics", "[fx, fy, cx, cy] in pixels: it has no default");
  read_array(section, "intrinsics", camera.intrinsics, kFocal);
  read_array(section, "distortion_coeffs", camera.distortion_coeffs, kDistortion);
  section.read("rate_hz", camera.rate_hz, kCameraRate);
  section.read("delay_s", camera.delay_s, kDelay);
  section.read("delay_sigma_s", camera.delay_sigma_s, kDelaySigma);
  section.read("rotation_sigma_deg", camera.rotation_sigma_deg, kRotationSigma);
  read_wire(section, camera.wire);
}

void read_keys(YamlSection& section, GnssRig& gnss) {
  section.read("rate_hz", gnss.rate_hz, kGnssRate);
  section.read("baud_rate", gnss.baud_rate, kBaudRate);
  read_wire(section, gnss.wire);
  const auto antenna = section.read_numbers("antenna_in_reference_m", 3, kLeverArm);
  if (antenna) gnss.antenna_in_reference_m = {(*antenna)[0], (*antenna)[1], (*antenna)[2]};
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// The rig as its file describes it: one plain struct a sensor, in the file's own keys and units, with the defaults of
// what the file leaves out.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "board/camera_wire.hpp"
#include "board/rig_wires.hpp"
#include "board/sync_wires.hpp"
#include "drivers/replay/source.hpp"
#include "drivers/wheel/can_table.hpp"
#include "rt/pose.hpp"

namespace lxd {

inline constexpr std::string_view kLidarImuProtocol = "lidar0";

// Noise defaults are those of the ADIS16448 as EuRoC publishes them for Kalibr (continuous time).
struct ImuRig {
  // The IMU is the one inside the primary LiDAR, and comes with its packets.
  [[nodiscard]] bool of_lidar() const { return protocol == kLidarImuProtocol; }

  double update_rate = 200;                     // Hz
  double gyroscope_noise_density = 1.6968e-4;   // rad/s/sqrt(Hz)
  double accelerometer_noise_density = 2.0e-3;  // m/s^2/sqrt(Hz)
  double gyroscope_random_walk = 1.9393e-5;     // rad/s^2/sqrt(Hz)
  double accelerometer_random_walk = 3.0e-3;    // m/s^3/sqrt(Hz)
  double delay_s = 0;                           // its readings are stamped so much later than the LiDAR's returns
  double delay_sigma_s = 0.002;                 // how sure that is; 0: exactly, and so it is of a LiDAR's own IMU
  double rotation_sigma_deg = 0.5;              // how sure its rotation against the LiDAR is, about an axis; 0: exactly
  std::string protocol = "vectornav";           // of imu.serial: kImuProtocolNames; or kLidarImuProtocol
  double baud_rate = 115200;                    // of its line
  SerialWire wire;
  Pose T_reference_sensor;
};

// Zero or nothing: not given, the recording or the settings know.
struct LidarRig {
  std::string model = "spinning";  // spinning | livox
  std::uint32_t beams = 0;
  std::uint32_t columns = 0;
  double rate_hz = 10;
  std::optional<std::array<double, 2>> fov_deg;  // lowest and highest elevation
  std::optional<std::array<double, 2>> range_m;  // nearest and farthest
  std::optional<double> range_sigma_m;           // standard deviation of one range
  LidarWire wire;
  Pose T_reference_sensor;
};

struct CameraRig {
  std::string camera_model = "pinhole";
  std::string distortion_model = "radtan";    // radtan | equidistant | none
  std::array<std::uint32_t, 2> resolution{};  // width, height; pixels
  std::array<double, 4> intrinsics{};         // fx, fy, cx, cy; pixels
  std::array<double, 4> distortion_coeffs{};  // k1, k2, p1, p2 (radtan); k1 .. k4 (equidistant)
  double rate_hz = 10;
  double delay_s = 0;               // its images are stamped so much later than the LiDAR's returns
  double delay_sigma_s = 0.005;     // how sure that is; 0: exactly
  double rotation_sigma_deg = 0.5;  // how sure that of T_reference_sensor is, about an axis; 0: exactly
  CameraWire wire;
  Pose T_reference_sensor;
};

// The protocol of a vehicle whose messages the rig file describes itself.
inline constexpr std::string_view kWheelTableProtocol = "table";

// A frame of the vehicle's bus, as the rig file describes it.
struct WheelMessageRig {
  std::uint32_t id = 0;
  bool extended = false;  // the id has 29 bits
  std::uint8_t length = 8;
  CanChecksum checksum = CanChecksum::none;
  std::vector<CanSignal> signals;
};

struct WheelRig {
  double rate_hz = 50;
  double speed_sigma_mps = 0.05;
  double yaw_rate_sigma_radps = 0.01;
  double delay_s = 0;                     // its readings are stamped so much later than the LiDAR's returns
  double delay_sigma_s = 0.02;            // how sure that is; 0: exactly
  std::string protocol = "agilex";        // of can.log: kVehicles or kWheelTableProtocol
  std::string kinematics;                 // kWheelKinematicsNames; empty: as is usual for the protocol
  double track_m = 0.6;                   // between the wheels of the axle that turns by their difference
  double wheelbase_m = 0;                 // between the axles; 0: not given
  std::vector<WheelMessageRig> messages;  // of kWheelTableProtocol
  CanWire wire;
  Pose T_reference_sensor;
};

struct GnssRig {
  double rate_hz = 5;
  double baud_rate = 115200;  // of its line
  SerialWire wire;
  Eigen::Vector3d antenna_in_reference_m = Eigen::Vector3d::Zero();
};

struct Rig {
  std::string reference = "lidar0";  // the frame of the extrinsics and of the published path
  std::optional<ImuRig> imu;
  LidarRig lidar0;
  std::optional<LidarRig> lidar1;
  std::optional<CameraRig> camera0;
  std::optional<WheelRig> wheel;
  std::optional<GnssRig> gnss;
  std::optional<PulseRig> pps;
  std::optional<TriggersRig> triggers;
};

// The rig of a recording that has no rig file: its LiDAR alone, which is the reference too.
Rig default_rig(const LidarTraits& traits);

// What the rig's file left out and the recording knows: beams, columns.
void complete(Rig& rig, const LidarTraits& traits);

}  // namespace lxd

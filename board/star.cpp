// SPDX-License-Identifier: Apache-2.0
#include "board/star.hpp"

#include <fmt/format.h>

namespace lxd {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d M;
  M << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return M;
}

std::string_view missing_sensor(const Rig& rig, const SensorSet& used) {
  if (used.extra_lidar && !rig.lidar1) return "lidar1";
  if (used.camera && !rig.camera0) return "camera0";
  if (used.imu && !rig.imu) return "imu";
  if (used.wheel && !rig.wheel) return "wheel";
  if (used.gnss && !rig.gnss) return "gnss";
  return {};
}

struct Body {
  std::string_view name;
  Pose T_reference_body;
};

Body choose_body(const Rig& rig, const SensorSet& used) {
  if (used.imu) return {"imu", rig.imu->T_reference_sensor};
  if (used.wheel) return {"wheel", rig.wheel->T_reference_sensor};
  if (used.camera) return {"camera0", rig.camera0->T_reference_sensor};
  return {"lidar0", rig.lidar0.T_reference_sensor};
}

}  // namespace

Result<Star> resolve_star(const Rig& rig, const SensorSet& sensors) {
  const std::string_view missing = missing_sensor(rig, sensors);
  if (!missing.empty()) {
    return Error{
        fmt::format("--sensors {}: found no {} in the rig file, wanted its section", text_of(sensors), missing)};
  }
  const Body body = choose_body(rig, sensors);
  Star star;
  star.body = body.name;
  star.body_is_reference = body.name == rig.reference;
  star.T_body_reference = body.T_reference_body.inverse();
  const auto T_body = [&](const auto& sensor) { return star.T_body_reference * sensor.T_reference_sensor; };
  star.T_body_lidar0 = T_body(rig.lidar0);
  if (sensors.extra_lidar) star.T_body_lidar1 = T_body(*rig.lidar1);
  if (sensors.camera) star.T_body_camera0 = T_body(*rig.camera0);
  if (sensors.imu) star.T_body_imu = T_body(*rig.imu);
  if (sensors.wheel) star.T_body_wheel = T_body(*rig.wheel);
  if (sensors.gnss) star.antenna_in_body_m = star.T_body_reference * rig.gnss->antenna_in_reference_m;
  return star;
}

PoseCovariance carry_covariance(const Pose& T_world_body, const Pose& T_body_reference, const PoseCovariance& of_body) {
  PoseCovariance J = PoseCovariance::Identity();
  J.topLeftCorner<3, 3>() = T_body_reference.R.transpose();
  J.bottomLeftCorner<3, 3>() = -T_world_body.R * cross_matrix(T_body_reference.p);
  return J * of_body * J.transpose();
}

}  // namespace lxd

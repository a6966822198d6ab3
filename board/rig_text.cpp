// SPDX-License-Identifier: Apache-2.0
#include "board/rig_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "board/wheel_table.hpp"

namespace lxd {
namespace {

template <typename List>
std::string list_text(const List& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

// One section: `name:` and its keys below.
class SectionText {
 public:
  SectionText(std::string& out, std::string_view name) : out_(out) { out_ += fmt::format("{}:\n", name); }

  template <typename Value>
  SectionText& add(std::string_view key, const Value& value) {
    out_ += fmt::format("  {}: {}\n", key, value);
    return *this;
  }
  SectionText& add_lines(std::string_view lines) {
    out_ += lines;
    return *this;
  }
  void add(const Pose& T_reference_sensor) { add("T_reference_sensor", transform_text(T_reference_sensor)); }

 private:
  std::string& out_;
};

void append(std::string& out, const ImuRig& imu) {
  SectionText(out, "imu")
      .add("update_rate", imu.update_rate)
      .add("gyroscope_noise_density", imu.gyroscope_noise_density)
      .add("accelerometer_noise_density", imu.accelerometer_noise_density)
      .add("gyroscope_random_walk", imu.gyroscope_random_walk)
      .add("accelerometer_random_walk", imu.accelerometer_random_walk)
      .add("delay_s", imu.delay_s)
      .add("delay_sigma_s", imu.delay_sigma_s)
      .add("rotation_sigma_deg", imu.rotation_sigma_deg)
      .add("protocol", imu.protocol)
      .add("baud_rate", imu.baud_rate)
      .add_lines(text_of(imu.wire))
      .add(imu.T_reference_sensor);
}

void append(std::string& out, std::string_view name, const LidarRig& lidar) {
  SectionText section(out, name);
  section.add("model", lidar.model);
  if (lidar.beams > 0) section.add("beams", lidar.beams);
  if (lidar.columns > 0) section.add("columns", lidar.columns);
  section.add("rate_hz", lidar.rate_hz);
  if (lidar.fov_deg) section.add("fov_deg", list_text(*lidar.fov_deg));
  if (lidar.range_m) section.add("range_m", list_text(*lidar.range_m));
  if (lidar.range_sigma_m) section.add("range_sigma_m", *lidar.range_sigma_m);
  section.add_lines(text_of(lidar.wire)).add(lidar.T_reference_sensor);
}

void append(std::string& out, const CameraRig& camera) {
  SectionText(out, "camera0")
      .add("camera_model", camera.camera_model)
      .add("distortion_model", camera.distortion_model)
      .add("resolution", list_text(camera.resolution))
      .add("intrinsics", list_text(camera.intrinsics))
      .add("distortion_coeffs", list_text(camera.distortion_coeffs))
      .add("rate_hz", camera.rate_hz)
      .add("delay_s", camera.delay_s)
      .add("delay_sigma_s", camera.delay_sigma_s)
      .add("rotation_sigma_deg", camera.rotation_sigma_deg)
      .add_lines(text_of(camera.wire))
      .add(camera.T_reference_sensor);
}

void append(std::string& out, const WheelRig& wheel) {
  SectionText(out, "wheel")
      .add("rate_hz", wheel.rate_hz)
      .add("speed_sigma_mps", wheel.speed_sigma_mps)
      .add("yaw_rate_sigma_radps", wheel.yaw_rate_sigma_radps)
      .add("delay_s", wheel.delay_s)
      .add("delay_sigma_s", wheel.delay_sigma_s)
      .add("protocol", wheel.protocol)
      .add("kinematics", kWheelKinematicsNames[static_cast<std::size_t>(wheel_source(wheel))])
      .add("track_m", wheel.track_m)
      .add("wheelbase_m", wheel.wheelbase_m)
      .add_lines(text_of(wheel.wire))
      .add(wheel.T_reference_sensor);
  if (!wheel.messages.empty()) out += "  messages:\n" + wheel_messages_text(wheel);
}

void append(std::string& out, const GnssRig& gnss) {
  SectionText(out, "gnss")
      .add("rate_hz", gnss.rate_hz)
      .add("baud_rate", gnss.baud_rate)
      .add_lines(text_of(gnss.wire))
      .add("antenna_in_reference_m", list_text(gnss.antenna_in_reference_m));
}

void append(std::string& out, const Settings& settings) {
  out += "settings:\n";
  for (const SettingChoice& choice : choices_of(settings)) {
    out += fmt::format("  {}: {}  # {}\n", choice.key, choice.value, comment_of(choice.key));
  }
}

}  // namespace

std::string transform_text(const Pose& T) {
  std::string rows;
  for (int r = 0; r < 3; ++r) rows += fmt::format("[{}, {}, {}, {}], ", T.R(r, 0), T.R(r, 1), T.R(r, 2), T.p[r]);
  return "[" + rows + "[0, 0, 0, 1]]";
}

std::string rig_text(const Rig& rig) {
  std::string out = fmt::format("reference: {}\n", rig.reference);
  if (rig.imu) append(out, *rig.imu);
  append(out, "lidar0", rig.lidar0);
  if (rig.lidar1) append(out, "lidar1", *rig.lidar1);
  if (rig.camera0) append(out, *rig.camera0);
  if (rig.wheel) append(out, *rig.wheel);
  if (rig.gnss) append(out, *rig.gnss);
  if (rig.pps) out += rig_text(*rig.pps);
  if (rig.triggers) out += rig_text(*rig.triggers);
  return out;
}

std::string rig_text(const Rig& rig, const Settings& settings) {
  std::string out = "# The configuration in force in this run, defaults and all.\n" + rig_text(rig);
  append(out, settings);
  return out;
}

}  // namespace lxd

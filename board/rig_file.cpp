// SPDX-License-Identifier: Apache-2.0
#include "board/rig_file.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "board/nearest_names.hpp"
#include "board/rig_sections.hpp"
#include "board/rig_transform.hpp"

namespace lxd {
namespace {

constexpr std::array<std::string_view, 6> kSensors{"imu", "lidar0", "lidar1", "camera0", "wheel", "gnss"};
constexpr std::string_view kExtrinsicKey = "T_reference_sensor";
constexpr std::string_view kAntennaKey = "antenna_in_reference_m";

// Transforms by the names that other programs give them, so that their users are told the sense and the inverse.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kForeignTransforms{{
    {"T_cam_imu", "Kalibr's, takes points of the IMU to the camera: with reference: imu give its inverse"},
    {"T_imu_cam", "takes points of the camera to the IMU: with reference: imu give it unchanged"},
    {"T_BS", "EuRoC's, takes points of the sensor to the body: with that body as reference give it unchanged"},
    {"extrinsic_T", "FAST-LIO's: give it and extrinsic_R as one 4 x 4 matrix"},
    {"extrinsic_R", "FAST-LIO's: give it and extrinsic_T as one 4 x 4 matrix"},
}};

// The sections of the file, read in one go around its reference.
class RigReader {
 public:
  RigReader(YamlSection& root, std::string_view file, RigFile& out) : root_(root), file_(file), out_(out) {}

  void read() {
    read_reference();
    (void)root_.find("notes");
    read_optional("imu", out_.rig.imu);
    read_lidar0();
    read_optional("lidar1", out_.rig.lidar1);
    read_optional("camera0", out_.rig.camera0);
    read_optional("wheel", out_.rig.wheel);
    read_gnss();
    read_signal("pps", out_.rig.pps);
    read_signal("triggers", out_.rig.triggers);
    read_settings();
    for (const auto& problems : {shared_wires(out_.rig), sync_problems(out_.rig)})
      for (const std::string& problem : problems) out_.problems.push_back({std::string(file_), "", problem});
    root_.reject_unknown();
  }

 private:
  void read_reference() {
    root_.read("reference", out_.rig.reference);
    if (!root_.has("reference"))
      out_.remarks.push_back(fmt::format("{}: reference: not given, lidar0 is taken", file_));
    reference_is_sensor_ =
        std::ranges::find(kSensors, out_.rig.reference) != kSensors.end() && root_.has(out_.rig.reference);
  }

  YamlSection open(std::string_view sensor, const YAML::Node& node) {
    return YamlSection(node, std::string(sensor), file_, out_.problems);
  }

  void read_lidar0() {
    const auto node = root_.find("lidar0");
    if (!node) return root_.complain("lidar0", "found nothing, wanted the primary LiDAR: every rig has one");
    read_sensor("lidar0", *node, out_.rig.lidar0);
  }

  template <typename Sensor>
  void read_optional(std::string_view name, std::optional<Sensor>& sensor) {
    const auto node = root_.find(name);
    if (node) read_sensor(name, *node, sensor.emplace());
  }

  template <typename Sensor>
  void read_sensor(std::string_view name, const YAML::Node& node, Sensor& sensor) {
    YamlSection section = open(name, node);
    read_keys(section, sensor);
    read_extrinsic(section, name, sensor.T_reference_sensor);
    explain_foreign_transforms(section);
    section.reject_unknown();
  }

  // Of time: it has no place on the rig.
  template <typename Signal>
  void read_signal(std::string_view name, std::optional<Signal>& signal) {
    const auto node = root_.find(name);
    if (!node) return;
    YamlSection section = open(name, *node);
    read_keys(section, signal.emplace());
    section.reject_unknown();
  }

  void read_gnss() {
    const auto node = root_.find("gnss");
    if (!node) return;
    YamlSection section = open("gnss", *node);
    read_keys(section, out_.rig.gnss.emplace());
    if (!section.has(kAntennaKey)) miss_extrinsic(section, "gnss", kAntennaKey);
    if (out_.rig.reference == "gnss" && !out_.rig.gnss->antenna_in_reference_m.isZero()) {
      section.complain(kAntennaKey, "found an offset, wanted 0 0 0: gnss is itself the reference");
    }
    section.reject_unknown();
  }

  void read_extrinsic(YamlSection& section, std::string_view sensor, Pose& T_reference_sensor) {
    const bool given = section.has(kExtrinsicKey);
    T_reference_sensor = read_transform(section, kExtrinsicKey).value_or(Pose{});
    if (!given) return miss_extrinsic(section, sensor, kExtrinsicKey);
    const bool is_identity = T_reference_sensor.R.isIdentity() && T_reference_sensor.p.isZero();
    if (sensor == out_.rig.reference && !is_identity) {
      section.complain(kExtrinsicKey,
                       fmt::format("found a transform, wanted the identity: {} is itself the reference", sensor));
    }
  }

  // Where the reference is a sensor of the file, the identity is taken; a frame that no section defines needs every
  // one.
  void miss_extrinsic(YamlSection& section, std::string_view sensor, std::string_view key) {
    if (sensor == out_.rig.reference) return;
    if (reference_is_sensor_) {
      out_.remarks.push_back(fmt::format("{}: {}: not given, {} is taken to sit in {} (identity)", file_,
                                         section.path_of(key), sensor, out_.rig.reference));
      return;
    }
    section.complain(key, fmt::format("found nothing, wanted it given: the reference '{}' is no sensor of this file{}",
                                      out_.rig.reference, did_you_mean(out_.rig.reference, kSensors)));
  }

  static void explain_foreign_transforms(YamlSection& section) {
    for (const auto& [key, sense] : kForeignTransforms) {
      if (!section.has(key)) continue;
      const auto node = section.find(key);
      section.complain(
          *node, key,
          fmt::format("unknown key, wanted {} (p_reference = T * p_sensor); this one is {}", kExtrinsicKey, sense));
    }
  }

  void read_settings() {
    const auto node = root_.find("settings");
    if (!node) return;
    const YamlSection section = open("settings", *node);
    if (!node->IsMap()) return;
    for (const auto& pair : *node) read_setting(pair.first, pair.second);
  }

  void read_setting(const YAML::Node& key, const YAML::Node& value) {
    if (!key.IsScalar()) return;  // the section has complained
    const std::string text = value.IsScalar() ? value.Scalar() : describe(value);
    Settings checked;
    const Status status = set(checked, key.Scalar(), text);
    if (status) return out_.settings.push_back({key.Scalar(), text});
    out_.problems.push_back({place_of(file_, key.Mark()), "settings", status.error().message});
  }

  YamlSection& root_;
  std::string_view file_;
  RigFile& out_;
  bool reference_is_sensor_ = false;
};

// OpenCV's head line is no YAML directive; as a comment it keeps the line numbers.
void hide_opencv_head(std::string& text) {
  if (text.starts_with("%YAML:")) text.front() = '#';
}

}  // namespace

RigFile parse_rig(std::string text, std::string_view name) {
  RigFile file;
  hide_opencv_head(text);
  try {
    const YAML::Node node = YAML::Load(text);
    YamlSection root(node, "", name, file.problems);
    if (node.IsMap()) RigReader(root, name, file).read();
  } catch (const YAML::Exception& e) {
    file.problems.push_back({place_of(name, e.mark), "", fmt::format("found no sound YAML: {}", e.msg)});
  }
  std::ranges::stable_sort(file.problems, {}, [](const Problem& p) { return std::pair(p.place.size(), p.place); });
  return file;
}

RigFile load_rig(const std::string& path) {
  std::ifstream in(path);
  std::stringstream text;
  if (in) text << in.rdbuf();
  if (in && text) return parse_rig(text.str(), path);
  RigFile file;
  file.problems.push_back({path, "", "found no readable file, wanted a rig file"});
  return file;
}

}  // namespace lxd

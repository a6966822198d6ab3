// SPDX-License-Identifier: Apache-2.0
// See metadata.hpp. Keys and defaults: ouster-sdk 46b7bcee, ouster_core/src/{metadata,data_format}.cpp.
#include "drivers/ouster/metadata.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <Eigen/LU>
#include <fmt/format.h>

#include "drivers/ouster/json_reader.hpp"

namespace lxd {
namespace {

using nlohmann::json;
using Bounds = JsonReader::Bounds;

constexpr double kMetersPerMillimeter = 1e-3;
constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr Bounds kAltitudeDeg{-90, 90};
constexpr Bounds kAzimuthDeg{-360, 360};
constexpr Bounds kTransformEntries{-1e4, 1e4};  // mm; a beam starts centimetres from the sensor's origin
constexpr Bounds kPorts{0, 65535};
constexpr Bounds kInitIds{0, 0xFFFFFF};              // 24 bits in the packet
constexpr std::uint64_t kSerialLimit = 1ULL << 40U;  // 40 bits in the packet
constexpr Bounds kPixelsPerColumn{1, 256};
constexpr Bounds kColumnsPerFrame{1, 4096};        // the SDK's widest mode
constexpr std::uint16_t kOldPixelsPerColumn = 64;  // firmware before 1.14 sends 64 rows whatever the model
constexpr std::uint16_t kOldColumnsPerPacket = 16;
constexpr double kDefaultLidarHeightMm = 36.18;  // of every sensor up to firmware 2.5
constexpr double kRotationTolerance = 1e-3;

// Where each shape keeps a group of keys; the flat one keeps nearly all at the top.
struct Shape {
  std::string beams, lidar, format, config, info;
};
const Shape kFlat{"", "", "data_format.", "", ""};
const Shape kSections{"beam_intrinsics.", "lidar_intrinsics.", "lidar_data_format.", "config_params.", "sensor_info."};

// `list` has words with single spaces between.
bool listed(std::string_view list, const std::string& word) {
  return (" " + std::string(list) + " ").find(" " + word + " ") != std::string::npos;
}

class Loader {
 public:
  Loader(const json& root, const std::string& file) : in_(root, file) {}

  Result<OusterMetadata> load() {
    check_sections();
    read_sensor();
    read_mode();
    read_format();
    if (in_.sound()) read_beams();
    if (in_.sound()) read_transforms();
    if (!in_.sound()) return Error{in_.faults()};
    return std::move(out_);
  }

 private:
  // A document with one section has all of them: less is a cut file, or one mixed by hand of both shapes.
  void check_sections() {
    if (in_.find("beam_intrinsics") == nullptr) return;
    shape_ = kSections;
    for (const char* name : {"beam_intrinsics", "lidar_intrinsics", "imu_intrinsics", "config_params", "sensor_info"}) {
      if (!in_.has_object(name))
        in_.fault_missing(name, "a section (the file has beam_intrinsics, so it should have all)");
    }
    // Firmware before 2.1 answers "error: Command not recognized." to these two, which is an answer.
    for (const char* name : {"lidar_data_format", "calibration_status"}) {
      if (in_.find(name) == nullptr)
        in_.fault_missing(name, "a section (the file has beam_intrinsics, so it should have all)");
    }
  }

  void read_sensor() {
    out_.product_line = in_.text(shape_.info + "prod_line").value_or("");
    if (const auto id = in_.integer(shape_.info + "initialization_id", kInitIds)) {
      out_.init_id = static_cast<std::uint32_t>(*id);
    }
    out_.serial = read_serial();
    out_.lidar_port = read_port("udp_port_lidar");
    out_.imu_port = read_port("udp_port_imu");
  }

  // A number as text; old firmware and hand-made files have other text, which no packet can be checked against.
  std::optional<std::uint64_t> read_serial() {
    const std::string text = in_.text(shape_.info + "prod_sn").value_or("");
    std::uint64_t serial = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), serial);
    const bool whole = fault == std::errc() && end == text.data() + text.size();
    return whole && serial < kSerialLimit ? std::optional(serial) : std::nullopt;
  }

  std::optional<std::uint16_t> read_port(const std::string& key) {
    const auto port = in_.integer(shape_.config + key, kPorts);
    if (!port || *port == 0) return std::nullopt;
    return static_cast<std::uint16_t>(*port);
  }

  // "1024x10": columns a turn, turns a second.
  void read_mode() {
    const std::string path = shape_.config + "lidar_mode";
    const std::string mode = in_.text(path).value_or("");
    constexpr std::string_view kModes = "512x10 512x20 1024x10 1024x20 2048x10 4096x5";
    if (mode.empty() || mode.find(' ') != std::string::npos || !listed(kModes, mode)) {
      in_.fault(path, fmt::format("found \"{}\", wanted one of {}", mode, kModes));
      return;
    }
    const std::size_t cross = mode.find('x');
    mode_columns_ = std::stoi(mode.substr(0, cross));
    out_.rate_hz = std::stoi(mode.substr(cross + 1));
  }

  void read_format() {
    const std::string section = shape_.format.substr(0, shape_.format.size() - 1);
    if (in_.has_object(section)) {
      read_counts();
      read_profile();
    } else {
      assume_old_format(section);
    }
    if (in_.sound() && out_.format.packet_bytes() > kOusterMaxPacketBytes) {
      in_.fault(section, fmt::format("makes packets of {} bytes, wanted at most {}", out_.format.packet_bytes(),
                                     kOusterMaxPacketBytes));
    }
  }

  void read_counts() {
    const std::string path = shape_.format + "columns_per_frame";
    const auto frame = in_.want_integer(path, kColumnsPerFrame);
    const auto packet = in_.want_integer(shape_.format + "columns_per_packet", {1, kOusterMaxColumnsPerPacket});
    const auto rows = in_.want_integer(shape_.format + "pixels_per_column", kPixelsPerColumn);
    if (frame && mode_columns_ != 0 && *frame != mode_columns_) {
      in_.fault(path, fmt::format("found {}, wanted {} as lidar_mode says", *frame, mode_columns_));
    }
    if (!frame || !packet || !rows) return;
    out_.columns_per_frame = static_cast<std::uint16_t>(*frame);
    out_.format.columns_per_packet = static_cast<std::uint16_t>(*packet);
    out_.format.pixels_per_column = static_cast<std::uint16_t>(*rows);
    read_pixel_shift();
  }

  void read_pixel_shift() {
    const double columns = out_.columns_per_frame;
    const auto shifts =
        in_.want_numbers(shape_.format + "pixel_shift_by_row", out_.format.pixels_per_column, {-columns, columns});
    if (shifts) out_.pixel_shift.assign(shifts->begin(), shifts->end());
  }

  void read_profile() {
    const std::string path = shape_.format + "udp_profile_lidar";
    const std::string name = in_.text(path).value_or("LEGACY");  // firmware before 2.2 knows no other
    out_.format.profile = find_ouster_profile(name);
    if (out_.format.profile != nullptr) return;
    std::string known;
    for (const OusterProfile& profile : ouster_profiles()) known += fmt::format(" {}", profile.name);
    in_.fault(path, fmt::format("found \"{}\", wanted one of:{}", name, known));
  }

  void assume_old_format(const std::string& section) {
    out_.format = {find_ouster_profile("LEGACY"), kOldColumnsPerPacket, kOldPixelsPerColumn};
    out_.columns_per_frame = static_cast<std::uint16_t>(mode_columns_);
    for (int row = 0; row < kOldPixelsPerColumn; ++row) {
      out_.pixel_shift.push_back((3 - row % 4) * 3 * mode_columns_ / 512);  // 9,6,3,0 at 512 columns, and in proportion
    }
    out_.notes.push_back(section + " is missing: assumed the LEGACY profile, 16 columns a packet, 64 rows");
  }

  void read_beams() {
    const std::size_t rows = out_.format.pixels_per_column;
    const auto altitude = in_.want_numbers(shape_.beams + "beam_altitude_angles", rows, kAltitudeDeg);
    const auto azimuth = in_.want_numbers(shape_.beams + "beam_azimuth_angles", rows, kAzimuthDeg);
    if (!altitude || !azimuth) return;
    const auto is_zero = [](double angle) { return angle == 0; };
    if (rows > 1 && std::all_of(altitude->begin(), altitude->end(), is_zero)) {
      in_.fault(shape_.beams + "beam_altitude_angles", "found zeros only, wanted the beams' calibrated angles");
    }
    for (const double angle : *altitude) out_.altitude_rad.push_back(angle * kRadPerDeg);
    for (const double angle : *azimuth) out_.azimuth_rad.push_back(angle * kRadPerDeg);
  }

  void read_transforms() {
    const std::string beam = shape_.beams + "beam_to_lidar_transform";
    if (in_.find(beam) != nullptr) {
      out_.T_lidar_beam = read_transform(beam);
    } else {
      out_.T_lidar_beam(0, 3) = beam_origin_mm() * kMetersPerMillimeter;
    }
    const std::string lidar = shape_.lidar + "lidar_to_sensor_transform";
    if (in_.find(lidar) != nullptr) {
      out_.T_sensor_lidar = read_transform(lidar);
    } else {
      out_.T_sensor_lidar.diagonal() << -1, -1, 1, 1;  // half a turn about z
      out_.T_sensor_lidar(2, 3) = kDefaultLidarHeightMm * kMetersPerMillimeter;
      out_.notes.push_back(lidar + " is missing: assumed half a turn about z and 36.18 mm up");
    }
  }

  Eigen::Matrix4d read_transform(const std::string& path) {
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    const auto entries = in_.want_numbers(path, 16, kTransformEntries);
    if (!entries) return T;
    T = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(entries->data());
    const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
    const bool rotation = (R * R.transpose()).isIdentity(kRotationTolerance) && R.determinant() > 0;
    if (!rotation || T.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
      in_.fault(path, "found a matrix that is no rigid transform, wanted 16 numbers row by row, translation in mm");
    }
    T.topRightCorner<3, 1>() *= kMetersPerMillimeter;
    return T;
  }

  double beam_origin_mm() {
    const std::string path = shape_.beams + "lidar_origin_to_beam_origin_mm";
    if (const json* const value = in_.find(path)) {
      if (value->is_number() && std::abs(value->get<double>()) <= kTransformEntries.high) return value->get<double>();
      in_.fault(path, "found no number of millimetres");
      return 0;
    }
    const double assumed = default_beam_origin_mm();
    out_.notes.push_back(fmt::format("{} is missing: assumed {} mm", path, assumed));
    return assumed;
  }

  [[nodiscard]] double default_beam_origin_mm() const {
    struct Model {
      const char* prefix;
      double beam_origin_mm;
    };
    constexpr double kFirstGeneration = 12.163;
    for (const Model& model : {Model{"OS-0-", 27.67}, Model{"OS-1-", 15.806}, Model{"OS-2-", 13.762}}) {
      if (out_.product_line.starts_with(model.prefix)) return model.beam_origin_mm;
    }
    return kFirstGeneration;
  }

  JsonReader in_;
  Shape shape_ = kFlat;
  int mode_columns_ = 0;
  OusterMetadata out_;
};

}  // namespace

Result<OusterMetadata> parse_ouster_metadata(std::string_view text, const std::string& file) {
  json root;
  try {
    root = json::parse(text);
  } catch (const json::parse_error& error) {
    return Error{fmt::format("{}: byte {}: no JSON ({})", file, error.byte, error.what())};
  } catch (const json::out_of_range& error) {  // a number that no double holds
    return Error{fmt::format("{}: no JSON that can be read ({})", file, error.what())};
  }
  if (!root.is_object())
    return Error{fmt::format("{}: found no JSON object, wanted an Ouster sensor's metadata", file)};
  return Loader(root, file).load();
}

}  // namespace lxd

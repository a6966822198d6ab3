// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluate/recording_panels.hpp"

#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>

#include "board/default/capacities.hpp"
#include "board/recorded_sensors.hpp"
#include "drivers/replay/open.hpp"

namespace lxd {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};

// A panel's curves under way; stamps become seconds when the origin is known.
class Series {
 public:
  explicit Series(std::vector<std::string> names) : names_(std::move(names)), values_(names_.size()) {}

  void add(RigTime t, std::initializer_list<double> values) {
    times_.push_back(t);
    std::size_t i = 0;
    for (const double value : values) values_[i++].push_back(value);
  }
  [[nodiscard]] bool empty() const { return times_.empty(); }
  [[nodiscard]] const std::vector<RigTime>& times() const { return times_; }

  [[nodiscard]] SensorPanel panel(const std::string& title, const std::string& unit, RigTime origin,
                                  SensorPanel::Kind kind = SensorPanel::Kind::curves) const {
    SensorPanel panel{kind, title, unit, {}};
    for (std::size_t i = 0; i < names_.size(); ++i) {
      TimeSeries series{names_[i], {}, values_[i]};
      for (const RigTime t : times_) series.t_s.push_back((t - origin).seconds());
      panel.series.push_back(std::move(series));
    }
    return panel;
  }

 private:
  std::vector<std::string> names_;
  std::vector<RigTime> times_;
  std::vector<std::vector<double>> values_;
};

struct Collected {
  Series sweep{{"points"}};
  Series gyro{{kAxes.begin(), kAxes.end()}}, accel{{kAxes.begin(), kAxes.end()}};
  Series speed{{"forward"}}, yaw_rate{{"about z"}};
  Series gnss{{"quality (4 fixed, 5 float, 1 single, 0 none)"}}, gnss_sigma{{"north", "east", "up"}};
  Series exposure{{"exposure"}};
  std::optional<RigTime> origin;
};

Status collect_sweeps(const std::filesystem::path& recording, Collected& all) {
  const auto source = open_recording(recording, {});
  if (!source) return source.error();
  std::vector<LidarPoint> storage(capacities::kSweepPointsMax);
  Sweep sweep;
  sweep.storage = storage;
  for (;;) {
    sweep.count = 0;
    const auto found = (*source)->next(sweep);
    if (!found) return found.error();
    if (!*found) return success();
    if (!all.origin) all.origin = sweep.begin;
    all.sweep.add(sweep.stamp, {static_cast<double>(sweep.count)});
  }
}

Status collect_others(const std::filesystem::path& recording, const Rig& rig, Collected& all) {
  SensorReaders readers;
  readers.imu = [&](const ImuSample& s) {
    all.gyro.add(s.t, {s.gyro_radps.x(), s.gyro_radps.y(), s.gyro_radps.z()});
    all.accel.add(s.t, {s.accel_mps2.x(), s.accel_mps2.y(), s.accel_mps2.z()});
  };
  readers.wheel = [&](const WheelSample& s) {
    all.speed.add(s.received, {s.speed_mps});
    all.yaw_rate.add(s.received, {s.yaw_rate_radps});
  };
  readers.gnss = [&](const GnssFix& fix) {
    all.gnss.add(fix.received, {static_cast<double>(fix.quality)});
    all.gnss_sigma.add(fix.received, {fix.sigma_latitude_m.value_or(kUnknown), fix.sigma_longitude_m.value_or(kUnknown),
                                      fix.sigma_altitude_m.value_or(kUnknown)});
  };
  const auto rejected = read_recorded_sensors(recording, rig, readers);
  return rejected ? success() : Status(rejected.error());
}

// frames.csv: image, sequence, exposure_begin_s, exposure_s, gain, received_s, corrupt. A line that is none is passed
// over: the driver's own counts are not this picture's business.
void collect_frames(const std::filesystem::path& recording, Collected& all) {
  constexpr int kMilli = 1000;
  std::ifstream file(recording / "camera0" / "frames.csv");
  for (std::string line; std::getline(file, line);) {
    std::stringstream fields(line);
    std::string image, sequence, begin, exposure;
    std::getline(fields, image, ',');
    std::getline(fields, sequence, ',');
    std::getline(fields, begin, ',');
    std::getline(fields, exposure, ',');
    char* end = nullptr;
    const double begin_s = std::strtod(begin.c_str(), &end);
    const double exposure_s = std::strtod(exposure.c_str(), nullptr);
    if (begin.empty() || end == begin.c_str() || exposure_s <= 0) continue;
    all.exposure.add(RigTime::from_seconds(begin_s), {kMilli * exposure_s});
  }
}

void append(std::vector<SensorPanel>& panels, const Series& series, const std::string& title, const std::string& unit,
            RigTime origin, SensorPanel::Kind kind = SensorPanel::Kind::curves) {
  if (!series.empty()) panels.push_back(series.panel(title, unit, origin, kind));
}

// Between samples, of every sensor: what is late or lost stands out.
void append_intervals(std::vector<SensorPanel>& panels, const Series& series, const std::string& title,
                      RigTime origin) {
  constexpr std::size_t kFewest = 3;
  if (series.times().size() < kFewest) return;
  panels.push_back(
      {SensorPanel::Kind::histogram, title, "ms", {intervals_ms("between samples", series.times(), origin)}});
}

std::vector<SensorPanel> panels_of(const Collected& all) {
  const RigTime origin = *all.origin;
  constexpr auto kDots = SensorPanel::Kind::dots;
  std::vector<SensorPanel> panels;
  append(panels, all.sweep, "lidar0", "points a sweep", origin);
  append_intervals(panels, all.sweep, "lidar0", origin);
  append(panels, all.gyro, "imu: rate", "rad/s", origin);
  append(panels, all.accel, "imu: specific force", "m/s^2", origin);
  append_intervals(panels, all.gyro, "imu", origin);
  append(panels, all.exposure, "camera0: exposure", "ms", origin);
  append_intervals(panels, all.exposure, "camera0", origin);
  append(panels, all.speed, "wheel: speed", "m/s", origin);
  append(panels, all.yaw_rate, "wheel: yaw rate", "rad/s", origin);
  append_intervals(panels, all.speed, "wheel", origin);
  append(panels, all.gnss, "gnss: fix", "", origin, kDots);
  append(panels, all.gnss_sigma, "gnss: sigma", "m", origin);
  return panels;
}

}  // namespace

Result<std::vector<SensorPanel>> recording_panels(const std::filesystem::path& recording, const Rig& rig) {
  Collected all;
  const Status swept = collect_sweeps(recording, all);
  if (!swept) return swept.error();
  if (!all.origin) return Error{recording.string() + ": found no sweep, wanted a recording"};
  const Status read = collect_others(recording, rig, all);
  if (!read) return read.error();
  if (rig.camera0) collect_frames(recording, all);
  return panels_of(all);
}

}  // namespace lxd

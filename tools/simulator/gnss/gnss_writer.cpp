// SPDX-License-Identifier: Apache-2.0
// See gnss_writer.hpp.
#include "tools/simulator/gnss/gnss_writer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "backend/part_file.hpp"
#include "tools/recording/nmea_encoder.hpp"
#include "tools/simulator/gnss/receiver.hpp"
#include "tools/simulator/gnss/sky.hpp"
#include "tools/simulator/sync/sensor_instants.hpp"
#include "tools/simulator/units.hpp"

namespace lxd::sim {
namespace {

constexpr double kAlways = std::numeric_limits<double>::infinity();
constexpr std::array kFaults{
    KnownFault{"gnss_jump", 5, 20, "m", "every position is off by as much, at once"},
    KnownFault{"gnss_spoof", kAlways, 100, "m", "the position is dragged away over 30 s, and the speed with it"},
    KnownFault{"gnss_empty", 10, 0, "", "no fix: the fields are empty"},
    KnownFault{"gnss_rtk_loss", 20, 0, "", "no corrections: single fixes, then float until it is fixed again"},
    KnownFault{"leap_second", kAlways, 0, "", "the second before is repeated (as :60 after :59); UTC stays 1 s behind"},
};
constexpr double kSpoofDrag_s = 30;
constexpr double kPdopOfHdop = 1.7, kVdopOfHdop = 1.4;
constexpr double kGnssBitsPerByte = 10, kLineEnd = 2;  // of a serial line, and of a sentence

class GnssWriter {
 public:
  GnssWriter(const Context& context, const GnssConfig& config, const EnuFrame& frame, PartFile& file)
      : context_(context),
        config_(config),
        frame_(frame),
        file_(file),
        clock_(config.clock, context.start),
        sky_(config.mask_deg * kDegree_rad),
        state_(config, context.seed),
        errors_(config, context.seed) {
    Random random(context.seed, "gnss_attack");
    const double azimuth_rad = random.uniform(0, 2 * std::numbers::pi);
    astray_ = {std::cos(azimuth_rad), std::sin(azimuth_rad), 0};
  }

  // Epochs are at whole periods of UTC.
  void write() {
    const auto period_ns = static_cast<std::int64_t>(std::llround(1e9 / config_.rate_hz));
    for (std::int64_t utc_ns = first_multiple(clock_, context_.start, period_ns);; utc_ns += period_ns) {
      const RigTime t = rig_time_of(clock_, utc_ns);
      const double t_s = (t - context_.start).seconds();
      if (t_s >= context_.duration_s) return;
      write_epoch(t_s, utc_ns);
    }
  }
  [[nodiscard]] const GnssLog& log() const { return log_; }

 private:
  [[nodiscard]] bool fault(std::string_view name, double t_s) const {
    return context_.faults.active(name, t_s) != nullptr;
  }

  void write_epoch(double t_s, std::int64_t utc_ns) {
    const MotionState body = context_.motion.at(t_s);
    const Eigen::Vector3d antenna_m = body.T_world_body * config_.antenna_in_reference_m;
    const double blocked = sky_.blocked_part(context_.scene, antenna_m, t_s);
    const GnssQuality quality = state_.step(t_s, blocked, fault("gnss_empty", t_s), fault("gnss_rtk_loss", t_s));
    const GnssError error = errors_.step(t_s, quality, blocked);
    GnssFix fix;
    fix.quality = quality;
    if (quality != GnssQuality::none) {
      set_position(fix, to_enu(antenna_m) + error.error_m + drag(t_s).offset_m, error, blocked);
      set_motion(fix, body, t_s);
    }
    count(quality);
    put(encode_epoch(fix, label(t_s, utc_ns)), context_.rig_time(t_s + config_.processing_s));
  }

  [[nodiscard]] Eigen::Vector3d to_enu(const Eigen::Vector3d& in_world) const {
    return Eigen::AngleAxisd(config_.enu_yaw_rad, Eigen::Vector3d::UnitZ()) * in_world;
  }

  void set_position(GnssFix& fix, const Eigen::Vector3d& enu_m, const GnssError& error, double blocked) const {
    const Geodetic place = frame_.to_geodetic(enu_m);
    fix.latitude_deg = place.latitude_deg;
    fix.longitude_deg = place.longitude_deg;
    fix.altitude_msl_m = place.height_m - config_.geoid_m;
    fix.geoid_m = config_.geoid_m;
    fix.sigma_longitude_m = error.reported_sigma_m.x();
    fix.sigma_latitude_m = error.reported_sigma_m.y();
    fix.sigma_altitude_m = error.reported_sigma_m.z();
    fix.hdop = hdop(blocked);
    fix.pdop = kPdopOfHdop * *fix.hdop;
    fix.vdop = kVdopOfHdop * *fix.hdop;
    fix.satellites = static_cast<std::uint32_t>(std::max(4L, std::lround(config_.satellites * (1 - blocked))));
    if (fix.quality != GnssQuality::single) fix.correction_age_s = 1;
  }

  void set_motion(GnssFix& fix, const MotionState& body, double t_s) {
    const Eigen::Vector3d v_world =
        body.v_world_mps + body.T_world_body.R * body.omega_body_radps.cross(config_.antenna_in_reference_m);
    Eigen::Vector3d v_enu = to_enu(v_world) + drag(t_s).speed_mps;
    for (int axis = 0; axis < 3; ++axis) v_enu[axis] += velocity_.normal(config_.speed_sigma_mps);
    fix.speed_mps = v_enu.head<2>().norm();
    const double course_rad = std::atan2(v_enu.x(), v_enu.y());
    fix.course_rad = course_rad < 0 ? course_rad + 2 * std::numbers::pi : course_rad;
  }

  // By jump and spoof, which may be on together.
  struct Drag {
    Eigen::Vector3d offset_m = Eigen::Vector3d::Zero(), speed_mps = Eigen::Vector3d::Zero();
  };
  [[nodiscard]] Drag drag(double t_s) const {
    Drag drag;
    if (const Fault* const jump = context_.faults.active("gnss_jump", t_s)) drag.offset_m += jump->value * astray_;
    if (const Fault* const spoof = context_.faults.active("gnss_spoof", t_s)) {
      const double part = (t_s - spoof->begin_s) / kSpoofDrag_s;
      drag.offset_m += std::min(part, 1.0) * spoof->value * astray_;
      if (part < 1) drag.speed_mps = spoof->value / kSpoofDrag_s * astray_;
    }
    return drag;
  }

  // A leap second happens at a whole second of UTC, and once it has, it has for good.
  [[nodiscard]] UtcLabel label(double t_s, std::int64_t utc_ns) const {
    constexpr std::int64_t kMinute = 60;
    for (const Fault& fault : context_.faults.all()) {
      if (fault.name != "leap_second" || t_s < fault.begin_s) continue;
      const std::int64_t begin_ns = first_multiple(clock_, context_.rig_time(fault.begin_s), kNanosPerSecond);
      if (utc_ns < begin_ns) continue;
      const std::int64_t labelled_ns = utc_ns - kNanosPerSecond;
      const bool end_of_minute = labelled_ns / kNanosPerSecond % kMinute == kMinute - 1;
      return {labelled_ns, end_of_minute && utc_ns < begin_ns + kNanosPerSecond};
    }
    return {utc_ns, false};
  }

  void put(const std::vector<std::string>& sentences, RigTime sent) {
    RigTime received = clock_.received(sent, latency_);
    for (const std::string& sentence : sentences) {
      received_ = std::max(received_, received);
      file_.write_text(
          fmt::format("{}.{:09} {}\n", received_.ns() / kNanosPerSecond, received_.ns() % kNanosPerSecond, sentence));
      const double bytes = static_cast<double>(sentence.size()) + kLineEnd;
      received = received_ + Duration::from_seconds(bytes * kGnssBitsPerByte / config_.baud_rate);
      ++log_.sentences;
    }
  }

  void count(GnssQuality quality) {
    ++log_.epochs;
    ++(quality == GnssQuality::none        ? log_.none
       : quality == GnssQuality::single    ? log_.single
       : quality == GnssQuality::rtk_float ? log_.rtk_float
                                           : log_.rtk_fixed);
  }

  const Context& context_;
  const GnssConfig& config_;
  const EnuFrame& frame_;
  PartFile& file_;
  SensorClock clock_;
  Sky sky_;
  FixState state_;
  GnssErrors errors_;
  Random latency_{context_.seed, "gnss_latency"}, velocity_{context_.seed, "gnss_velocity"};
  Eigen::Vector3d astray_;
  RigTime received_;
  GnssLog log_;
};

// The longest that the receiver has to say at once: every field filled, with all the digits that it may have.
double longest_epoch_bytes() {
  constexpr double kDegrees = 179.5, kMetres = -9999.5, kSigma_m = 999.5, kDilution = 99.5, kSpeed_mps = 100;
  GnssFix fix;
  fix.quality = GnssQuality::rtk_fixed;
  fix.latitude_deg = -kDegrees / 2;
  fix.longitude_deg = -kDegrees;
  fix.altitude_msl_m = kMetres;
  fix.geoid_m = kMetres;
  fix.sigma_latitude_m = fix.sigma_longitude_m = fix.sigma_altitude_m = kSigma_m;
  fix.hdop = fix.pdop = fix.vdop = kDilution;
  fix.satellites = 60;
  fix.correction_age_s = kDilution;
  fix.speed_mps = kSpeed_mps;
  fix.course_rad = kDegrees * kDegree_rad;
  double bytes = 0;
  for (const std::string& sentence : encode_epoch(fix, {})) bytes += static_cast<double>(sentence.size()) + kLineEnd;
  return bytes;
}

}  // namespace

Status check_gnss(const GnssConfig& config) {
  const double bits_per_s = kGnssBitsPerByte * longest_epoch_bytes() * config.rate_hz;
  if (bits_per_s <= config.baud_rate) return success();
  return Error{fmt::format("gnss: found a baud_rate of {}, wanted at least {:.0f} ({} Hz of GGA, RMC, GST and GSA)",
                           config.baud_rate, std::ceil(bits_per_s), config.rate_hz)};
}

std::span<const KnownFault> gnss_faults() { return kFaults; }

Result<GnssLog> write_gnss(const Context& context, const GnssConfig& config, const std::filesystem::path& folder) {
  if (const Status sound = check_gnss(config); !sound.ok()) return sound.error();
  const Result<EnuFrame> frame = EnuFrame::at(config.origin);
  if (!frame.ok()) return frame.error();
  Result<PartFile> file = PartFile::create(folder / "gnss.nmea");
  if (!file.ok()) return file.error();
  GnssWriter writer(context, config, *frame, *file);
  writer.write();
  if (const Status written = file->commit(); !written.ok()) return written.error();
  return writer.log();
}

}  // namespace lxd::sim

// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/imu_writer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "backend/part_file.hpp"
#include "backend/trajectory_writer.hpp"
#include "drivers/replay/serial_log_writer.hpp"
#include "tools/simulator/clock_check.hpp"
#include "tools/simulator/imu/imu_encoder.hpp"
#include "tools/simulator/imu/imu_model.hpp"
#include "tools/simulator/imu/serial_line.hpp"

namespace lxd::sim {
namespace {

constexpr double kTruthPeriod_s = 0.1;
constexpr double kBitsPerByte = 10;

// "t,x,y,z,x,y,z"
std::string csv_line(RigTime t, const Eigen::Vector3d& gyro, const Eigen::Vector3d& accel) {
  return fmt::format("{},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}\n", seconds_text(t), gyro.x(), gyro.y(),
                     gyro.z(), accel.x(), accel.y(), accel.z());
}

// A text file, or nothing where it was not asked for.
class OptionalCsv {
 public:
  static Result<OptionalCsv> create(bool wanted, const std::filesystem::path& path, std::string_view header) {
    OptionalCsv csv;
    if (!wanted) return csv;
    Result<PartFile> file = PartFile::create(path);
    if (!file) return file.error();
    file->write_text(header);
    csv.file_.emplace(std::move(*file));
    return csv;
  }
  Status append(RigTime t, const Inertial& values) {
    if (!file_) return success();
    file_->write_text(csv_line(t, values.gyro_radps, values.accel_mps2));
    return file_->status();
  }
  Status commit() { return file_ ? file_->commit() : success(); }

 private:
  std::optional<PartFile> file_;
};

// One recording's IMU under way.
class Recorder {
 public:
  Recorder(const Context& context, const ImuConfig& config, std::optional<SerialLogWriter>& log, OptionalCsv& truth,
           OptionalCsv& generic)
      : context_(context),
        config_(config),
        clock_(config.clock, context.start),
        model_(config, context.motion, context.seed, "imu"),
        faults_(context.faults),
        jitter_(context.seed, "imu.clock"),
        truth_(truth),
        generic_(generic) {
    if (log) line_.emplace(config.line, clock_, context.start, Random(context.seed, "imu.line"), *log);
  }

  Status run() {
    for (ImuModelSample sample = model_.next(); sample.t_s <= context_.duration_s; sample = model_.next()) {
      if (Status done = note_bias(sample); !done) return done;
      if (Status done = send(sample); !done) return done;
    }
    return line_ ? line_->finish() : success();
  }

  [[nodiscard]] ImuWritten written() const { return {samples_, bytes_, faults_.counts()}; }

 private:
  Status note_bias(const ImuModelSample& sample) {
    const double row_s = static_cast<double>(truth_rows_) * kTruthPeriod_s;
    if (sample.t_s < row_s - sample_period_s(config_) / 2) return success();
    ++truth_rows_;
    return truth_.append(context_.rig_time(sample.t_s), sample.bias);
  }

  Status send(const ImuModelSample& sample) {
    const RigTime t = context_.rig_time(sample.t_s);
    const std::optional<Inertial> values = faults_.apply(sample.measured, sample.t_s);
    const Duration fault = Duration::from_seconds(faults_.clock_error_s(sample.t_s));
    const std::int64_t stamp_ns = clock_.stamped_ns(t, jitter_) + fault.ns();
    if (!values) return success();
    ++samples_;
    // What a perfect clock model makes of the stamp.
    const RigTime mapped = t + Duration::from_ns(stamp_ns - clock_.sensor_ns(t));
    if (Status done = generic_.append(mapped, *values); !done || !line_) return done;
    const std::vector<std::uint8_t> bytes = encode_sample(config_.protocol, samples_, stamp_ns, *values);
    bytes_ += bytes.size();
    return line_->send(t, bytes);
  }

  const Context& context_;
  const ImuConfig& config_;
  SensorClock clock_;
  ImuModel model_;
  ImuFaults faults_;
  Random jitter_;
  OptionalCsv& truth_;
  OptionalCsv& generic_;
  std::optional<SerialLine> line_;
  std::uint64_t truth_rows_ = 0, samples_ = 0, bytes_ = 0;
};

}  // namespace

namespace {

Status check_imu_clock(const Context& context, const ImuConfig& config) {
  const SensorClock clock(config.clock, context.start);
  ImuFaults faults(context.faults);
  const auto stamp_ns = [&](double t_s) {
    return clock.sensor_ns(context.rig_time(t_s)) + Duration::from_seconds(faults.clock_error_s(t_s)).ns();
  };
  for (const double t_s : clock_instants(context)) {
    if (can_be_sent(config.protocol, stamp_ns(t_s))) continue;
    return Error{fmt::format("imu: clock: found a stamp of {} ns at {} s, wanted {}", stamp_ns(t_s), t_s,
                             times_that_can_be_sent(config.protocol))};
  }
  return check_stamps(context, "imu", config.clock, stamp_ns, [](double) { return false; });
}

}  // namespace

Status check_imu(const Context& context, const ImuConfig& config) {
  const double bits_per_s = kBitsPerByte * static_cast<double>(bytes_per_sample(config.protocol)) * config.update_rate;
  if (bits_per_s > config.line.baud_rate) {
    return Error{fmt::format("imu: found a baud_rate of {}, wanted at least {:.0f} ({} Hz of {})",
                             config.line.baud_rate, std::ceil(bits_per_s), config.update_rate,
                             name_of(config.protocol))};
  }
  return check_imu_clock(context, config);
}

Result<ImuWritten> write_imu(const Context& context, const ImuConfig& config, const std::filesystem::path& folder,
                             const ImuFiles& files) {
  if (Status sound = check_imu(context, config); !sound) return sound.error();
  std::optional<SerialLogWriter> log;
  if (files.serial) {
    Result<SerialLogWriter> created = SerialLogWriter::create(folder / kImuSerialFile);
    if (!created) return created.error();
    log.emplace(std::move(*created));
  }
  Result<OptionalCsv> truth =
      OptionalCsv::create(true, folder / kImuTruthFile, "t,gyro_bx,gyro_by,gyro_bz,accel_bx,accel_by,accel_bz\n");
  if (!truth) return truth.error();
  Result<OptionalCsv> generic = OptionalCsv::create(files.generic, folder / kImuCsvFile, "t,gx,gy,gz,ax,ay,az\n");
  if (!generic) return generic.error();

  Recorder recorder(context, config, log, *truth, *generic);
  Status done = recorder.run();
  if (done && log) done = log->close();
  if (done) done = truth->commit();
  if (done) done = generic->commit();
  if (!done) return done.error();
  return recorder.written();
}

}  // namespace lxd::sim

// SPDX-License-Identifier: Apache-2.0
// See wheel_writer.hpp.
#include "tools/simulator/wheel/wheel_writer.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "backend/part_file.hpp"
#include "drivers/replay/can_log.hpp"
#include "tools/simulator/sync/sensor_instants.hpp"
#include "tools/simulator/wheel/can_encoder.hpp"

namespace lxd::sim {
namespace {

constexpr double kAlways = std::numeric_limits<double>::infinity();
constexpr std::array kFaults{
    KnownFault{"wheel_slip", 2, 0.3, "part", "wheels turn faster than the ground goes by"},
    KnownFault{"can_bus_off", 2, 0, "", "no frame comes; the controller reports bus-off"},
    KnownFault{"can_checksum", kAlways, 1, "part", "frames with a wrong checksum (toyota 0x0B4 and 0x024)"},
};
constexpr double kMilli = 1e-3;

// What is sent when.
struct Event {
  double t_s;
  std::uint32_t id;  // kOther: anything
  bool operator<(const Event& o) const { return t_s < o.t_s; }
};
constexpr std::uint32_t kOther = ~0U;

class WheelWriter {
 public:
  WheelWriter(const Context& context, const WheelConfig& config, PartFile& log, PartFile* csv)
      : context_(context), config_(config), motion_(context, config), out_(log), csv_(csv) {
    log_.slip_s = motion_.slip_s();
    left_mm_ = right_mm_ = config.odometer_start_mm;
  }

  void write() {
    if (csv_ != nullptr) csv_->write_text("t,v_mps,yaw_rate_radps\n");
    for (const Event& event : events()) send(event);
    report_bus(context_.duration_s);
  }
  [[nodiscard]] const WheelLog& log() const { return log_; }

 private:
  // The vehicle sends by its own clock.
  [[nodiscard]] std::vector<Event> events() const {
    const SensorClock clock(config_.clock, context_.start);
    const auto period_ns = static_cast<std::int64_t>(1e9 / config_.rate_hz);
    const std::vector<ScheduledMessage> messages = schedule(config_.protocol);
    std::vector<Event> events;
    for (std::int64_t k = first_multiple(clock, context_.start, period_ns);; k += period_ns) {
      const double t_s = (rig_time_of(clock, k) - context_.start).seconds();
      if (t_s >= context_.duration_s) break;
      for (const ScheduledMessage& message : messages) {
        const double sent_s = t_s + message.phase / config_.rate_hz;
        if (sent_s < context_.duration_s) events.push_back({sent_s, message.id});
      }
    }
    add_others(events);
    std::stable_sort(events.begin(), events.end());
    return events;
  }

  void add_others(std::vector<Event>& events) const {
    Random random(context_.seed, "can_others");
    const auto count = static_cast<std::size_t>(config_.other_frames_hz * context_.duration_s);
    for (std::size_t i = 0; i < count; ++i) {
      const double t_s = (static_cast<double>(i) + random.uniform()) / config_.other_frames_hz;
      if (t_s < context_.duration_s) events.push_back({t_s, kOther});
    }
  }

  void send(const Event& event) {
    CanFrame frame = event.id == kOther ? other_frame() : vehicle_frame(event);
    report_bus(event.t_s);
    if (bus_off_) {
      ++log_.withheld;
      return;
    }
    if (event.id == kOther) {
      ++log_.other_frames;
    } else if (const CanMessage* const message = find_message(table(), event.id)) {
      ++log_.wheel_frames;
      spoil_checksum(event.t_s, *message, frame);
    } else {
      ++log_.other_frames;
    }
    ++log_.frames;
    put(frame, event.t_s);
    if (csv_ != nullptr && (event.id == 0x221 || event.id == 0x0AA)) put_csv();
  }

  // Errors and noise are the same whether the bus carries the frame or not.
  CanFrame vehicle_frame(const Event& event) {
    VehicleState state;
    state.speeds = noisy(motion_.at(event.t_s));
    state.counter = counter_++;
    if (event.id == 0x311) roll_to(event.t_s);
    state.left_mm = left_mm_;
    state.right_mm = right_mm_;
    last_speeds_ = state.speeds;
    return encode(config_, event.id, state);
  }

  WheelSpeeds noisy(WheelSpeeds speeds) {
    for (double* const speed : {&speeds.left_mps, &speeds.right_mps, &speeds.front_left_mps, &speeds.front_right_mps})
      *speed += random_.normal(config_.speed_sigma_mps);
    return speeds;
  }

  void roll_to(double t_s) {
    const double since_s = t_s - rolled_to_s_;
    const WheelMotion::Ways ways = motion_.ways(rolled_to_s_, t_s);
    left_mm_ += (ways.left_m + random_.normal(config_.speed_sigma_mps) * since_s) / kMilli;
    right_mm_ += (ways.right_m + random_.normal(config_.speed_sigma_mps) * since_s) / kMilli;
    rolled_to_s_ = t_s;
  }

  // Any frame that no table has.
  CanFrame other_frame() {
    constexpr std::uint32_t kFirst = 0x380;  // the tables end below
    CanFrame frame;
    frame.id = kFirst + static_cast<std::uint32_t>(others_.bits() % (kCanStandardIdMax - kFirst));
    frame.length = static_cast<std::uint8_t>(others_.bits() % (kCanMaxData + 1));
    for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = static_cast<std::uint8_t>(others_.bits());
    return frame;
  }

  void spoil_checksum(double t_s, const CanMessage& message, CanFrame& frame) {
    const Fault* const fault = context_.faults.active("can_checksum", t_s);
    if (fault == nullptr || message.checksum == CanChecksum::none || !spoil_.chance(fault->value)) return;
    const std::uint8_t wrong = static_cast<std::uint8_t>(1 + spoil_.bits() % 255);
    frame.data[message.length - 1U] = static_cast<std::uint8_t>(frame.data[message.length - 1U] ^ wrong);
    ++log_.bad_checksums;
  }

  // Error frames as the kernel makes them when the controller goes off the bus and when it is back.
  void report_bus(double t_s) {
    const bool off = context_.faults.active("can_bus_off", t_s) != nullptr;
    if (off == bus_off_) return;
    bus_off_ = off;
    CanFrame frame;
    frame.kind = CanKind::error;
    frame.id = off ? kCanErrorBusOff : kCanErrorRestarted;
    frame.length = kCanMaxData;
    ++log_.error_frames;
    put(frame, t_s);
  }

  void put(CanFrame& frame, double t_s) {
    // A wire keeps its order.
    received_ = std::max(received_, clock().received(context_.rig_time(t_s), latency_));
    CanLogRecord record;
    record.frame = frame;
    record.frame.received = received_;
    record.set_interface(config_.interface);
    out_.write_text(can_log_line(record));
  }

  void put_csv() {
    csv_->write_text(fmt::format("{}.{:09},{:.6f},{:.6f}\n", received_.ns() / kNanosPerSecond,
                                 received_.ns() % kNanosPerSecond, last_speeds_.speed_mps(),
                                 last_speeds_.wheel_yaw_rate_radps(config_.track_m)));
  }

  [[nodiscard]] SensorClock clock() const { return {config_.clock, context_.start}; }
  [[nodiscard]] std::span<const CanMessage> table() const {
    return config_.protocol == WheelProtocol::agilex ? agilex_messages() : toyota_messages();
  }

  const Context& context_;
  const WheelConfig& config_;
  WheelMotion motion_;
  PartFile& out_;
  PartFile* csv_;
  Random random_{context_.seed, "wheel"}, latency_{context_.seed, "wheel_latency"};
  Random others_{context_.seed, "can_other_data"}, spoil_{context_.seed, "can_checksum"};
  double left_mm_ = 0, right_mm_ = 0, rolled_to_s_ = 0;
  std::uint32_t counter_ = 0;
  WheelSpeeds last_speeds_;
  bool bus_off_ = false;
  RigTime received_;
  WheelLog log_;
};

}  // namespace

std::span<const KnownFault> wheel_faults() { return kFaults; }

Status check_wheel(const WheelConfig& config, const FaultPlan& faults) {
  const auto is_checksum = [](const Fault& fault) { return fault.name == "can_checksum"; };
  if (config.protocol == WheelProtocol::agilex && std::any_of(faults.all().begin(), faults.all().end(), is_checksum))
    return Error{"fault can_checksum: the wheels' protocol is agilex, whose frames have no checksum, wanted toyota"};
  return success();
}

Result<WheelLog> write_wheel(const Context& context, const WheelConfig& config, const std::filesystem::path& folder) {
  if (const Status sound = check_wheel(config, context.faults); !sound.ok()) return sound.error();
  Result<PartFile> log = PartFile::create(folder / "can.log");
  if (!log.ok()) return log.error();
  std::optional<PartFile> csv;
  if (config.csv) {
    Result<PartFile> file = PartFile::create(folder / "wheel.csv");
    if (!file.ok()) return file.error();
    csv.emplace(std::move(*file));
  }
  WheelWriter writer(context, config, *log, csv ? &*csv : nullptr);
  writer.write();
  if (const Status written = log->commit(); !written.ok()) return written.error();
  if (csv) {
    if (const Status written = csv->commit(); !written.ok()) return written.error();
  }
  return writer.log();
}

}  // namespace lxd::sim

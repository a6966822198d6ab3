// SPDX-License-Identifier: Apache-2.0
#include "board/live_intake.hpp"

#include <bit>

#include "board/default/capacities.hpp"
#include "board/signal_files.hpp"
#include "board/wheel_table.hpp"
#include "drivers/device/can_wire.hpp"
#include "drivers/lidar/livox_sweeps.hpp"
#include "drivers/lidar/ouster_sweeps.hpp"
#include "drivers/replay/rig_clock.hpp"

namespace lxd {
namespace {

// What comes while a sweep is registered, many times over.
constexpr std::size_t kImuSlots = 4096;
constexpr std::size_t kWheelSlots = 1024;
constexpr std::size_t kFixSlots = 256;
// The extra LiDAR's sweeps that wait until the primary one's next is taken. Of an Ouster's turns one is being filled,
// one being handed over, two are between. Of a Livox' slices five come during a turn of the primary, and while that is
// silent nobody takes any for two turns more; so there are as many as there is room for, which is more than a second.
struct ExtraRoom {
  SweepIndex sweeps;
  std::size_t points;  // each
};
constexpr ExtraRoom kTurns{4, capacities::kSweepPointsMax};
constexpr ExtraRoom kSlices{64, capacities::kSweepPointsMax / 16};  // twice what a Mid-360 fills with two echoes
static_assert(kTurns.sweeps * kTurns.points == kSlices.sweeps * kSlices.points);
constexpr std::size_t kExtraBlockBytes =
    kTurns.sweeps * kTurns.points * sizeof(LidarPoint) + kSlices.sweeps * std::size_t{4096};

const Duration kSweep = Duration::from_seconds(1 / kLivoxSweepRate_hz);
// The extra LiDAR's returns join the sweep during which they come: in slices they are there in time.
constexpr Duration kExtraSlice = Duration::from_ns(20'000'000);

std::unique_ptr<PacketSweeps> packets_of(const LiveLidar& lidar) {
  auto clock = std::make_unique<RigClock>(ClockModelConfig{});
  if (lidar.metadata) return std::make_unique<OusterSweeps>(*lidar.metadata, std::move(clock));
  const Duration period = lidar.channel == LiveChannel::lidar1 ? kExtraSlice : kSweep;
  return std::make_unique<LivoxSweeps>(LivoxParser{LivoxPacketParser(kMid360Lines)}, std::move(clock), period);
}

SweepLine line_of(const LiveLidar& lidar, SweepPool& pool) {
  return {packets_of(lidar), static_cast<std::uint16_t>(lidar.wire.port), pool};
}

}  // namespace

SweepLine::SweepLine(std::unique_ptr<PacketSweeps> packets, std::uint16_t port, SweepPool& pool)
    : packets_(std::move(packets)),
      port_(port),
      pool_(pool),
      in_hand_(pool.acquire()),
      slots_(std::bit_ceil(pool.capacity())),
      ring_(slots_) {}

bool SweepLine::take(const Chunk& chunk) {
  if (chunk.origin.destination_port != port_ || !packets_->parse(chunk.bytes)) return false;
  if (!in_hand_) in_hand_ = pool_.acquire();
  if (!in_hand_) {
    ++no_room_;
    return false;
  }
  Sweep& sweep = pool_[*in_hand_];
  if (!packets_->take(chunk.received, sweep)) {
    sweep.count = 0;
    return false;
  }
  (void)ring_.push(*in_hand_);  // has as many slots as there are sweeps
  in_hand_ = pool_.acquire();
  return true;
}

Rejections SweepLine::rejected() const {
  Rejections rejected;
  packets_->report(rejected);
  count_rejected(rejected, "no_room", no_room_);
  return rejected;
}

// Samples out of a ring, as a replay's sources give them. None of them ends: false says that nothing waits.
class LiveIntake::Imu final : public ImuSource {
 public:
  explicit Imu(SpscRing<ImuSample>& ring) : ring_(ring) {}
  bool next(ImuSample& sample) override {
    const auto oldest = ring_.pop();
    if (oldest) sample = *oldest;
    return oldest.has_value();
  }
  [[nodiscard]] Rejections rejected() const override { return {}; }

 private:
  SpscRing<ImuSample>& ring_;
};

class LiveIntake::Wheels final : public WheelLogSource {
 public:
  explicit Wheels(SpscRing<WheelSample>& ring) : ring_(ring) {}
  bool next(WheelSample& sample) override {
    const auto oldest = ring_.pop();
    if (oldest) sample = *oldest;
    return oldest.has_value();
  }
  [[nodiscard]] Rejections rejected() const override { return {}; }

 private:
  SpscRing<WheelSample>& ring_;
};

class LiveIntake::Extra final : public SweepSource {
 public:
  explicit Extra(SweepLine& line) : line_(line) {}
  Result<bool> next(Sweep& sweep) override {
    const auto index = line_.pop();
    if (!index) return false;
    const Sweep& waiting = line_.pool()[*index];
    sweep.begin = waiting.begin;
    sweep.end = waiting.end;
    sweep.stamp = waiting.stamp;
    for (const LidarPoint& point : waiting.points()) (void)sweep.push(point);  // of the same capacity
    line_.pool().release(*index);
    return true;
  }
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return std::nullopt; }
  [[nodiscard]] std::string kind() const override { return "lidar1"; }
  [[nodiscard]] LidarTraits traits() const override { return {}; }
  [[nodiscard]] const Rejections& rejected() const override { return none_; }

 private:
  SweepLine& line_;
  Rejections none_;
};

class LiveIntake::Features final : public SensorStreams::FeatureSource {
 public:
  explicit Features(LiveVision& vision) : vision_(vision) {}
  std::optional<FeatureFrame> next() override { return vision_.pop(); }

 private:
  LiveVision& vision_;
};

LiveIntake::LiveIntake(const LiveRig& live, SweepPool& sweeps, SensorWatch& watch, const LiveListeners& listeners)
    : watch_(watch),
      listeners_(listeners),
      primary_(line_of(live.lidars.front(), sweeps)),
      imu_slots_(kImuSlots),
      imu_ring_(imu_slots_),
      wheel_slots_(kWheelSlots),
      wheel_ring_(wheel_slots_),
      fix_slots_(kFixSlots),
      fix_ring_(fix_slots_),
      uses_gnss_(live.sensors.gnss),
      pulsed_(pulsed_sensors(live.rig)),
      pulses_(live.rig.pps ? begins_at(*live.rig.pps) : GpioEdge::rising),
      triggering_(live.rig.triggers ? triggers_at(*live.rig.triggers) : GpioEdge::rising) {
  if (live.sensors.extra_lidar) {
    extra_block_.resize(kExtraBlockBytes);
    extra_arena_.emplace(extra_block_);
    const ExtraRoom& room = live.lidars[1].metadata ? kTurns : kSlices;
    extra_pool_.emplace(*extra_arena_, "extra sweeps", room.sweeps, room.points);
    extra_.emplace(packets_of(live.lidars[1]), static_cast<std::uint16_t>(live.lidars[1].wire.port), *extra_pool_);
  }
  if (live.uses_lidar_imu()) {
    lidar_imu_port_ = static_cast<std::uint16_t>(live.lidars.front().wire.imu_port);
  } else if (live.sensors.imu) {
    const auto protocol = find_imu_protocol(live.rig.imu->protocol).value_or(ImuProtocol::kVectorNav);
    imu_.emplace(protocol, live.rig.imu->baud_rate);
  }
  if (!live.sensors.wheel) return;
  messages_ = wheel_messages(*live.rig.wheel);
  wheel_.emplace(wheel_decoder_config(*live.rig.wheel, messages_));
}

SensorStreams LiveIntake::streams() {
  SensorStreams::LiveSources sources;
  if (imu_ || lidar_imu_port_ != 0) sources.imu = std::make_unique<Imu>(imu_ring_);
  if (wheel_) sources.wheel = std::make_unique<Wheels>(wheel_ring_);
  if (listeners_.vision != nullptr) sources.features = std::make_unique<Features>(*listeners_.vision);
  if (extra_) sources.extra = std::make_unique<Extra>(*extra_);
  return SensorStreams::of_live(std::move(sources));
}

void LiveIntake::take(const Chunk& chunk) {
  const LiveChannel channel = channel_at(chunk.channel);
  watch_.heard(channel, chunk.received);
  switch (channel) {
    case LiveChannel::lidar0:
      if (lidar_imu_port_ == chunk.origin.destination_port) take_lidar_imu(chunk);
      if (primary_.take(chunk)) ready_.release();
      return;
    case LiveChannel::lidar1:
      if (extra_) (void)extra_->take(chunk);
      return;
    case LiveChannel::imu:
      return take_imu(chunk);
    case LiveChannel::wheel:
      return take_wheel(chunk);
    case LiveChannel::pps:
      return take_pulse(chunk);
    case LiveChannel::triggers:
      return take_trigger(chunk);
    default:
      return nmea_.feed(chunk.bytes, chunk.received, [&](const GnssFix& fix) { fix_no_room_ += !fix_ring_.push(fix); });
  }
}

void LiveIntake::take_imu(const Chunk& chunk) {
  for (auto bytes = chunk.bytes; imu_ && !bytes.empty();) {
    bytes = bytes.subspan(imu_->feed(bytes, chunk.received));
    for (ImuSample sample; imu_->next(sample);)
      if (imu_clock_.place(sample)) post(sample);
  }
}

void LiveIntake::take_lidar_imu(const Chunk& chunk) {
  for (const ImuSample& sample : primary_.inertial(chunk)) post(sample);
}

void LiveIntake::take_wheel(const Chunk& chunk) {
  const auto frame = can_frame_of(chunk.bytes, chunk.received);
  if (!wheel_ || !frame) return;
  const auto sample = wheel_->decode(*frame);
  if (sample && !wheel_ring_.push(*sample)) ++wheel_no_room_;
}

void LiveIntake::take_pulse(const Chunk& chunk) {
  const auto pulse = pulses_.read(chunk);
  if (!pulse) return;
  if (pulsed_.lidar0) primary_.add_pulse(pulse->edge);
  if (pulsed_.lidar1 && extra_) extra_->add_pulse(pulse->edge);
  if (pulsed_.imu) imu_clock_.add_pulse(pulse->edge);
}

void LiveIntake::take_trigger(const Chunk& chunk) {
  if (listeners_.vision != nullptr && is_edge(chunk, triggering_)) listeners_.vision->add_trigger(chunk.received);
}

std::optional<GnssFix> LiveIntake::pop_fix(RigTime until) {
  const GnssFix* const oldest = fix_ring_.front();
  if (oldest == nullptr || oldest->received > until) return std::nullopt;
  return fix_ring_.pop();
}

std::map<std::string, Rejections> LiveIntake::rejected() const {
  std::map<std::string, Rejections> all;
  all["lidar0"] = primary_.rejected();
  if (extra_) all["lidar1"] = extra_->rejected();
  if (listeners_.vision != nullptr) all["camera0"] = listeners_.vision->rejected();
  if (lidar_imu_port_ != 0) {
    primary_.report_inertial(all["imu"]);
    count_rejected(all["imu"], "no_room", imu_no_room_);
  }
  if (imu_) {
    Rejections& imu = all["imu"] = imu_->rejected();
    count_rejected(imu, "clock_step", imu_clock_.counts().steps);
    count_rejected(imu, "clock_outlier", imu_clock_.counts().refused);
    count_rejected(imu, "no_room", imu_no_room_);
  }
  if (wheel_) count_rejected(all["wheel"] = rejections_of(wheel_->counts()), "no_room", wheel_no_room_);
  if (uses_gnss_) {
    Rejections& gnss = all["gnss"] = rejections_of(nmea_);
    count_rejected(gnss, "no_room", fix_no_room_);
  }
  return all;
}

}  // namespace lxd

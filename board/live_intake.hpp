// SPDX-License-Identifier: Apache-2.0
// From bytes to samples on the rig's clock, in the thread that reads the devices; and the rings through which the
// real-time thread takes them. The parsers are those of a replay. All rings are of fixed size; what has no room is
// counted.
#pragma once

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <semaphore>
#include <string>
#include <vector>

#include "board/live_rig.hpp"
#include "board/live_vision.hpp"
#include "board/pose_port.hpp"
#include "board/sensor_streams.hpp"
#include "board/sensor_watch.hpp"
#include "drivers/gnss/nmea_parser.hpp"
#include "drivers/imu/imu_stream.hpp"
#include "drivers/lidar/packet_sweeps.hpp"
#include "drivers/sync/pulse_wire.hpp"
#include "drivers/wheel/wheel_decoder.hpp"
#include "rt/arena.hpp"
#include "rt/spsc_ring.hpp"
#include "rt/sweep_pool.hpp"

namespace lxd {

// The sweeps of one LiDAR, through a pool that the real-time thread gives back to.
class SweepLine {
 public:
  // The pool must outlive the line, and be its alone.
  SweepLine(std::unique_ptr<PacketSweeps> packets, std::uint16_t port, SweepPool& pool);

  // Reading thread. True: a sweep was handed over.
  bool take(const Chunk& chunk);
  // Reading thread. The samples of the sensor's own IMU, if the chunk is of them; valid until the next call.
  std::span<const ImuSample> inertial(const Chunk& chunk) { return packets_->inertial(chunk.bytes, chunk.received); }
  // Real-time thread: the oldest that waits; to be given back.
  std::optional<SweepIndex> pop() { return ring_.pop(); }
  [[nodiscard]] SweepPool& pool() { return pool_; }

  // Reading thread, or after it.
  [[nodiscard]] Rejections rejected() const;
  void add_pulse(RigTime edge) { packets_->add_pulse(edge); }
  void report_inertial(Rejections& rejected) const { packets_->report_inertial(rejected); }

 private:
  std::unique_ptr<PacketSweeps> packets_;
  std::uint16_t port_;  // others are of the sensor's own IMU
  SweepPool& pool_;
  std::optional<SweepIndex> in_hand_;  // lent, and filled by the next sweep
  std::vector<SweepIndex> slots_;      // of the ring: one for each of the pool's
  SpscRing<SweepIndex> ring_;
  std::uint64_t no_room_ = 0;  // packets, while every sweep of the pool waited for the real-time thread
};

// Who hears the IMU besides the filter, in the reading thread.
struct LiveListeners {
  LiveVision* vision = nullptr;  // none without a camera
  PosePort* poses = nullptr;     // none where nobody steers
};

class LiveIntake final : public ChunkSink {
 public:
  // `sweeps` is the primary LiDAR's pool. All arguments and listeners outlive the intake.
  LiveIntake(const LiveRig& live, SweepPool& sweeps, SensorWatch& watch, const LiveListeners& listeners = {});

  // Reading thread.
  void take(const Chunk& chunk) override;

  // Real-time thread. Waits for a sweep of the primary LiDAR, at most `longest`.
  [[nodiscard]] bool wait_for_sweep(std::chrono::milliseconds longest) { return ready_.try_acquire_for(longest); }
  [[nodiscard]] std::optional<SweepIndex> pop_sweep() { return primary_.pop(); }
  // The other sensors, as a replay has them; their samples come out of the rings. Once; the intake must outlive them.
  [[nodiscard]] SensorStreams streams();

  // Writing thread: the oldest fix of GNSS that was received up to `until`.
  [[nodiscard]] std::optional<GnssFix> pop_fix(RigTime until);

  // After the reading thread: by sensor and cause.
  [[nodiscard]] std::map<std::string, Rejections> rejected() const;

 private:
  class Imu;
  class Wheels;
  class Extra;
  class Features;

  void take_imu(const Chunk& chunk);
  void take_lidar_imu(const Chunk& chunk);
  void take_pulse(const Chunk& chunk);
  void take_trigger(const Chunk& chunk);
  void post(const ImuSample& sample) {
    imu_no_room_ += !imu_ring_.push(sample);
    if (listeners_.vision != nullptr) listeners_.vision->add(sample);
    if (listeners_.poses != nullptr) listeners_.poses->add(sample);
  }
  void take_wheel(const Chunk& chunk);

  SensorWatch& watch_;
  LiveListeners listeners_;
  SweepLine primary_;
  std::counting_semaphore<> ready_{0};
  std::vector<std::byte> extra_block_;  // of the extra LiDAR's pool
  std::optional<Arena> extra_arena_;
  std::optional<SweepPool> extra_pool_;
  std::optional<SweepLine> extra_;

  std::uint16_t lidar_imu_port_ = 0;  // 0: the IMU inside the primary LiDAR is not in use
  std::optional<ImuStream> imu_;
  ImuClock imu_clock_;
  std::vector<ImuSample> imu_slots_;
  SpscRing<ImuSample> imu_ring_;
  std::vector<CanMessage> messages_;
  std::optional<WheelDecoder> wheel_;
  std::vector<WheelSample> wheel_slots_;
  SpscRing<WheelSample> wheel_ring_;
  NmeaParser nmea_;
  std::vector<GnssFix> fix_slots_;
  SpscRing<GnssFix> fix_ring_;
  bool uses_gnss_;
  PulsedSensors pulsed_;
  PulseReader pulses_;
  GpioEdge triggering_;
  std::uint64_t imu_no_room_ = 0, wheel_no_room_ = 0, fix_no_room_ = 0;
};

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// A sensor's clock on the rig's: learned from pairs of sensor stamp and receive stamp by their lower envelope, or, once
// they are there, from the edges of a pulse per second. Fixed memory; fit for the real-time thread that owns it.
//
// The mapping never jumps but at a step, which add() tells and counts() counts: while the estimate improves, the given
// time runs a little faster or slower until it has caught up.
#pragma once

#include <cstdint>

#include "drivers/sync/lower_envelope.hpp"
#include "drivers/sync/step_detector.hpp"
#include "rt/time.hpp"

namespace lxd {

struct ClockModelConfig {
  // From a sample to its receive stamp at the least. It cannot be seen in the stamps, so it must be known.
  Duration assumed_latency;
  // A pair that is further off does not belong to the clock so far, unless it is late and its stamp follows the one
  // before within as much: then the host was held up, not the clock.
  Duration step = Duration::from_ns(50'000'000);
  double skew_max = 500e-6;                                        // of any clock that works
  Duration bin = Duration::from_ns(1'000'000'000);                 // of the envelope, which looks back over 64 bins
  Duration pulse_gate = Duration::from_ns(500'000);                // an edge that is further off is a glitch
  Duration pulse_holdover = Duration::from_ns(1'800'000'000'000);  // without edges for longer: back to the pairs
  Duration silence = Duration::from_ns(2'000'000'000);             // without pairs for longer: not healthy
  Duration bound_max = Duration::from_ns(1'000'000);               // an error that may be larger: not healthy
};

enum class ClockVerdict : std::uint8_t {
  accepted,
  refused,  // does not fit the clock so far: the stamp must not be used
  stepped   // the clock has stepped: from this pair on to_rig() follows the new time
};

struct ClockCounts {
  std::uint64_t pairs = 0, refused = 0, steps = 0;
  std::uint64_t edges = 0, glitches = 0, relocks = 0;  // pulses
};

class ClockModel {
 public:
  explicit ClockModel(const ClockModelConfig& config);

  // A sensor stamp (ns of the sensor's own epoch) and when its bytes were received.
  ClockVerdict add(std::int64_t sensor_ns, RigTime received) noexcept LXD_NONBLOCKING;
  // The host's stamp of an edge; edges are at whole seconds of the sensor's clock. Which second it is, the pairs tell,
  // so an edge before the first pair is refused.
  ClockVerdict add_edge(RigTime edge) noexcept LXD_NONBLOCKING;

  // Rig time of a sensor stamp; before the first pair the sensor's own number. Grows with its argument; so do results
  // in the order of time, when each stamp is asked for after its pair was added.
  [[nodiscard]] RigTime to_rig(std::int64_t sensor_ns) const noexcept LXD_NONBLOCKING;

  [[nodiscard]] bool healthy(RigTime now) const noexcept LXD_NONBLOCKING;
  // How far to_rig() may be off at `now`, the error of assumed_latency aside.
  [[nodiscard]] Duration bound(RigTime now) const noexcept LXD_NONBLOCKING;
  // Rig minus sensor clock at the newest stamp, as to_rig() has it.
  [[nodiscard]] Duration offset() const noexcept LXD_NONBLOCKING;
  // How much faster the sensor's clock runs than the rig's, as a part.
  [[nodiscard]] double skew() const noexcept LXD_NONBLOCKING;
  [[nodiscard]] bool pulse_locked() const noexcept LXD_NONBLOCKING { return pulse_locked_; }
  [[nodiscard]] const ClockCounts& counts() const noexcept LXD_NONBLOCKING { return counts_; }

 private:
  // Sensor time as seconds since the first stamp (or the last step's); delay likewise less that pair's.
  [[nodiscard]] double x_of(std::int64_t sensor_ns) const noexcept LXD_NONBLOCKING;
  [[nodiscard]] double delay_of(std::int64_t sensor_ns, RigTime received) const noexcept LXD_NONBLOCKING;
  [[nodiscard]] DelayLine target() const noexcept LXD_NONBLOCKING;
  [[nodiscard]] double applied(double x_s) const noexcept LXD_NONBLOCKING;
  [[nodiscard]] std::int64_t whole_second_at(RigTime edge) const noexcept LXD_NONBLOCKING;
  [[nodiscard]] double edge_gate(double x_s) const noexcept LXD_NONBLOCKING;
  void begin(std::int64_t sensor_ns, RigTime received) noexcept LXD_NONBLOCKING;
  void follow(double x_s) noexcept LXD_NONBLOCKING;
  void jump(double x_s) noexcept LXD_NONBLOCKING;
  void unlock() noexcept LXD_NONBLOCKING;
  ClockVerdict outlier(std::int64_t sensor_ns, RigTime received, double misfit_s) noexcept LXD_NONBLOCKING;
  [[nodiscard]] bool runs_on(std::int64_t sensor_ns) const noexcept LXD_NONBLOCKING;
  ClockVerdict odd_edge(double x_s, double delay_s, double misfit_s) noexcept LXD_NONBLOCKING;

  ClockModelConfig config_;
  LowerEnvelope pairs_, edges_;
  StepDetector pair_steps_, edge_steps_;
  bool begun_ = false, pulse_locked_ = false;
  std::int64_t sensor_zero_ns_ = 0, delay_zero_ns_ = 0;
  RigTime last_received_;
  std::int64_t last_sensor_ns_ = 0;
  bool unbroken_ = false;    // the last pair was accepted
  double mean_delay_s_ = 0;  // of the pairs, above their envelope
  // The line that to_rig() follows, and what it was away from it at x = anchor: the rest decays over catch_up_s.
  DelayLine line_;
  double anchor_s_ = 0, behind_s_ = 0, catch_up_s_ = 1;
  ClockCounts counts_;
};

}  // namespace lxd

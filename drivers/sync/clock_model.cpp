// SPDX-License-Identifier: Apache-2.0
// See clock_model.hpp.
#include "drivers/sync/clock_model.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

// Half of what int64 holds, so that differences cannot overflow; no clock is there.
constexpr std::int64_t kFarthest_ns = std::int64_t{1} << 61U;
constexpr int kStepPairs = 5, kLockEdges = 3;
// Five exponential delays lie within eight means of each other but for 2 in 1000; delays are averaged over 256.
constexpr double kSpreadMeans = 8, kSpreadMin_s = 1e-3, kMeanWeightMin = 1.0 / 256;
constexpr double kEdgeSpread_s = 200e-6;
constexpr double kCatchUp_s = 1;        // of a small difference; of a large one what slew_max allows
constexpr double kSlewMax = 5e-3;       // how much faster or slower the given time may run meanwhile
constexpr double kHoldoverSkew = 2e-7;  // how well a skew is known after a minute of pulses, and how well it keeps
constexpr double kEdgeJitter_s = 20e-6;
constexpr std::size_t kHealthyBins = 5;

bool sound(std::int64_t ns) { return ns > -kFarthest_ns && ns < kFarthest_ns; }

std::int64_t to_ns(double s) { return std::llround(s * static_cast<double>(kNanosPerSecond)); }

}  // namespace

ClockModel::ClockModel(const ClockModelConfig& config)
    : config_(config),
      pairs_(config.bin.seconds(), config.skew_max),
      edges_(config.bin.seconds() / 2, config.skew_max),  // so that every edge has a bin
      pair_steps_(kStepPairs),
      edge_steps_(kLockEdges) {}

ClockVerdict ClockModel::add(std::int64_t sensor_ns, RigTime received) noexcept LXD_NONBLOCKING {
  if (!sound(sensor_ns) || !sound(received.ns()) || received < RigTime()) {
    ++counts_.refused;
    return ClockVerdict::refused;
  }
  if (!begun_) begin(sensor_ns, received);
  const double x_s = x_of(sensor_ns), delay_s = delay_of(sensor_ns, received);
  const double misfit_s = pairs_.empty() ? 0 : delay_s - pairs_.line().at(x_s);
  if (std::abs(misfit_s) > config_.step.seconds()) return outlier(sensor_ns, received, misfit_s);
  ++counts_.pairs;
  unbroken_ = true;
  last_sensor_ns_ = sensor_ns;
  pair_steps_.reset();
  mean_delay_s_ +=
      std::max(kMeanWeightMin, 1.0 / static_cast<double>(counts_.pairs)) * (std::max(0.0, misfit_s) - mean_delay_s_);
  last_received_ = received;
  const bool first = pairs_.empty();
  const bool changed = pairs_.add(x_s, delay_s);
  if (pulse_locked_ && x_s - edges_.newest_s() > config_.pulse_holdover.seconds()) unlock();
  if (first) {
    jump(x_s);
  } else if (changed && !pulse_locked_) {
    follow(x_s);
  }
  return ClockVerdict::accepted;
}

// Numbers are kept relative to the first pair of a clock: small, so that a double holds them to the nanosecond.
void ClockModel::begin(std::int64_t sensor_ns, RigTime received) noexcept LXD_NONBLOCKING {
  begun_ = true;
  sensor_zero_ns_ = sensor_ns;
  delay_zero_ns_ = received.ns() - sensor_ns;
}

ClockVerdict ClockModel::outlier(std::int64_t sensor_ns, RigTime received, double misfit_s) noexcept LXD_NONBLOCKING {
  const double spread_s = std::max(kSpreadMin_s, kSpreadMeans * mean_delay_s_);
  const double delay_s = delay_of(sensor_ns, received);
  const bool held_up = misfit_s > 0 && runs_on(sensor_ns);
  const bool stepped = pair_steps_.add(x_of(sensor_ns), delay_s, misfit_s, spread_s);
  unbroken_ = stepped || held_up;
  if (!unbroken_) {
    ++counts_.refused;
    return ClockVerdict::refused;
  }
  ++counts_.pairs;
  last_received_ = received;
  last_sensor_ns_ = sensor_ns;
  if (!stepped) return ClockVerdict::accepted;
  ++counts_.steps;
  unlock();
  pairs_.restart();
  begin(sensor_ns, received);
  pairs_.add(0, pair_steps_.low_s() - delay_s);  // of the row that made the step the one that was held up least
  jump(0);
  return ClockVerdict::stepped;
}

// After a refused pair nothing runs on: a clock that has stepped back by little passes where it was before long.
bool ClockModel::runs_on(std::int64_t sensor_ns) const noexcept LXD_NONBLOCKING {
  return unbroken_ && sensor_ns > last_sensor_ns_ && sensor_ns - last_sensor_ns_ <= config_.step.ns();
}

ClockVerdict ClockModel::add_edge(RigTime edge) noexcept LXD_NONBLOCKING {
  if (pairs_.empty() || !sound(edge.ns())) {
    ++counts_.glitches;
    return ClockVerdict::refused;
  }
  const std::int64_t second_ns = whole_second_at(edge);
  const double x_s = x_of(second_ns), delay_s = delay_of(second_ns, edge);
  const double misfit_s = edges_.empty() ? 0 : delay_s - edges_.line().at(x_s);
  if (!pulse_locked_ || std::abs(misfit_s) > edge_gate(x_s)) return odd_edge(x_s, delay_s, misfit_s);
  ++counts_.edges;
  edge_steps_.reset();
  if (edges_.add(x_s, delay_s)) follow(x_s);
  return ClockVerdict::accepted;
}

// Before the lock every edge is odd: three that agree make it. After it they are glitches until three agree elsewhere.
ClockVerdict ClockModel::odd_edge(double x_s, double delay_s, double misfit_s) noexcept LXD_NONBLOCKING {
  if (!edge_steps_.add(x_s, delay_s, misfit_s, kEdgeSpread_s, config_.skew_max)) {
    if (pulse_locked_) ++counts_.glitches;
    return ClockVerdict::refused;
  }
  ++counts_.edges;
  if (pulse_locked_) ++counts_.relocks;
  pulse_locked_ = true;
  edges_.restart();
  edges_.add(x_s, delay_s);
  follow(x_s);
  return ClockVerdict::accepted;
}

void ClockModel::unlock() noexcept LXD_NONBLOCKING {
  pulse_locked_ = false;
  edges_.restart();
  edge_steps_.reset();
}

double ClockModel::edge_gate(double x_s) const noexcept LXD_NONBLOCKING {
  constexpr double kWandering = 1e-6;  // of a skew that is known, in what is not seen
  const double unknown = edges_.bins() < 2 ? config_.skew_max : kWandering;
  return config_.pulse_gate.seconds() + unknown * std::max(0.0, x_s - edges_.newest_s());
}

// The whole second of the sensor's clock that is nearest to the edge, by the pairs' clock.
std::int64_t ClockModel::whole_second_at(RigTime edge) const noexcept LXD_NONBLOCKING {
  const DelayLine& line = pairs_.line();
  const std::int64_t guess_ns = edge.ns() - delay_zero_ns_ + config_.assumed_latency.ns();
  const std::int64_t sensor_ns = guess_ns - to_ns(line.at(x_of(guess_ns)));
  const std::int64_t half = sensor_ns >= 0 ? kNanosPerSecond / 2 : -kNanosPerSecond / 2;
  return (sensor_ns + half) / kNanosPerSecond * kNanosPerSecond;
}

double ClockModel::x_of(std::int64_t sensor_ns) const noexcept LXD_NONBLOCKING {
  return Duration::from_ns(sensor_ns - sensor_zero_ns_).seconds();
}

double ClockModel::delay_of(std::int64_t sensor_ns, RigTime received) const noexcept LXD_NONBLOCKING {
  return Duration::from_ns(received.ns() - sensor_ns - delay_zero_ns_).seconds();
}

// The line that to_rig() should follow.
DelayLine ClockModel::target() const noexcept LXD_NONBLOCKING {
  if (pulse_locked_) return edges_.line();
  return {pairs_.line().at_zero_s - config_.assumed_latency.seconds(), pairs_.line().slope};
}

double ClockModel::applied(double x_s) const noexcept LXD_NONBLOCKING {
  const double caught_up = std::clamp((x_s - anchor_s_) / catch_up_s_, 0.0, 1.0);
  return line_.at(x_s) - behind_s_ * (1 - caught_up);
}

// Takes the newest line and keeps what is given at x as it was; the difference goes away while time goes on.
void ClockModel::follow(double x_s) noexcept LXD_NONBLOCKING {
  const double from_s = std::max(x_s, anchor_s_);
  const double given_s = applied(from_s);
  line_ = target();
  anchor_s_ = from_s;
  behind_s_ = line_.at(from_s) - given_s;
  catch_up_s_ = std::max(kCatchUp_s, std::abs(behind_s_) / kSlewMax);
}

void ClockModel::jump(double x_s) noexcept LXD_NONBLOCKING {
  line_ = target();
  anchor_s_ = x_s;
  behind_s_ = 0;
}

RigTime ClockModel::to_rig(std::int64_t sensor_ns) const noexcept LXD_NONBLOCKING {
  if (!begun_ || !sound(sensor_ns)) return RigTime::from_ns(sensor_ns);
  return RigTime::from_ns(sensor_ns + delay_zero_ns_ + to_ns(applied(x_of(sensor_ns))));
}

bool ClockModel::healthy(RigTime now) const noexcept LXD_NONBLOCKING {
  return begun_ && pairs_.bins() >= kHealthyBins && now - last_received_ <= config_.silence &&
         bound(now) <= config_.bound_max;
}

Duration ClockModel::bound(RigTime now) const noexcept LXD_NONBLOCKING {
  if (!begun_) return config_.step;
  const double now_s = x_of(now.ns() - delay_zero_ns_);
  const LowerEnvelope& used = pulse_locked_ ? edges_ : pairs_;
  const double unseen_s = std::max(0.0, now_s - used.newest_s());
  // Of an envelope that is e ragged over a span S the slope is uncertain by about e / S.
  const double slope_error = used.bins() < 2 ? config_.skew_max : used.raggedness_s() / used.span_s() + kHoldoverSkew;
  const double floor_s = pulse_locked_ ? kEdgeJitter_s : 0;
  const double behind_s = std::abs(line_.at(now_s) - applied(now_s));
  return Duration::from_seconds(floor_s + behind_s + used.raggedness_s() +
                                slope_error * (unseen_s + used.span_s() / 2));
}

Duration ClockModel::offset() const noexcept LXD_NONBLOCKING {
  if (!begun_) return {};
  return Duration::from_ns(delay_zero_ns_ + to_ns(applied(pairs_.newest_s())));
}

// Delay falls by the sensor's gain on the rig's clock.
double ClockModel::skew() const noexcept LXD_NONBLOCKING { return -line_.slope / (1 + line_.slope); }

}  // namespace lxd

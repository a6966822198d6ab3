// SPDX-License-Identifier: Apache-2.0
// See sync_writer.hpp.
#include "tools/simulator/sync/sync_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "backend/part_file.hpp"
#include "drivers/replay/pps_log.hpp"
#include "tools/simulator/sync/sensor_instants.hpp"

namespace lxd::sim {
namespace {

constexpr std::array kFaults{
    KnownFault{"pps_missing", 600, 0, "", "no pulse comes"},
    KnownFault{"pps_glitch", 10, 1, "a second", "edges that are no pulse"},
};
constexpr std::size_t kPulseOffset = 0;  // of the pulse's line; triggers follow
constexpr const char* kPulseLine = "pps";

struct Edge {
  RigTime stamped;
  std::size_t offset;
  bool rising;
  bool lost;  // in the kernel's queue
};

class SyncWriter {
 public:
  SyncWriter(const Context& context, const SyncConfig& config)
      : context_(context), config_(config), clock_(config.clock, context.start) {}

  void make() {
    make_pulses();
    for (std::size_t i = 0; i < config_.triggers.size(); ++i) make_triggers(i);
    const auto earlier = [](const auto& a, const auto& b) { return a.stamped < b.stamped; };
    std::stable_sort(edges_.begin(), edges_.end(), earlier);
    std::sort(pulses_.begin(), pulses_.end());
  }

  [[nodiscard]] std::string pps_text() const {
    std::string text = fmt::format("{}\n", kPpsLogHeader);
    std::uint32_t sequence = 0;  // the kernel counts what it sees
    for (const RigTime pulse : pulses_) text += fmt::format("{},{}\n", pulse.ns(), ++sequence);
    return text;
  }

  // seqno counts all lines' events from 1, line_seqno those of one; both count what was lost in the queue.
  [[nodiscard]] std::string gpio_text() {
    std::string text = fmt::format("{}\n", kGpioLogHeader);
    std::vector<std::uint32_t> of_line(config_.triggers.size() + 1, 0);
    std::uint32_t sequence = 0;
    for (const Edge& edge : edges_) {
      ++sequence;
      ++of_line[edge.offset];
      ++(edge.lost ? log_.gpio_lost : log_.gpio_events);
      if (edge.lost) continue;
      const char* const line =
          edge.offset == kPulseOffset ? kPulseLine : config_.triggers[edge.offset - 1].name.c_str();
      text += fmt::format("{},{},{},{},{},{}\n", edge.stamped.ns(), edge.offset, line,
                          edge.rising ? "rising" : "falling", sequence, of_line[edge.offset]);
    }
    return text;
  }
  [[nodiscard]] const SyncLog& log() const { return log_; }

 private:
  // Pulses are at whole seconds of UTC.
  void make_pulses() {
    std::int64_t utc_ns = first_multiple(clock_, context_.start, kNanosPerSecond);
    for (;; utc_ns += kNanosPerSecond) {
      const RigTime t = rig_time_of(clock_, utc_ns);
      const double t_s = (t - context_.start).seconds();
      if (t_s >= context_.duration_s) return;
      make_spurious(t_s);
      // Drawn in any case: a fault must not change what comes after it.
      const bool missing = random_.chance(config_.missing_probability);
      if (missing || context_.faults.active("pps_missing", t_s) != nullptr) {
        ++log_.missing;
      } else {
        ++log_.pulses;
        make_pulse(t);
      }
    }
  }

  void make_spurious(double second_s) {
    const Fault* const glitch = context_.faults.active("pps_glitch", second_s);
    const double mean = config_.spurious_probability + (glitch == nullptr ? 0 : glitch->value);
    const auto count = static_cast<int>(mean) + (spurious_.chance(mean - std::floor(mean)) ? 1 : 0);
    for (int i = 0; i < count; ++i) {
      const double t_s = second_s + spurious_.uniform();
      if (t_s >= context_.duration_s) continue;
      ++log_.spurious;
      make_pulse(context_.rig_time(t_s));
    }
  }

  // pps.csv and gpio.csv are stamped by two interrupts.
  void make_pulse(RigTime t) {
    pulses_.push_back(stamped(t, random_));
    edges_.push_back({stamped(t, random_), kPulseOffset, true, false});
    edges_.push_back({stamped(t + Duration::from_seconds(config_.pulse_s), random_), kPulseOffset, false, false});
  }

  void make_triggers(std::size_t index) {
    const TriggerLine& line = config_.triggers[index];
    Random random(context_.seed, "sync_trigger", index);
    const auto add = [&](double t_s, bool rising) {
      const RigTime at = stamped(context_.rig_time(t_s), random);
      edges_.push_back({at, index + 1, rising, random.chance(config_.missing_probability)});
    };
    for (const double t_s : line.times_s) {
      add(t_s, true);
      add(t_s + line.pulse_s, false);
    }
  }

  [[nodiscard]] RigTime stamped(RigTime t, Random& random) const {
    return clock_.received(t, random) - Duration::from_seconds(config_.jitter_s * std::log(1 - random.uniform()));
  }

  const Context& context_;
  const SyncConfig& config_;
  SensorClock clock_;
  Random random_{context_.seed, "pps"}, spurious_{context_.seed, "pps_spurious"};
  std::vector<RigTime> pulses_;
  std::vector<Edge> edges_;
  SyncLog log_;
};

}  // namespace

std::span<const KnownFault> sync_faults() { return kFaults; }

Result<SyncLog> write_sync(const Context& context, const SyncConfig& config, const std::filesystem::path& folder) {
  SyncWriter writer(context, config);
  writer.make();
  const std::array<std::pair<const char*, std::string>, 2> files{
      {{"pps.csv", writer.pps_text()}, {"gpio.csv", writer.gpio_text()}}};
  for (const auto& [name, text] : files) {
    Result<PartFile> file = PartFile::create(folder / name);
    if (!file.ok()) return file.error();
    file->write_text(text);
    if (const Status written = file->commit(); !written.ok()) return written.error();
  }
  return writer.log();
}

}  // namespace lxd::sim

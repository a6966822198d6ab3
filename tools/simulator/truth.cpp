// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/truth.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "backend/part_file.hpp"
#include "backend/trajectory_writer.hpp"

namespace lxd::sim {
namespace {

constexpr std::int64_t kPathRate_hz = 200;
// When a fault first touches the sensor's clock; infinite: never.
double first_clock_fault_s(const FaultPlan& faults, const std::string& sensor) {
  double first_s = std::numeric_limits<double>::infinity();
  for (const Fault& fault : faults.all()) {
    for (const char* const kind : {"_time_step", "_skew", "_restart"}) {
      if (fault.name == sensor + kind) first_s = std::min(first_s, fault.begin_s);
    }
  }
  return first_s;
}

constexpr Duration kPathStep = Duration::from_ns(kNanosPerSecond / kPathRate_hz);

}  // namespace

Status write_true_path(const Context& context, const std::filesystem::path& folder) {
  auto file = TrajectoryWriter::create(folder / "truth.tum", TrajectoryFormat::tum);
  if (!file) return file.error();
  for (Duration t; t.seconds() <= context.duration_s; t = t + kPathStep) {
    const Status written = file->append({context.start + t, context.motion.pose(t.seconds())});
    if (!written) return written;
  }
  return file->close();
}

Status write_true_clocks(const Context& context, std::span<const NamedClock> clocks,
                         const std::filesystem::path& folder) {
  auto file = PartFile::create(folder / "clocks.csv");
  if (!file) return file.error();
  file->write_text("sensor,rig_ns,sensor_ns\n");
  for (const NamedClock& named : clocks) {
    const SensorClock clock(named.clock, context.start);
    const double end_s = std::min(context.duration_s, first_clock_fault_s(context.faults, named.sensor));
    for (double t_s = 0; t_s <= end_s; t_s += 1) {
      const RigTime t = context.rig_time(t_s);
      file->write_text(fmt::format("{},{},{}\n", named.sensor, t.ns(), clock.sensor_ns(t) + named.shift_ns));
    }
  }
  return file->commit();
}

}  // namespace lxd::sim

// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluate/recording_clocks.hpp"

#include <memory>
#include <optional>
#include <vector>

#include "board/default/capacities.hpp"
#include "board/recorded_sensors.hpp"
#include "drivers/replay/rig_clock.hpp"
#include "drivers/replay/rig_recording.hpp"
#include "drivers/sync/clock_model.hpp"

namespace lxd {
namespace {

constexpr Duration kLearning = Duration::from_ns(5 * kNanosPerSecond);

// Whether the truth reaches there: it ends where a fault makes the clock wrong.
bool is_known(const std::vector<ClockTruth>& truth, std::int64_t sensor_ns) {
  return sensor_ns >= truth.front().sensor_ns && sensor_ns <= truth.back().sensor_ns;
}

// The recording's own clock, which also notes what it was asked and what it answered.
class NotingClock final : public SweepClock {
 public:
  NotingClock(const std::vector<ClockTruth>& truth, std::vector<ClockPair>& pairs) : truth_(truth), pairs_(pairs) {}

  void observe(std::int64_t sensor_ns, RigTime received) override { clock_.observe(sensor_ns, received); }
  bool place(Sweep& sweep, Rejections& rejected) override {
    const std::int64_t sensor_ns = sweep.end.ns();
    if (!clock_.place(sweep, rejected)) return false;
    if (is_known(truth_, sensor_ns)) pairs_.push_back({true_time(truth_, sensor_ns), sweep.end});
    return true;
  }
  [[nodiscard]] std::optional<RigTime> rig_time(RigTime sensor) const override { return clock_.rig_time(sensor); }

 private:
  RigClock clock_{ClockModelConfig{}};
  const std::vector<ClockTruth>& truth_;
  std::vector<ClockPair>& pairs_;
};

Status note_lidar(const std::filesystem::path& recording, const std::vector<ClockTruth>& truth,
                  std::vector<ClockPair>& pairs) {
  const auto source = open_rig_lidar(recording, "lidar0", std::make_unique<NotingClock>(truth, pairs));
  if (!source) return source.error();
  std::vector<LidarPoint> storage(capacities::kSweepPointsMax);
  Sweep sweep;
  sweep.storage = storage;
  for (;;) {
    sweep.count = 0;
    const auto found = (*source)->next(sweep);
    if (!found) return found.error();
    if (!*found) return success();
  }
}

Status note_imu(const std::filesystem::path& recording, const Rig& rig, const std::vector<ClockTruth>& truth,
                std::vector<ClockPair>& pairs) {
  ClockModel model{ClockModelConfig{}};
  SensorReaders readers;
  readers.imu = [&](const ImuSample& sample) {
    if (!sample.sensor_ns) return;
    if (model.add(*sample.sensor_ns, sample.t) == ClockVerdict::refused) return;
    if (is_known(truth, *sample.sensor_ns))
      pairs.push_back({true_time(truth, *sample.sensor_ns), model.to_rig(*sample.sensor_ns)});
  };
  Rig imu_alone;
  imu_alone.imu = rig.imu;
  const auto rejected = read_recorded_sensors(recording, imu_alone, readers);
  return rejected ? success() : Status(rejected.error());
}

void keep(std::map<std::string, ClockErrors>& errors, const char* sensor, std::vector<ClockPair> pairs) {
  if (pairs.empty()) return;
  const RigTime learned = pairs.front().true_time + kLearning;
  std::erase_if(pairs, [&](const ClockPair& pair) { return pair.true_time < learned; });
  if (!pairs.empty()) errors[sensor] = clock_errors(pairs);
}

}  // namespace

Result<std::map<std::string, ClockErrors>> recording_clock_errors(const std::filesystem::path& recording,
                                                                  const Rig& rig) {
  std::map<std::string, ClockErrors> errors;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(recording / "clocks.csv", ignored)) return errors;
  const auto truths = load_clock_truth(recording / "clocks.csv");
  if (!truths) return truths.error();
  Status status = success();
  constexpr std::size_t kFewest = 2;
  for (const auto& [sensor, truth] : *truths) {
    std::vector<ClockPair> pairs;
    if (truth.size() < kFewest) continue;
    if (sensor == "lidar0") status = note_lidar(recording, truth, pairs);
    if (sensor == "imu" && rig.imu) status = note_imu(recording, rig, truth, pairs);
    if (!status) return status.error();
    keep(errors, sensor.c_str(), std::move(pairs));
  }
  return errors;
}

}  // namespace lxd

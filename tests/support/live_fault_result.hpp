// SPDX-License-Identifier: Apache-2.0
// What a live run against troubled wires left: its counters by name, which sensors took part when, how far it moved
// from the truth.
#pragma once

#include <algorithm>

#include "tests/support/fault_schedule.hpp"
#include "tests/support/run_result.hpp"
#include "tests/support/wire_player.hpp"

namespace lxd::test {

class LiveFaultResult {
 public:
  // shift: from the recording's time to the run's.
  LiveFaultResult(const std::filesystem::path& run, const std::filesystem::path& recording, Duration shift)
      : report_(RunResult(run).report()), path_(RunResult(run).path()), shift_(shift) {
    const auto truth = load_tum(recording / "truth.tum");
    EXPECT_TRUE(truth.ok());
    if (truth.ok()) truth_ = truth->poses;
  }

  [[nodiscard]] const nlohmann::json& report() const { return report_; }

  // "lidar0.bad_crc", "imu.bytes": of a sensor's parser or of its device.
  [[nodiscard]] std::uint64_t counted(const std::string& name, const WirePlayer& player,
                                      const std::filesystem::path& folder) const {
    const std::string sensor = name.substr(0, name.find('.')), counter = name.substr(name.find('.') + 1);
    const bool line = sensor == "imu" || sensor == "gnss";
    const std::string device = line ? (folder / sensor).string() : fmt::format("udp {}", player.port_of(sensor));
    return count_in(report_["rejected"], sensor, counter) + count_in(report_["live"]["devices"], device, counter);
  }

  // Each silence that was longer than a sensor's patience is told, and nothing else is.
  void expect_silences(const WirePlayer& player) const {
    constexpr double kUnsure_s = 0.15;  // between two looks, and what scheduling takes
    for (const auto& [wire, patience_s] :
         std::map<std::string, double>{{"lidar0", 0.5}, {"lidar1", 0.5}, {"imu", 0.2}, {"gnss", 1}}) {
      const auto found = player.gaps_s().find(wire);
      const std::vector<double> gaps = found == player.gaps_s().end() ? std::vector<double>() : found->second;
      const auto longer = [&](double than_s) {
        return std::ranges::count_if(gaps, [&](double s) { return s > than_s; });
      };
      const auto told = events(wire, "silent");
      fmt::print("{}: {} silences of more than {} s, {} told\n", wire, longer(patience_s), patience_s, told);
      EXPECT_GE(told, longer(patience_s + kUnsure_s)) << wire;
      EXPECT_LE(told, longer(patience_s - kUnsure_s / 3) + 1) << wire;  // the last one is when all has been played
      EXPECT_LE(std::abs(events(wire, "heard again") - told), 1) << wire;
    }
  }

  // Soon after a trouble all sensors make the pose again.
  void expect_recovery(const FaultSlot& slot) const {
    constexpr double kSoon_s = 2;
    const double back_s = run_s(slot.end_s), whole_s = whole_again_s(back_s);
    fmt::print("{:18} at {:7.2f} s for {:.1f} s: whole again after {:.2f} s; {:.3f} m off in a second at most\n",
               slot.kind, slot.begin_s, slot.end_s - slot.begin_s, whole_s - back_s,
               worst_m(slot.begin_s, slot.end_s + kSoon_s));
    EXPECT_LE(whole_s - back_s, kSoon_s) << slot.kind << " at " << slot.begin_s;
  }

  // Through every trouble and after it the path moves as the rig did.
  void expect_true_motion(const FaultSchedule& schedule) const {
    constexpr double kWrong_m = 0.3;  // in a second
    for (const FaultSlot& slot : schedule.slots())
      EXPECT_LT(worst_m(slot.begin_s, slot.end_s + FaultSchedule::kRecovery_s), kWrong_m)
          << slot.kind << " at " << slot.begin_s;
  }

 private:
  static std::uint64_t count_in(const nlohmann::json& all, const std::string& of, const std::string& counter) {
    return all.contains(of) ? all[of].value(counter, std::uint64_t{0}) : 0;
  }
  [[nodiscard]] std::ptrdiff_t events(const std::string& source, const std::string& what) const {
    return std::ranges::count_if(report_["live"]["events"], [&](const auto& event) {
      return event["source"] == source && event["what"].template get<std::string>().starts_with(what);
    });
  }

  // Of the run's clock, from a time of the recording since its begin.
  [[nodiscard]] double run_s(double t_s) const {
    return (truth_.front().stamp + Duration::from_seconds(t_s) + shift_).seconds();
  }

  // When all sensors make the pose, at the earliest from `from_s` on.
  [[nodiscard]] double whole_again_s(double from_s) const {
    constexpr const char* kWhole = "LLI";
    std::string now = kWhole;
    for (const auto& change : report_["degraded"]) {
      const double t_s = change["t"];
      if (t_s > from_s && now == kWhole) return from_s;
      now = change["to"];
      if (t_s > from_s && now == kWhole) return t_s;
    }
    return now == kWhole ? from_s : INFINITY;
  }

  // How far the run's motion over a second is from the rig's, at most, for seconds that lie between two times.
  [[nodiscard]] double worst_m(double begin_s, double end_s) const {
    double worst = 0;
    std::size_t last = 0;
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const double t_s = path_[i].stamp.seconds();
      if (t_s < run_s(begin_s)) last = i + 1;
      if (t_s > run_s(end_s)) break;
      while (last < i && t_s - path_[last].stamp.seconds() > 1.05) ++last;
      if (last >= i || t_s - path_[last].stamp.seconds() < 0.9) continue;
      const Pose moved = path_[last].T.inverse() * path_[i].T;
      worst =
          std::max(worst, (moved.p - (true_pose(path_[last].stamp).inverse() * true_pose(path_[i].stamp)).p).norm());
    }
    return worst;
  }

  [[nodiscard]] const Pose& true_pose(RigTime stamp) const {
    const auto next = std::ranges::lower_bound(truth_, stamp - shift_, {}, &StampedPose::stamp);
    return next == truth_.end() ? truth_.back().T : next->T;
  }

  nlohmann::json report_;
  std::vector<StampedPose> path_, truth_;
  Duration shift_;
};

}  // namespace lxd::test

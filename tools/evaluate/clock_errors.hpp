// SPDX-License-Identifier: Apache-2.0
// How well a clock model maps a sensor's stamps onto the rig's time, against when the samples were truly taken.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

struct ClockPair {
  RigTime true_time;
  RigTime estimated;
};

// Of estimated minus true. A latency that the model cannot see is in the mean; what is left after the mean is taken out
// is what the model itself adds.
struct ClockErrors {
  std::size_t samples = 0;
  double mean_s = 0;
  double rms_s = 0, p99_s = 0, max_s = 0;  // of the magnitude
  double rms_about_mean_s = 0;
};

ClockErrors clock_errors(std::span<const ClockPair> pairs);

// A line a sensor, in microseconds, for people; ends with a line feed.
std::string to_table(const std::map<std::string, ClockErrors>& errors_by_sensor);

nlohmann::json to_json(const std::map<std::string, ClockErrors>& errors_by_sensor);  // for programs; seconds

struct ClockTruth {
  RigTime rig;
  std::int64_t sensor_ns = 0;  // of the sensor's own epoch, at that instant
};
using ClockTruths = std::map<std::string, std::vector<ClockTruth>>;  // by sensor, in order of time

// A simulated recording's `clocks.csv`: a line `sensor,rig_ns,sensor_ns` now and then of each sensor; '#' comments and
// a head line of these names are passed over. Error: file:line, found, wanted (both times of a sensor grow).
Result<ClockTruths> load_clock_truth(const std::filesystem::path& path);

// When the sensor's clock showed sensor_ns: on a straight line between the two truths around it, or on that of the two
// nearest. Precondition: there are two truths.
RigTime true_time(std::span<const ClockTruth> truth, std::int64_t sensor_ns);

}  // namespace lxd

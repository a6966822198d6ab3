// SPDX-License-Identifier: Apache-2.0
// `sensors.png`: what a rig's sensors delivered, a panel each. Knows no sensor: it is given series of numbers.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

struct TimeSeries {
  std::string name;
  std::vector<double> t_s;     // grows; of one origin for all series of a sheet
  std::vector<double> values;  // as long; what is not finite is a gap
};

struct SensorPanel {
  enum class Kind {
    curves,    // of the values over time
    dots,      // the same, of what comes seldom
    histogram  // of the values; the times do not matter
  };
  Kind kind = Kind::curves;
  std::string title;
  std::string unit;  // of the values
  std::vector<TimeSeries> series;
};

// How long after the one before each sample came: what is late or lost stands out. `times` grows; the first has none.
TimeSeries intervals_ms(const std::string& name, std::span<const RigTime> times, RigTime origin);

// How long after it was taken each sample was received.
TimeSeries latency_ms(const std::string& name, std::span<const RigTime> taken, std::span<const RigTime> received,
                      RigTime origin);

// Two panels a row, in the order given; panels over time share one time axis. 1800 pixels wide. Error: no panel, too
// many for one picture, or it cannot be written.
Status write_sensor_plots(const std::filesystem::path& png, std::span<const SensorPanel> panels,
                          const std::string& title, const std::string& subtitle);

}  // namespace lxd

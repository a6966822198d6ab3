// SPDX-License-Identifier: Apache-2.0
// Errors of clock models, and the truth that they are compared with.
#include "tools/evaluate/clock_errors.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

namespace lxd {
namespace {

using TruthBySensor = std::map<std::string, std::vector<ClockTruth>>;
constexpr std::string_view kHead = "sensor,t_true_s,sensor_ns";

template <typename Number>
bool parse(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

// The cause when the line is not as it should be, else empty.
std::string read_line(std::string_view line, TruthBySensor& truth) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.empty() || line.starts_with('#') || line == kHead) return "";
  const std::size_t first = line.find(','), last = line.rfind(',');
  if (first == line.npos || std::count(line.begin(), line.end(), ',') != 2)
    return fmt::format("found '{}', wanted {}", line, kHead);
  const std::string_view time = line.substr(first + 1, last - first - 1), stamp = line.substr(last + 1);
  ClockTruth pair;
  if (first == 0) return "found no sensor's name";
  if (!parse(time, pair.t_true_s) || !std::isfinite(pair.t_true_s))
    return fmt::format("found '{}', wanted a time in seconds", time);
  if (!parse(stamp, pair.sensor_ns)) return fmt::format("found '{}', wanted whole nanoseconds", stamp);
  truth[std::string(line.substr(0, first))].push_back(pair);
  return "";
}

// The nearest rank.
double quantile(std::vector<double> values, double share) {
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::ranges::nth_element(values, nth);
  return *nth;
}

}  // namespace

ClockErrors clock_errors(std::span<const ClockPair> pairs) {
  ClockErrors result;
  result.samples = pairs.size();
  if (pairs.empty()) return result;
  const auto count = static_cast<double>(pairs.size());
  std::vector<double> magnitudes_s;
  double squares = 0;
  for (const ClockPair& pair : pairs) {
    const double error_s = (pair.estimated - pair.true_time).seconds();
    result.mean_s += error_s / count;
    squares += error_s * error_s;
    magnitudes_s.push_back(std::abs(error_s));
  }
  result.rms_s = std::sqrt(squares / count);
  result.rms_about_mean_s = std::sqrt(std::max(squares / count - result.mean_s * result.mean_s, 0.0));
  result.max_s = std::ranges::max(magnitudes_s);
  result.p99_s = quantile(std::move(magnitudes_s), 0.99);
  return result;
}

std::string to_table(const std::map<std::string, ClockErrors>& errors_by_sensor) {
  constexpr double kMicroseconds = 1e6;
  std::string text = fmt::format("{:<26}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "clock models, us", "mean", "rms",
                                 "about it", "p99", "max", "samples");
  for (const auto& [sensor, e] : errors_by_sensor)
    fmt::format_to(std::back_inserter(text), "{:<26}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}{:>10}\n", sensor,
                   kMicroseconds * e.mean_s, kMicroseconds * e.rms_s, kMicroseconds * e.rms_about_mean_s,
                   kMicroseconds * e.p99_s, kMicroseconds * e.max_s, e.samples);
  return text;
}

Result<TruthBySensor> load_clock_truth(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return Error{fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))};
  TruthBySensor truth;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number)
    if (const std::string wrong = read_line(line, truth); !wrong.empty())
      return Error{fmt::format("{}:{}: {}", path.string(), number, wrong)};
  return truth;
}

}  // namespace lxd

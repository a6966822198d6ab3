// SPDX-License-Identifier: Apache-2.0
// Errors of clock models, and the truth that they are compared with.
#include "tools/evaluate/clock_errors.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace lxd {
namespace {

constexpr std::string_view kHead = "sensor,rig_ns,sensor_ns";

std::optional<std::int64_t> parse_ns(std::string_view text) {
  std::int64_t ns = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ns);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return ns;
}

std::string append(std::vector<ClockTruth>& truths, const ClockTruth& truth) {
  if (!truths.empty() && (truths.back().rig >= truth.rig || truths.back().sensor_ns >= truth.sensor_ns))
    return fmt::format("found {} ns and {} ns, wanted later than {} ns and {} ns before them", truth.rig.ns(),
                       truth.sensor_ns, truths.back().rig.ns(), truths.back().sensor_ns);
  truths.push_back(truth);
  return "";
}

// The cause when the line is not as it should be, else empty.
std::string read_line(std::string_view line, ClockTruths& truths) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.empty() || line.starts_with('#') || line == kHead) return "";
  const std::size_t first = line.find(','), last = line.rfind(',');
  if (std::count(line.begin(), line.end(), ',') != 2 || first == 0)
    return fmt::format("found '{}', wanted {}", line, kHead);
  const std::string_view rig = line.substr(first + 1, last - first - 1), sensor = line.substr(last + 1);
  const auto rig_ns = parse_ns(rig), sensor_ns = parse_ns(sensor);
  if (!rig_ns || !sensor_ns) return fmt::format("found '{}', wanted whole nanoseconds", rig_ns ? sensor : rig);
  return append(truths[std::string(line.substr(0, first))], {RigTime::from_ns(*rig_ns), *sensor_ns});
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

nlohmann::json to_json(const std::map<std::string, ClockErrors>& errors_by_sensor) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [sensor, e] : errors_by_sensor) {
    json[sensor] = {{"samples", e.samples}, {"mean_s", e.mean_s}, {"rms_s", e.rms_s},
                    {"p99_s", e.p99_s},     {"max_s", e.max_s},   {"rms_about_mean_s", e.rms_about_mean_s}};
  }
  return json;
}

Result<ClockTruths> load_clock_truth(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return Error{fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))};
  ClockTruths truths;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number)
    if (const std::string wrong = read_line(line, truths); !wrong.empty())
      return Error{fmt::format("{}:{}: {}", path.string(), number, wrong)};
  return truths;
}

RigTime true_time(std::span<const ClockTruth> truth, std::int64_t sensor_ns) {
  const auto above =
      std::ranges::upper_bound(truth.subspan(1, truth.size() - 2), sensor_ns, {}, &ClockTruth::sensor_ns);
  const ClockTruth &a = *std::prev(above), &b = *above;
  const double share = static_cast<double>(sensor_ns - a.sensor_ns) / static_cast<double>(b.sensor_ns - a.sensor_ns);
  return a.rig + Duration::from_ns(std::llround(share * static_cast<double>((b.rig - a.rig).ns())));
}

}  // namespace lxd

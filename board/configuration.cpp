// SPDX-License-Identifier: Apache-2.0
#include "board/configuration.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "board/rig_file.hpp"
#include "board/run_folder.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> find_rig_file(const fs::path& recording, const std::optional<fs::path>& given) {
  if (given) return given;
  std::error_code ignored;
  const fs::path folder = fs::is_regular_file(recording, ignored) ? recording.parent_path() : recording;
  const fs::path beside = folder / run_files::kRig;
  return fs::is_regular_file(beside, ignored) ? std::optional(beside) : std::nullopt;
}

// What the sensor itself is known for narrows the defaults; a setting may still say otherwise.
void apply_sensor(const LidarRig& lidar, EstimatorConfig& estimator) {
  if (lidar.range_sigma_m) estimator.range_sigma_m = *lidar.range_sigma_m;
  if (!lidar.range_m) return;
  estimator.range_min_m = std::max(estimator.range_min_m, (*lidar.range_m)[0]);
  estimator.range_max_m = std::min(estimator.range_max_m, (*lidar.range_m)[1]);
}

Status load(const fs::path& path, Configuration& configuration) {
  RigFile file = load_rig(path.string());
  if (!file.ok()) return Error{text_of(file.problems)};
  configuration.rig = std::move(file.rig);
  configuration.has_rig_file = true;
  configuration.remarks = std::move(file.remarks);
  apply_sensor(configuration.rig.lidar0, configuration.settings.estimator);
  for (const SettingChoice& choice : file.settings) {
    const Status status = set(configuration.settings, choice.key, choice.value);
    if (!status) return status;
  }
  return success();
}

void append_line(std::string& text, const std::string& line) {
  if (!text.empty()) text += '\n';
  text += line;
}

Status apply(std::span<const std::string> choices, Settings& settings) {
  std::string complaints;
  for (const std::string& text : choices) {
    const auto choice = parse_choice(text);
    const Status status = choice ? set(settings, choice->key, choice->value) : Status(choice.error());
    if (!status) append_line(complaints, status.error().message);
  }
  if (complaints.empty()) return success();
  return Error{complaints};
}

}  // namespace

Result<Configuration> configure(const fs::path& recording, const std::optional<fs::path>& rig_file,
                                std::span<const std::string> choices) {
  Configuration configuration;
  if (const auto path = find_rig_file(recording, rig_file)) {
    const Status loaded = load(*path, configuration);
    if (!loaded) return loaded.error();
  }
  const Status chosen = apply(choices, configuration.settings);
  if (!chosen) return chosen.error();
  const EstimatorConfig& e = configuration.settings.estimator;
  if (e.range_min_m >= e.range_max_m)
    return Error{fmt::format("estimator.range_min_m: found {}, wanted less than estimator.range_max_m, {}",
                             e.range_min_m, e.range_max_m)};
  return configuration;
}

void keep_pace(Configuration& configuration) {
  constexpr double kSweepShare = 0.8;
  constexpr double kMilliseconds = 1e3;  // in a second
  double& budget_ms = configuration.settings.estimator.budget_ms;
  if (budget_ms <= 0) budget_ms = kSweepShare * kMilliseconds / configuration.rig.lidar0.rate_hz;
}

void complete_by(Configuration& configuration, const LidarTraits& traits) {
  if (configuration.has_rig_file) return complete(configuration.rig, traits);
  configuration.rig = default_rig(traits);
  configuration.remarks.emplace_back("no rig file: the primary LiDAR is the reference frame of the path");
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// See scenario.hpp.
#include "tools/simulator/scenario.hpp"

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "board/nearest_names.hpp"
#include "board/rig_transform.hpp"
#include "tools/simulator/clock_keys.hpp"
#include "tools/simulator/shipped_scenarios.hpp"

namespace lxd::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 2> kLidarModels{"ouster", "livox"};

// "2026-01-01T12:00:00Z" as nanoseconds since 1970.
std::optional<RigTime> utc_time(const std::string& text) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0, used = 0;
  const int read =
      std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%2dZ%n", &year, &month, &day, &hour, &minute, &second, &used);
  constexpr int kFields = 6;
  if (read != kFields || static_cast<std::size_t>(used) != text.size()) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  const bool in_day = hour >= 0 && hour < 24 && minute >= 0 && minute < 60 && second >= 0 && second < 60;
  if (!date.ok() || !in_day) return std::nullopt;
  const std::chrono::sys_seconds instant = std::chrono::sys_days(date) + std::chrono::hours(hour) +
                                           std::chrono::minutes(minute) + std::chrono::seconds(second);
  return RigTime::from_ns(instant.time_since_epoch().count() * kNanosPerSecond);
}

class ScenarioReader {
 public:
  ScenarioReader(YamlSection& root, std::string_view file, Scenario& out, Problems& problems)
      : root_(root), file_(file), out_(out), problems_(problems) {}

  void read() {
    (void)root_.find("notes");
    read_world();
    read_motion();
    root_.read("duration_s", out_.duration_s, kDurationRange);
    read_start();
    read_lidar0();
    if (const auto node = root_.find("lidar1")) out_.lidar1 = read_lidar("lidar1", *node);
    read_sensor("imu", out_.imu);
    read_sensor("camera0", out_.camera0);
    read_sensor("wheel", out_.wheel);
    read_plain("gnss", out_.gnss);
    read_plain("sync", out_.sync);
    root_.reject_unknown();
  }

 private:
  YamlSection open(std::string_view name, const YAML::Node& node) {
    return YamlSection(node, std::string(name), file_, problems_);
  }

  // A file that the scenario names lies beside it, wherever the program was started.
  [[nodiscard]] fs::path beside(const fs::path& named) const {
    return named.empty() || named.is_absolute() ? named : fs::path(file_).parent_path() / named;
  }

  // A kind's name, or {file: PATH}.
  void read_world() {
    const auto node = root_.find("world");
    if (!node) return root_.complain("world", "found nothing, wanted a kind of world or {file: PATH}");
    out_.world_is_file = node->IsMap();
    if (!out_.world_is_file) return root_.read("world", out_.world);
    YamlSection section = open("world", *node);
    section.read("file", out_.world);
    if (out_.world.empty()) section.complain("file", "found nothing, wanted a PLY or OBJ file");
    out_.world = beside(out_.world).string();
    section.reject_unknown();
  }

  void read_motion() {
    const auto node = root_.find("motion");
    if (!node) return root_.complain("motion", "found nothing, wanted a carrier or a recorded path");
    YamlSection section = open("motion", *node);
    read_keys(section, out_.motion);
    out_.motion.file = beside(out_.motion.file);
    section.reject_unknown();
  }

  void read_start() {
    std::string text;
    root_.read("start", text);
    if (text.empty()) return;
    const auto time = utc_time(text);
    if (!time) return root_.complain("start", fmt::format("found '{}', wanted a time as 2026-01-01T12:00:00Z", text));
    out_.start = *time;
  }

  void read_lidar0() {
    const auto node = root_.find("lidar0");
    if (!node) return root_.complain("lidar0", "found nothing, wanted the primary LiDAR: every rig has one");
    out_.lidar0 = read_lidar("lidar0", *node);
  }

  LidarConfig read_lidar(std::string_view name, const YAML::Node& node) {
    YamlSection section = open(name, node);
    std::string model = "ouster";
    section.read("model", model, kLidarModels);
    if (model == "livox") return read_lidar_as<LivoxConfig>(section, name);
    return read_lidar_as<OusterConfig>(section, name);
  }

  template <typename Config>
  LidarConfig read_lidar_as(YamlSection& section, std::string_view name) {
    Config config;
    config.sensor = name;
    read_whole(section, config);
    return config;
  }

  template <typename Config>
  void read_sensor(std::string_view name, std::optional<Config>& config) {
    const auto node = root_.find(name);
    if (!node) return;
    YamlSection section = open(name, *node);
    read_whole(section, config.emplace());
  }

  // A sensor without an attitude of its own.
  template <typename Config>
  void read_plain(std::string_view name, std::optional<Config>& config) {
    const auto node = root_.find(name);
    if (!node) return;
    YamlSection section = open(name, *node);
    read_keys(section, config.emplace());
    read_clock(section, *config);
    section.reject_unknown();
  }

  template <typename Config>
  void read_whole(YamlSection& section, Config& config) {
    read_keys(section, config);
    if (const auto T = read_transform(section, "T_body_sensor")) config.T_body_sensor = *T;
    read_clock(section, config);
    section.reject_unknown();
  }

  template <typename Config>
  void read_clock(YamlSection& section, Config& config) {
    const auto node = section.find("clock");
    if (!node) return;
    YamlSection clock = open(section.path_of("clock"), *node);
    read_keys(clock, config.clock);
    clock.reject_unknown();
  }

  YamlSection& root_;
  std::string_view file_;
  Scenario& out_;
  Problems& problems_;
};

Error unknown_scenario(const std::string& what) {
  std::vector<std::string_view> names;
  std::string list;
  for (const ShippedScenario& scenario : shipped_scenarios()) {
    names.push_back(scenario.name);
    list += fmt::format("\n  {}", scenario.name);
  }
  return Error{fmt::format("{}: found no such scenario and no such file{}; wanted a file, or one of{}", what,
                           did_you_mean(what, names), list)};
}

}  // namespace

Result<Scenario> parse_scenario(std::string text, const std::string& file) {
  Scenario scenario;
  Problems problems;
  try {
    const YAML::Node node = YAML::Load(text);
    YamlSection root(node, "", file, problems);
    if (node.IsMap()) ScenarioReader(root, file, scenario, problems).read();
  } catch (const YAML::Exception& e) {
    problems.push_back({place_of(file, e.mark), "", fmt::format("found no sound YAML: {}", e.msg)});
  }
  if (!problems.empty()) return Error{text_of(problems)};
  scenario.name = fs::path(file).stem().string();
  scenario.text = std::move(text);
  return scenario;
}

Result<Scenario> load_scenario(const std::string& what) {
  for (const ShippedScenario& scenario : shipped_scenarios()) {
    if (scenario.name == what) return parse_scenario(std::string(scenario.text), what);
  }
  std::error_code ignored;
  if (!fs::is_regular_file(what, ignored)) return unknown_scenario(what);
  std::ifstream in(what);
  std::stringstream text;
  if (in) text << in.rdbuf();
  if (!in || !text) return Error{fmt::format("{}: cannot be read", what)};
  return parse_scenario(text.str(), what);
}

}  // namespace lxd::sim

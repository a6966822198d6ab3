// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/recording_writer.hpp"

#include <cmath>

#include <fmt/format.h>

#include "board/rig_text.hpp"
#include "board/run_folder.hpp"
#include "tools/simulator/camera/write_camera.hpp"
#include "tools/simulator/clock_check.hpp"
#include "tools/simulator/gnss/gnss_writer.hpp"
#include "tools/simulator/imu/imu_writer.hpp"
#include "tools/simulator/lidar/lidar_clock.hpp"
#include "tools/simulator/lidar/livox_writer.hpp"
#include "tools/simulator/lidar/ouster_writer.hpp"
#include "tools/simulator/log_json.hpp"
#include "tools/simulator/rig_of_scenario.hpp"
#include "tools/simulator/simulation_file.hpp"
#include "tools/simulator/sync/sync_writer.hpp"
#include "tools/simulator/truth.hpp"
#include "tools/simulator/wheel/wheel_writer.hpp"
#include "tools/simulator/world/world_file.hpp"

namespace lxd::sim {
namespace {

const std::string& name_of(const LidarConfig& config) {
  return std::visit([](const auto& lidar) -> const std::string& { return lidar.sensor; }, config);
}

NamedClock clock_of(const LidarConfig& config, RigTime start) {
  return std::visit(
      [&](const auto& lidar) -> NamedClock {
        return {lidar.sensor, lidar.clock, lidar.own_epoch() ? uptime_shift_ns(start) : 0};
      },
      config);
}

Result<LidarLog> write_as(const Context& context, const OusterConfig& config, const std::filesystem::path& folder,
                          const LidarOutput& output) {
  return write_ouster(context, config, folder, output);
}

Result<LidarLog> write_as(const Context& context, const LivoxConfig& config, const std::filesystem::path& folder,
                          const LidarOutput& output) {
  return write_livox(context, config, folder, output);
}

Status check_as(const Context& context, const OusterConfig& config) { return check_ouster(context, config); }
Status check_as(const Context& context, const LivoxConfig& config) { return check_livox(context, config); }
Status check(const Context& context, const LidarConfig& config) {
  return std::visit([&](const auto& lidar) { return check_as(context, lidar); }, config);
}

std::vector<NamedClock> clocks_of(const Scenario& scenario) {
  std::vector<NamedClock> clocks{clock_of(scenario.lidar0, scenario.start)};
  if (scenario.lidar1) clocks.push_back(clock_of(*scenario.lidar1, scenario.start));
  if (scenario.imu) clocks.push_back({"imu", scenario.imu->clock});
  if (scenario.camera0) clocks.push_back({"camera0", scenario.camera0->clock});
  return clocks;
}

// Those that no fault can step.
std::vector<std::pair<const char*, ClockConfig>> plain_clocks(const Scenario& scenario) {
  std::vector<std::pair<const char*, ClockConfig>> clocks;
  if (scenario.camera0) clocks.emplace_back("camera0", scenario.camera0->clock);
  if (scenario.wheel) clocks.emplace_back("wheel", scenario.wheel->clock);
  if (scenario.gnss) clocks.emplace_back("gnss", scenario.gnss->clock);
  if (scenario.sync) clocks.emplace_back("sync", scenario.sync->clock);
  return clocks;
}

nlohmann::ordered_json fault_json(const Fault& fault) {
  nlohmann::ordered_json json{{"name", fault.name}, {"begin_s", fault.begin_s}};
  if (std::isfinite(fault.end_s)) json["end_s"] = fault.end_s;
  json["value"] = fault.value;
  return json;
}

// The microcontroller's lines are those of the sensors that it triggers.
SyncConfig sync_of(const Context& context, const Scenario& scenario) {
  SyncConfig sync = *scenario.sync;
  if (!scenario.camera0) return sync;
  TriggerLine line;
  line.name = scenario.camera0->name;
  for (const RigTime t : exposure_times(context, *scenario.camera0))
    line.times_s.push_back((t - context.start).seconds());
  sync.triggers.push_back(std::move(line));
  return sync;
}

// Keeps a sensor's log under its name.
template <typename Log>
Status keep(nlohmann::ordered_json& counts, std::string_view sensor, const Result<Log>& log) {
  if (!log) return log.error();
  counts[std::string(sensor)] = to_json(*log);
  return success();
}

}  // namespace

Status check_sensors(const Context& context, const Scenario& scenario) {
  Status lidars = check(context, scenario.lidar0);
  if (lidars && scenario.lidar1) lidars = check(context, *scenario.lidar1);
  if (!lidars) return lidars;
  if (scenario.imu) {
    const Status sound = check_imu(context, *scenario.imu);
    if (!sound) return sound;
  }
  if (scenario.wheel) {
    const Status sound = check_wheel(*scenario.wheel, context.faults);
    if (!sound) return sound;
  }
  if (scenario.gnss) {
    const Status sound = check_gnss(*scenario.gnss);
    if (!sound) return sound;
  }
  for (const auto& [sensor, clock] : plain_clocks(scenario)) {
    const Status sound = check_clock(context, sensor, clock);
    if (!sound) return sound;
  }
  if (scenario.camera0 && !sees_everywhere(*scenario.camera0))
    return Error{"camera0: distortion_coeffs: found a lens that folds back within the image, wanted one that does not"};
  return success();
}

Status RecordingWriter::write_lidar(const LidarConfig& config, const SimulateObserver& observe,
                                    const std::atomic<bool>& stop) {
  LidarOutput output;
  output.form = request_.generic ? LidarForm::kScans : LidarForm::kPackets;
  output.threads = request_.threads;
  output.stop = &stop;
  output.progress = [&](double part) { observe(name_of(config), part); };
  return keep(counts_, name_of(config),
              std::visit([&](const auto& lidar) { return write_as(context_, lidar, folder_, output); }, config));
}

Status RecordingWriter::write_truth() {
  const Scenario& scenario = request_.scenario;
  Status status = write_true_path(context_, folder_);
  if (status) status = write_true_clocks(context_, clocks_of(scenario), folder_);
  if (status) status = write_world_ply(folder_ / "world.ply", context_.scene.world());
  if (status) status = write_text(folder_ / run_files::kRig, rig_text(rig_of(scenario, request_.seed)));
  return status;
}

// Last of all: a folder that has it is whole.
Status RecordingWriter::write_simulation_file() {
  const Scenario& scenario = request_.scenario;
  nlohmann::ordered_json faults = nlohmann::ordered_json::array();
  for (const Fault& fault : context_.faults.all()) faults.push_back(fault_json(fault));
  const nlohmann::ordered_json json{
      {"scenario", scenario.name}, {"seed", request_.seed}, {"duration_s", scenario.duration_s},
      {"faults", faults},          {"counts", counts_},     {"scenario_file", scenario.text}};
  return write_text(folder_ / kSimulationFile, json.dump(2) + "\n");
}

Status RecordingWriter::write(const SimulateObserver& observe, const std::atomic<bool>& stop) {
  const Scenario& scenario = request_.scenario;
  using Work = std::function<Status()>;
  std::vector<std::pair<const char*, Work>> works;
  works.emplace_back("truth", [&] { return write_truth(); });
  if (scenario.imu)
    works.emplace_back("imu", [&] {
      const ImuFiles files{.serial = !request_.generic, .generic = request_.generic};
      return keep(counts_, "imu", write_imu(context_, *scenario.imu, folder_, files));
    });
  if (scenario.wheel)
    works.emplace_back("wheel", [&] {
      WheelConfig wheel = *scenario.wheel;
      wheel.csv = wheel.csv || request_.generic;
      return keep(counts_, "wheel", write_wheel(context_, wheel, folder_));
    });
  if (scenario.gnss)
    works.emplace_back("gnss", [&] { return keep(counts_, "gnss", write_gnss(context_, *scenario.gnss, folder_)); });
  if (scenario.sync && !request_.generic)
    works.emplace_back(
        "sync", [&] { return keep(counts_, "sync", write_sync(context_, sync_of(context_, scenario), folder_)); });
  works.emplace_back("lidar0", [&] { return write_lidar(scenario.lidar0, observe, stop); });
  if (scenario.lidar1) works.emplace_back("lidar1", [&] { return write_lidar(*scenario.lidar1, observe, stop); });
  if (scenario.camera0)
    works.emplace_back("camera0", [&] {
      const CameraOutput output{request_.threads, [&](double part) { observe("camera0", part); }, &stop};
      return keep(counts_, "camera0", write_camera(context_, *scenario.camera0, folder_, output));
    });
  works.emplace_back("simulation", [&] { return write_simulation_file(); });
  for (const auto& [name, work] : works) {
    if (stop) return Error{"stopped: no recording is left"};
    observe(name, 0);
    const Status done = work();
    if (!done) return done;
  }
  return success();
}

}  // namespace lxd::sim

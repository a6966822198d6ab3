// SPDX-License-Identifier: Apache-2.0
// See simulation.hpp.
#include "tools/simulator/simulation.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "tools/simulator/fault_text.hpp"
#include "tools/simulator/motion/make_motion.hpp"
#include "tools/simulator/recording_size.hpp"
#include "tools/simulator/recording_writer.hpp"
#include "tools/simulator/sensor_places.hpp"
#include "tools/simulator/simulation_file.hpp"
#include "tools/simulator/world/clearance.hpp"
#include "tools/simulator/world/world_file.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kPathStep_s = 0.02;

Result<World> world_of(const Scenario& scenario, std::uint64_t seed) {
  return scenario.world_is_file ? load_world(scenario.world) : make_world(scenario.world, seed);
}

std::uint64_t bytes_below(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->is_regular_file(error)) bytes += entry->file_size(error);
  }
  return bytes;
}

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    names.push_back(entry->path().filename().string() + (entry->is_directory(error) ? "/" : ""));
  std::ranges::sort(names);
  return names;
}

}  // namespace

Result<std::unique_ptr<Simulation>> Simulation::prepare(SimulateRequest request) {
  auto faults = plan_faults(request.faults, faults_of(request.scenario, request.generic), request.scenario.duration_s);
  if (!faults) return faults.error();
  auto world = world_of(request.scenario, request.seed);
  if (!world) return world.error();
  std::unique_ptr<Simulation> simulation(new Simulation(std::move(request), std::move(*world), std::move(*faults)));
  const Status moves = simulation->make_path();
  if (!moves) return moves.error();
  const SimulateRequest& wanted = simulation->request_;
  Status sound = check_sensors(simulation->context(), wanted.scenario);
  if (sound) sound = check_sensor_places(simulation->context(), wanted.scenario);
  if (!sound) return sound.error();
  auto folder =
      RecordingFolder::create(wanted.out, expected_bytes(wanted.scenario, simulation->world_), kSimulatedRecording);
  if (!folder) return folder.error();
  simulation->folder_ = std::make_unique<RecordingFolder>(std::move(*folder));
  return simulation;
}

Simulation::Simulation(SimulateRequest request, World world, FaultPlan faults)
    : request_(std::move(request)), world_(std::move(world)), scene_(world_), faults_(std::move(faults)) {}

Context Simulation::context() const {
  return {scene_, *motion_, faults_, request_.seed, request_.scenario.start, request_.scenario.duration_s};
}

Status Simulation::make_path() {
  const Scenario& scenario = request_.scenario;
  auto motion = make_motion(scenario.motion, world_, request_.seed, scenario.duration_s);
  if (!motion) return motion.error();
  motion_ = std::make_unique<const Trajectory>(std::move(*motion));
  return check_path();
}

Status Simulation::check_path() const {
  std::vector<Eigen::Vector3d> path_m;
  const double end_s = request_.scenario.duration_s;
  for (double t_s = 0; t_s <= end_s; t_s += kPathStep_s) path_m.push_back(motion_->pose(t_s).p);
  ClearanceRules rules;
  rules.needs_ground = !request_.scenario.world_is_file;
  const auto collision = first_collision(scene_, path_m, rules);
  if (!collision) return success();
  const Eigen::Vector3d& p = path_m[collision->index];
  return Error{
      fmt::format("motion: at {:.2f} s, at {:.2f} {:.2f} {:.2f} m, the body {}; wanted a way through free space",
                  static_cast<double>(collision->index) * kPathStep_s, p.x(), p.y(), p.z(), collision->what)};
}

double Simulation::path_m() const {
  double length_m = 0;
  for (double t_s = 0; t_s + kPathStep_s <= request_.scenario.duration_s; t_s += kPathStep_s)
    length_m += (motion_->pose(t_s + kPathStep_s).p - motion_->pose(t_s).p).norm();
  return length_m;
}

Result<SimulateSummary> Simulation::run(const SimulateObserver& observe, const std::atomic<bool>& stop) {
  RecordingWriter writer(context(), request_, folder_->path());
  const Status written = writer.write(observe, stop);
  if (!written) return written.error();
  const std::uint64_t bytes = bytes_below(folder_->path());
  const Status whole = folder_->commit();
  if (!whole) return whole.error();
  return SimulateSummary{bytes, request_.scenario.duration_s, path_m(), files_in(request_.out)};
}

}  // namespace lxd::sim

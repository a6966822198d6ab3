// SPDX-License-Identifier: Apache-2.0
// `lxd-slam replay`: a recording through the system, into a run's folder.
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "board/memory.hpp"
#include "board/replay_system.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/complain.hpp"
#include "tools/cli/earlier_map_options.hpp"
#include "tools/cli/exit_status.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/say.hpp"

namespace lxd {
namespace {

struct ReplayArguments {
  std::string recording, rig;
  std::string sensors;
  std::string out = "run";
  EarlierMapOptions map;
  std::vector<std::string> choices, mutes;
  bool realtime = false;
  bool quiet = false;
};

Result<ReplayRequest> request_of(const ReplayArguments& arguments) {
  ReplayRequest request;
  if (!arguments.sensors.empty()) {
    const auto sensors = parse_sensor_set(arguments.sensors);
    if (!sensors) return sensors.error();
    request.sensors = *sensors;
  }
  request.recording = arguments.recording;
  if (!arguments.rig.empty()) request.rig = arguments.rig;
  request.out = arguments.out;
  request.realtime = arguments.realtime;
  request.choices = arguments.choices;
  request.map = request_of(arguments.map);
  auto mutes = parse_mutes(arguments.mutes);
  if (!mutes) return mutes.error();
  request.mutes = std::move(*mutes);
  return request;
}

void print_summary(const ReplaySystem& system, const std::string& out) {
  const Report& report = system.report();
  fmt::print("{}: {}, {} sweeps, {:.1f} s, {:.1f}x real time; a sweep took {:.1f} ms (p99 {:.1f}, max {:.1f})\n", out,
             text_of(system.sensors()), report.sweeps, report.duration_s, report.real_time_factor, report.sweep_ms.mean,
             report.sweep_ms.p99, report.sweep_ms.max);
}

// What a user must not take for a good run.
void print_troubles(const Report& report) {
  const UpdateCounts& updates = report.updates;
  for (const std::string& hint : report.hints) say("note: {}\n", hint);
  if (report.interrupted) say("note: interrupted before the recording's end\n");
  if (updates.untracked > 0)
    say("note: {} of {} sweeps did not hold the pose; it was carried on by its own motion\n", updates.untracked,
        report.sweeps);
  if (updates.carried > 0)
    say("note: the primary LiDAR was silent for {} sweeps; other sensors carried the pose on\n", updates.carried);
  if (updates.degenerate > 0)
    say("note: in {} of {} sweeps the surroundings left a direction open\n", updates.degenerate, report.sweeps);
  if (!report.rejected.empty() || !report.dropped.empty()) say("note: {}\n", losses_text(report));
}

int run_system(ReplaySystem& system, const ReplayArguments& arguments) {
  ProgressDisplay display(stderr);
  const bool loud = !arguments.quiet;
  const Status done = system.run(
      [&](const ReplayProgress& p) {
        if (!p.unwritten.empty()) say("note: {}; mapping goes on\n", p.unwritten);
        if (loud) display.show(progress_line(p));
      },
      watch_for_interrupt());
  if (loud) display.finish();
  if (!done) return complain("replay", done.error(), exit_status::kFailed);
  if (loud) print_summary(system, arguments.out);
  if (loud) print_troubles(system.report());
  return exit_status::kDone;
}

int run_replay(const ReplayArguments& arguments) {
  const auto request = request_of(arguments);
  if (!request) return complain("replay", request.error(), exit_status::kBadUsage);
  Arena arena = static_arena();
  const auto system = ReplaySystem::open(*request, arena);
  if (!system) return complain("replay", system.error(), exit_status::kBadUsage);
  for (const std::string& remark : (*system)->remarks()) say("note: {}\n", remark);
  return run_system(**system, arguments);
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_status) {
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* const command = app.add_subcommand("replay", "Take a recording through the system");
  command
      ->add_option("recording", arguments->recording,
                   "A generic folder, a KITTI raw drive or odometry sequence, or an Ouster .pcap with its "
                   "metadata beside it")
      ->type_name("RECORDING")
      ->required();
  command->add_option("--rig", arguments->rig, "Rig file; otherwise rig.yaml in the recording's folder")
      ->type_name("RIG.yaml");
  command
      ->add_option("--sensors", arguments->sensors,
                   "Sensors in use: L the primary LiDAR, a second L the extra one, C camera, I IMU, W wheels, G GNSS; "
                   "otherwise all that the rig file and the recording have")
      ->type_name("LLCIWG");
  command->add_option("--out", arguments->out, "Folder of the run; an earlier run in it is replaced")
      ->type_name("RUN")
      ->capture_default_str();
  command->add_flag("--realtime", arguments->realtime,
                    "At the recording's pace; the oldest sweep is dropped when late");
  command->add_option("--set", arguments->choices, "Change a setting; 'lxd-slam check --settings' lists them")
      ->type_name("key=value")
      ->expected(1)
      ->take_all();
  command
      ->add_option("--mute", arguments->mutes,
                   "Do not hear a sensor (lidar0 lidar1 camera0 imu wheel gnss) from BEGIN s on, for DURATION s or for "
                   "good: what the rig does without it")
      ->type_name("SENSOR@BEGIN[+DURATION]")
      ->expected(1)
      ->take_all();
  add_earlier_map_options(*command, arguments->map);
  command->add_flag("--quiet", arguments->quiet, "No progress, no summary");
  command->callback([=, &exit_status] { exit_status = run_replay(*arguments); });
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// `lxd-slam run`: a live rig through the system, into a run's folder.
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "board/live_system.hpp"
#include "board/memory.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/complain.hpp"
#include "tools/cli/earlier_map_options.hpp"
#include "tools/cli/exit_status.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/say.hpp"

namespace lxd {
namespace {

struct RunArguments {
  std::string rig, sensors, poses;
  std::string out = "run";
  EarlierMapOptions map;
  std::vector<std::string> choices;
  double duration_s = 0;
  bool quiet = false;
};

Result<LiveRequest> request_of(const RunArguments& arguments) {
  LiveRequest request;
  if (!arguments.sensors.empty()) {
    const auto sensors = parse_sensor_set(arguments.sensors);
    if (!sensors) return sensors.error();
    request.sensors = *sensors;
  }
  request.rig = arguments.rig;
  request.out = arguments.out;
  request.choices = arguments.choices;
  if (!arguments.poses.empty()) {
    const auto endpoint = parse_endpoint(arguments.poses);
    if (!endpoint) return Error{"--poses: " + endpoint.error().message};
    request.poses = *endpoint;
  }
  request.map = request_of(arguments.map);
  if (arguments.duration_s > 0) request.duration = Duration::from_seconds(arguments.duration_s);
  return request;
}

std::string line_of(const LiveProgress& progress) {
  std::string line =
      fmt::format("{:.1f} s  sweep {}  dropped {}", progress.elapsed_s, progress.sweeps, progress.dropped);
  if (progress.untracked > 0) line += fmt::format("  untracked {}", progress.untracked);
  if (!progress.silent.empty()) line += "  silent: " + progress.silent;
  return line;
}

void print_summary(const LiveSystem& system, const std::string& out) {
  const Report& report = system.report();
  fmt::print(
      "{}: {}, {} sweeps, {:.1f} s; a sweep took {:.1f} ms (p99 {:.1f}, max {:.1f}), its pose came {:.1f} ms "
      "after it (p99 {:.1f})\n",
      out, text_of(system.sensors()), report.sweeps, report.duration_s, report.sweep_ms.mean, report.sweep_ms.p99,
      report.sweep_ms.max, report.live->latency_ms.mean, report.live->latency_ms.p99);
  if (report.updates.untracked > 0)
    say("note: {} of {} sweeps did not hold the pose; it was carried on by its own motion\n", report.updates.untracked,
        report.sweeps);
  for (const std::string& hint : report.hints) say("note: {}\n", hint);
  if (report.live->cycle_overruns > 0) say("note: {} sweeps took longer than a period\n", report.live->cycle_overruns);
  if (!report.rejected.empty() || !report.dropped.empty()) say("note: {}\n", losses_text(report));
}

int run_live(const RunArguments& arguments) {
  const auto request = request_of(arguments);
  if (!request) return complain("run", request.error(), exit_status::kBadUsage);
  const std::atomic<bool>& stop = watch_for_interrupt();
  Arena arena = static_arena();
  const auto system = LiveSystem::open(*request, arena);
  if (!system) return complain("run", system.error(), exit_status::kBadUsage);
  for (const std::string& remark : (*system)->remarks()) say("note: {}\n", remark);
  ProgressDisplay display(stderr);
  const bool loud = !arguments.quiet;
  const Status done = (*system)->run(
      [&](const LiveProgress& progress) {
        for (const RigEvent& event : progress.events) say("note: {}: {}\n", event.source, event.what);
        if (loud) display.show(line_of(progress));
      },
      stop);
  if (loud) display.finish();
  if (!done) return complain("run", done.error(), exit_status::kFailed);
  if (loud) print_summary(**system, arguments.out);
  return exit_status::kDone;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_status) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App* const command = app.add_subcommand("run", "Take a live rig through the system, until Ctrl-C");
  command->add_option("--rig", arguments->rig, "The rig file, with ports and devices")
      ->type_name("RIG.yaml")
      ->required();
  command->add_option("--out", arguments->out, "Folder of the run; an earlier run in it is replaced")
      ->type_name("RUN")
      ->capture_default_str();
  command
      ->add_option("--sensors", arguments->sensors,
                   "Sensors in use, as with replay; otherwise all that have a wire in the rig file")
      ->type_name("LLIWG");
  command->add_option("--set", arguments->choices, "Change a setting; 'lxd-slam check --settings' lists them")
      ->type_name("key=value")
      ->expected(1)
      ->take_all();
  command->add_option("--duration", arguments->duration_s, "Seconds; otherwise until Ctrl-C")
      ->type_name("S")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--poses", arguments->poses,
                   "Send the pose there at every reading of the IMU, as a datagram (board/pose_message.hpp)")
      ->type_name("ADDR:PORT");
  add_earlier_map_options(*command, arguments->map);
  command->add_flag("--quiet", arguments->quiet, "Only what goes wrong");
  command->callback([=, &exit_status] { exit_status = run_live(*arguments); });
}

}  // namespace lxd

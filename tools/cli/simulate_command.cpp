// SPDX-License-Identifier: Apache-2.0
// `lxd-slam simulate`: a scenario into a recording with exact truth.
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/cli/commands.hpp"
#include "tools/cli/complain.hpp"
#include "tools/cli/exit_status.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/progress.hpp"
#include "tools/simulator/fault_text.hpp"
#include "tools/simulator/shipped_scenarios.hpp"
#include "tools/simulator/simulation.hpp"

namespace lxd {
namespace {

struct SimulateArguments {
  std::string scenario, out;
  std::vector<std::string> faults;
  std::uint64_t seed = 0;
  std::optional<double> duration_s;  // none: the scenario's
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  bool generic = false;
  bool list_faults = false;
  bool quiet = false;
};

std::string scenario_names() {
  std::string names;
  for (const sim::ShippedScenario& scenario : sim::shipped_scenarios()) {
    names += names.empty() ? "" : ", ";
    names += scenario.name;
  }
  return names;
}

// What was written, and what one does with it.
void print_summary(const sim::SimulateSummary& summary, const std::string& out) {
  constexpr double kBytesPerMegabyte = 1e6;
  fmt::print("{}: {:.1f} s along {:.1f} m, {:.0f} MB: {}\n", out, summary.duration_s, summary.path_m,
             static_cast<double>(summary.bytes) / kBytesPerMegabyte, fmt::join(summary.files, ", "));
  fmt::print(
      "next: lxd-slam replay {0} --out run\n"
      "      lxd-slam evaluate --estimate run/odometry.tum --truth {0}/truth.tum --mesh run/mesh.ply "
      "--world {0}/world.ply --rig {0}/rig.yaml --recording {0} --plots run\n",
      out);
}

int run_simulation(sim::Simulation& simulation, const SimulateArguments& arguments) {
  ProgressDisplay display(stderr);
  const bool loud = !arguments.quiet;
  const auto done = simulation.run(
      [&](std::string_view sensor, double part) {
        if (loud) display.show(fmt::format("{}  {:.0f} %", sensor, 100 * part));
      },
      watch_for_interrupt());
  if (loud) display.finish();
  if (!done) return complain("simulate", done.error(), exit_status::kFailed);
  if (loud) print_summary(*done, arguments.out);
  return exit_status::kDone;
}

sim::SimulateRequest request_of(const SimulateArguments& arguments, sim::Scenario scenario) {
  sim::SimulateRequest request;
  request.scenario = std::move(scenario);
  request.seed = arguments.seed;
  request.faults = arguments.faults;
  request.out = arguments.out;
  request.generic = arguments.generic;
  request.threads = arguments.threads;
  return request;
}

int run_simulate(SimulateArguments arguments) {
  auto scenario = sim::load_scenario(arguments.scenario);
  if (!scenario) return complain("simulate", scenario.error(), exit_status::kBadUsage);
  if (arguments.duration_s) scenario->duration_s = *arguments.duration_s;
  const std::string too = complaint_about(scenario->duration_s, sim::kDurationRange);
  if (!too.empty()) return complain("simulate", Error{fmt::format("--duration: {}", too)}, exit_status::kBadUsage);
  if (arguments.list_faults) {
    fmt::print("{}", sim::fault_list(sim::faults_of(*scenario, arguments.generic)));
    return exit_status::kDone;
  }
  if (arguments.out.empty()) arguments.out = scenario->name;
  auto simulation = sim::Simulation::prepare(request_of(arguments, std::move(*scenario)));
  if (!simulation) return complain("simulate", simulation.error(), exit_status::kBadUsage);
  return run_simulation(**simulation, arguments);
}

}  // namespace

void add_simulate_command(CLI::App& app, int& exit_status) {
  const auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* const command = app.add_subcommand("simulate", "Make a recording of a simulated rig, with exact truth");
  command->add_option("scenario", arguments->scenario, fmt::format("A scenario's file, or one of {}", scenario_names()))
      ->type_name("SCENARIO")
      ->required();
  command
      ->add_option("--out", arguments->out,
                   "Folder of the recording, else named as the scenario; an earlier simulation in it is replaced")
      ->type_name("RECORDING");
  command->add_option("--seed", arguments->seed, "Of world, motion and noise; the same seed gives the same bytes")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--duration", arguments->duration_s, "Seconds, instead of the scenario's")->type_name("S");
  command
      ->add_option("--fault", arguments->faults,
                   "A fault, e.g. lidar0_loss@10+5=0.33: from 10 s, for 5 s, a third; any number of times")
      ->type_name("NAME[@BEGIN[+DURATION]][=VALUE]")
      ->expected(1)
      ->take_all();
  command->add_flag("--list-faults", arguments->list_faults,
                    "The faults that the scenario's sensors know, and nothing else");
  command->add_flag("--generic", arguments->generic, "A generic folder instead of packets and wires");
  command->add_option("--threads", arguments->threads, "For the rays; the bytes do not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->add_flag("--quiet", arguments->quiet, "No progress, no summary");
  command->callback([=, &exit_status] { exit_status = run_simulate(*arguments); });
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// `lxd-slam evaluate`: an estimated path, and a mesh, against the truth.
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "board/rig_file.hpp"
#include "board/run_folder.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/exit_status.hpp"
#include "tools/evaluate/evaluate.hpp"
#include "tools/evaluate/plots/error_plots.hpp"
#include "tools/evaluate/recording_clocks.hpp"
#include "tools/evaluate/recording_panels.hpp"

namespace lxd {
namespace {

struct EvaluateArguments {
  std::string estimate, truth, covariance, mesh, world, rig, recording, plots;
  bool json = false;
};

std::optional<std::filesystem::path> given(const std::string& path) {
  if (path.empty()) return std::nullopt;
  return path;
}

EvaluateOptions options_of(const EvaluateArguments& arguments) {
  EvaluateOptions options;
  options.estimate = arguments.estimate;
  options.truth = arguments.truth;
  options.covariance = given(arguments.covariance);
  options.mesh = given(arguments.mesh);
  options.world = given(arguments.world);
  options.rig = given(arguments.rig);
  return options;
}

int fail(const std::string& message, int status) {
  fmt::print(stderr, "lxd-slam evaluate: {}\n", message);
  return status;
}

std::string title_of(const std::filesystem::path& estimate) {
  const std::string run = std::filesystem::absolute(estimate).parent_path().filename().string();
  return fmt::format("{} / {}", run, estimate.filename().string());
}

Status plot(const EvaluateArguments& arguments, const EvaluationReport& report) {
  if (arguments.plots.empty()) return success();
  const auto png = std::filesystem::path(arguments.plots) / run_files::kErrorPlots;
  return write_error_plots(png, report, title_of(arguments.estimate));
}

// What is asked of the recording itself.
struct RecordingReport {
  std::map<std::string, ClockErrors> clocks;  // by sensor; of a simulated recording
  std::vector<SensorPanel> panels;            // when plots are wanted
};

Result<RecordingReport> report_recording(const EvaluateArguments& arguments) {
  RecordingReport report;
  if (arguments.recording.empty()) return report;
  const std::filesystem::path recording = arguments.recording;
  const RigFile file = load_rig((recording / run_files::kRig).string());
  if (!file.ok()) return Error{text_of(file.problems)};
  auto clocks = recording_clock_errors(recording, file.rig);
  if (!clocks) return clocks.error();
  report.clocks = std::move(*clocks);
  if (arguments.plots.empty()) return report;
  auto panels = recording_panels(recording, file.rig);
  if (!panels) return panels.error();
  report.panels = std::move(*panels);
  return report;
}

void print(const EvaluateArguments& arguments, const EvaluationReport& report, const RecordingReport& recording) {
  constexpr int kIndent = 2;
  if (!arguments.json) {
    fmt::print("{}", to_table(report));
    if (!recording.clocks.empty()) fmt::print("\n{}", to_table(recording.clocks));
    return;
  }
  nlohmann::json json = to_json(report);
  if (!recording.clocks.empty()) json["clocks"] = to_json(recording.clocks);
  fmt::print("{}\n", json.dump(kIndent));
}

Status plot_sensors(const EvaluateArguments& arguments, const RecordingReport& recording) {
  if (recording.panels.empty()) return success();
  const auto png = std::filesystem::path(arguments.plots) / run_files::kSensorPlots;
  const std::string name = std::filesystem::absolute(arguments.recording).filename().string();
  return write_sensor_plots(png, recording.panels, name, "what its sensors delivered");
}

int run_evaluate(const EvaluateArguments& arguments) {
  if (!arguments.plots.empty() && !std::filesystem::is_directory(arguments.plots))
    return fail(fmt::format("{}: found no folder, wanted one for the plots", arguments.plots), exit_status::kBadUsage);
  const auto report = evaluate(options_of(arguments));
  if (!report) return fail(report.error().message, exit_status::kBadUsage);
  const auto recording = report_recording(arguments);
  if (!recording) return fail(recording.error().message, exit_status::kBadUsage);
  print(arguments, *report, *recording);
  Status plotted = plot(arguments, *report);
  if (plotted) plotted = plot_sensors(arguments, *recording);
  if (!plotted) return fail(plotted.error().message, exit_status::kFailed);
  return exit_status::kDone;
}

}  // namespace

void add_evaluate_command(CLI::App& app, int& exit_status) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* const command = app.add_subcommand("evaluate", "Compare a path, and a mesh, with the truth");
  command->add_option("--estimate", arguments->estimate, "The estimated path")->type_name("EST.tum")->required();
  command->add_option("--truth", arguments->truth, "The true path of the same frame")
      ->type_name("TRUTH.tum")
      ->required();
  command
      ->add_option("--covariance", arguments->covariance,
                   "The estimate's covariance; otherwise EST_covariance.txt when it is there")
      ->type_name("COV.txt");
  CLI::Option* const mesh =
      command->add_option("--mesh", arguments->mesh, "The mesh, in the estimate's frame")->type_name("MESH.ply");
  CLI::Option* const world = command->add_option("--world", arguments->world, "The true surfaces, in the truth's frame")
                                 ->type_name("WORLD.ply");
  mesh->needs(world);
  world->needs(mesh);
  command
      ->add_option("--rig", arguments->rig,
                   "Whose LiDARs saw the world: what lies outside of their view does not count as missing")
      ->type_name("RIG.yaml")
      ->needs(mesh);
  command
      ->add_option(
          "--recording", arguments->recording,
          "The rig recording of the run: how well its clocks were mapped, and with --plots what its sensors sent")
      ->type_name("RECORDING");
  command->add_option("--plots", arguments->plots, "Folder for errors.png and sensors.png: the run's own, as a rule")
      ->type_name("DIR");
  command->add_flag("--json", arguments->json, "For programs");
  command->callback([=, &exit_status] { exit_status = run_evaluate(*arguments); });
}

}  // namespace lxd

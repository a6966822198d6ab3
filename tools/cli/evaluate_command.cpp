// SPDX-License-Identifier: Apache-2.0
// `lxd-slam evaluate`: an estimated path, and a mesh, against the truth.
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "board/run_folder.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/exit_status.hpp"
#include "tools/evaluate/evaluate.hpp"
#include "tools/evaluate/plots/error_plots.hpp"

namespace lxd {
namespace {

struct EvaluateArguments {
  std::string estimate, truth, covariance, mesh, world, rig, plots;
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

int run_evaluate(const EvaluateArguments& arguments) {
  if (!arguments.plots.empty() && !std::filesystem::is_directory(arguments.plots))
    return fail(fmt::format("{}: found no folder, wanted one for the plots", arguments.plots), exit_status::kBadUsage);
  const auto report = evaluate(options_of(arguments));
  if (!report) return fail(report.error().message, exit_status::kBadUsage);
  constexpr int kIndent = 2;
  fmt::print("{}", arguments.json ? to_json(*report).dump(kIndent) + "\n" : to_table(*report));
  if (const Status plotted = plot(arguments, *report); !plotted)
    return fail(plotted.error().message, exit_status::kFailed);
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
  command->add_option("--plots", arguments->plots, "Folder for errors.png: the run's own, as a rule")->type_name("DIR");
  command->add_flag("--json", arguments->json, "For programs");
  command->callback([=, &exit_status] { exit_status = run_evaluate(*arguments); });
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// `lxd-slam evaluate`: an estimated path, and a mesh, against the truth.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "tools/cli/commands.hpp"
#include "tools/cli/exit_status.hpp"
#include "tools/evaluate/evaluate.hpp"

namespace lxd {
namespace {

struct EvaluateArguments {
  std::string estimate, truth, covariance, mesh, world;
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
  return options;
}

int run_evaluate(const EvaluateArguments& arguments) {
  const auto report = evaluate(options_of(arguments));
  if (!report) {
    fmt::print(stderr, "lxd-slam evaluate: {}\n", report.error().message);
    return exit_status::kBadUsage;
  }
  constexpr int kIndent = 2;
  fmt::print("{}", arguments.json ? to_json(*report).dump(kIndent) + "\n" : to_table(*report));
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
  command->add_flag("--json", arguments->json, "For programs");
  command->callback([=, &exit_status] { exit_status = run_evaluate(*arguments); });
}

}  // namespace lxd

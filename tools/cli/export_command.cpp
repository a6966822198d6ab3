// SPDX-License-Identifier: Apache-2.0
// `lxd-slam export`: a finished run in the formats of other programs.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "backend/archive.hpp"
#include "backend/cloud.hpp"
#include "backend/mesh_export.hpp"
#include "backend/trajectory_writer.hpp"
#include "board/run_folder.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/complain.hpp"
#include "tools/cli/exit_status.hpp"

namespace lxd {
namespace {

struct ExportOptions {
  std::string run, mesh, cloud, trajectory;
};

Status export_mesh(const RunFolder& run, const std::string& out) {
  const auto archive = Archive::open(run.file(run_files::kArchive));
  if (!archive) return archive.error();
  if (archive->totals().submeshes == 0)
    return Error{run.path().string() + ": found no sub-mesh in the archive, wanted a finished run"};
  return out.ends_with(".glb") ? write_mesh_glb(out, *archive) : write_mesh_ply(out, *archive);
}

Status export_trajectory(const RunFolder& run, const std::string& out) {
  const auto archive = Archive::open(run.file(run_files::kArchive));
  if (!archive) return archive.error();
  const auto poses = archive->poses();
  if (!poses) return poses.error();
  if (poses->empty()) return Error{run.path().string() + ": found no poses in the archive, wanted a finished run"};
  return write_trajectory(out, *poses);
}

Status export_all(const RunFolder& run, const ExportOptions& options) {
  Status status = success();
  if (!options.mesh.empty()) status = export_mesh(run, options.mesh);
  if (status && !options.cloud.empty()) status = export_cloud(run.file(run_files::kCloud), options.cloud);
  if (status && !options.trajectory.empty()) status = export_trajectory(run, options.trajectory);
  return status;
}

int run_export(const ExportOptions& options) {
  const auto run = RunFolder::open(options.run);
  if (!run) return complain("export", run.error(), exit_status::kBadUsage);
  const Status status = export_all(*run, options);
  return status ? exit_status::kDone : complain("export", status.error(), exit_status::kFailed);
}

// Formats go by the file's ending; a wrong one is bad usage, found before anything is written.
CLI::Validator ending_of(const std::vector<std::string>& endings) {
  const auto check = [endings](const std::string& path) {
    std::string wanted;
    for (const std::string& ending : endings) {
      if (path.ends_with(ending)) return std::string();
      wanted += (wanted.empty() ? "" : " or ") + ending;
    }
    return fmt::format("found '{}', wanted a name that ends in {}", path, wanted);
  };
  return CLI::Validator(check, "");
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_status) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* const command =
      app.add_subcommand("export", "Write a finished run's mesh, cloud or path for other programs");
  command->add_option("run", options->run, "Folder of the run")->type_name("RUN")->required();
  command->add_option("--mesh", options->mesh, "The mesh")
      ->type_name("OUT.ply|.glb")
      ->check(ending_of({".ply", ".glb"}));
  command->add_option("--cloud", options->cloud, "The registered points")
      ->type_name("OUT.ply|.pcd|.las")
      ->check(ending_of({".ply", ".pcd", ".las"}));
  command->add_option("--trajectory", options->trajectory, "The path")
      ->type_name("OUT.tum|.kitti")
      ->check(ending_of({".tum", ".kitti"}));
  command->callback([=, &exit_status] {
    const bool nothing = options->mesh.empty() && options->cloud.empty() && options->trajectory.empty();
    if (nothing) throw CLI::RequiredError("--mesh, --cloud or --trajectory");
    exit_status = run_export(*options);
  });
}

}  // namespace lxd

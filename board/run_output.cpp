// SPDX-License-Identifier: Apache-2.0
#include "board/run_output.hpp"

#include <utility>

#include "board/map_losses.hpp"
#include "board/rig_text.hpp"

namespace lxd {

Result<RunOutput> RunOutput::create(const std::filesystem::path& out, const Configuration& configuration,
                                    const Star& star, MeshExtraction& extraction,
                                    const std::optional<EarlierMap>& earlier, BackEndPace pace) {
  auto folder = RunFolder::create(out);
  if (!folder) return folder.error();
  auto path = PathWriter::create(*folder);
  if (!path) return path.error();
  auto map_sink = MapSink::create(*folder, configuration, star, extraction, earlier, pace);
  if (!map_sink) return map_sink.error();
  const Status rig = write_text(folder->file(run_files::kRig), rig_text(configuration.rig, configuration.settings));
  if (!rig) return rig.error();
  return RunOutput(std::move(*folder), std::move(*path), std::move(*map_sink), star.T_body_reference, extraction);
}

RunOutput::RunOutput(RunFolder folder, PathWriter path, MapSink map_sink, const Pose& T_body_reference,
                     MeshExtraction& extraction)
    : folder_(std::move(folder)),
      path_(std::move(path)),
      map_sink_(std::move(map_sink)),
      T_body_reference_(T_body_reference),
      extraction_(&extraction) {}

Status RunOutput::publish(const SweepOutcome& outcome, RigTime sub_mesh_begin) {
  const Pose T_world_reference = outcome.T_world_body * T_body_reference_;
  Status written =
      path_.append({outcome.stamp, T_world_reference},
                   carry_covariance(outcome.T_world_body, T_body_reference_, outcome.covariance), outcome.innovation);
  keep_first(written, map_sink_.append(outcome, sub_mesh_begin));
  if (MapColours* const colours = map_sink_.colours()) colours->intake().place(outcome, sub_mesh_begin);
  return written;
}

void RunOutput::offer(ColourOffer offer) {
  if (MapColours* const colours = map_sink_.colours()) colours->intake().offer(std::move(offer));
}

// It is read again, in colour, when it is chosen.
std::optional<ColourOffer> RunOutput::offer_of(const CameraImage& image, RigTime instant) const {
  const ColourCamera* const camera = colour_camera();
  if (camera == nullptr || image.colours.empty()) return std::nullopt;
  return ColourOffer{instant, image.exposure, image.gain, [camera, file = image.colours] {
                       ColourPixels pixels;
                       return read_image(file, pixels) ? camera->key_pixels(pixels) : std::vector<std::uint8_t>();
                     }};
}

const ColourCamera* RunOutput::colour_camera() const {
  const MapColours* const colours = map_sink_.colours();
  return colours == nullptr ? nullptr : &colours->camera();
}

void RunOutput::at_leisure() {
  if (MapColours* const colours = map_sink_.colours()) colours->at_leisure();
}

void RunOutput::begin_again() {
  if (MapColours* const colours = map_sink_.colours()) colours->begin_again();
}

void RunOutput::write(Report& report) const {
  if (MapColours* const colours = map_sink_.colours()) colours->write(report);
}

Status RunOutput::store(const SubMesh& sub_mesh, Report& report, MapKeeper& keeper) {
  Status stored = map_sink_.append(sub_mesh, keeper);
  if (!stored) ++report.dropped["sub_meshes_unwritten"];
  count_losses(sub_mesh, extraction_->counters(), report);
  return stored;
}

Status RunOutput::finish_map(const CorrectedPath& corrections) {
  return map_sink_.finish(folder_, path_.poses(), corrections);
}

Status RunOutput::write_report(const Report& report) const {
  return write_text(folder_.file(run_files::kReport), report_json(report));
}

void keep_first(Status& first, Status status) {
  if (first && !status) first = std::move(status);
}

}  // namespace lxd

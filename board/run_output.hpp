// SPDX-License-Identifier: Apache-2.0
// What a run writes, replayed or live: path, map, report, the configuration in force. Low priority; one thread at a
// time.
#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "board/configuration.hpp"
#include "board/map_sink.hpp"
#include "board/path_writer.hpp"
#include "board/report.hpp"
#include "board/run_folder.hpp"
#include "board/star.hpp"
#include "drivers/replay/camera_folder.hpp"

namespace lxd {

class RunOutput {
 public:
  // Errors: the folder is something else, or cannot be written. `extraction` outlives the output.
  static Result<RunOutput> create(const std::filesystem::path& out, const Configuration& configuration,
                                  const Star& star, MeshExtraction& extraction,
                                  const std::optional<EarlierMap>& earlier, BackEndPace pace);

  // A sweep that the filter took: its pose, as that of the rig's reference, and its points. Error: something had no
  // room; the next call tries again, so that a run goes on without and has its files when there is room.
  // sub_mesh_begin: of the one that it went into.
  Status publish(const SweepOutcome& outcome, RigTime sub_mesh_begin);
  // An image ahead of the next sweep; nothing becomes of it where no colours are told.
  void offer(ColourOffer offer);
  // A recorded image as such an offer; none: it has no colours, or nobody tells them. Any thread.
  [[nodiscard]] std::optional<ColourOffer> offer_of(const CameraImage& image, RigTime instant) const;
  // The camera that colours are told by; null: none are.
  [[nodiscard]] const ColourCamera* colour_camera() const;
  // No sweep comes any more.
  void at_leisure();
  // The filter begins again; all its sub-meshes are stored.
  void begin_again();
  // A sub-mesh that left the window, or is in it at the end; what had no room in it is counted.
  // The keeper is shown its surface.
  Status store(const SubMesh& sub_mesh, Report& report, MapKeeper& keeper);
  // What is made of the whole map. Error: the first failure; what can be written is written all the same.
  Status finish_map(const CorrectedPath& corrections);
  // What is in the report of the map itself; after finish_map().
  void write(Report& report) const;
  Status write_report(const Report& report) const;

  [[nodiscard]] std::span<const StampedPose> poses() const { return path_.poses(); }

 private:
  RunOutput(RunFolder folder, PathWriter path, MapSink map_sink, const Pose& T_body_reference,
            MeshExtraction& extraction);

  RunFolder folder_;
  PathWriter path_;
  MapSink map_sink_;
  Pose T_body_reference_;
  MeshExtraction* extraction_;
};

// The first failure of several, whatever comes after it.
void keep_first(Status& first, Status status);

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// Where a run's map goes: sub-meshes that left the filter's window into the archive, the thinned registered points into
// the cloud, and at the end the mesh and the picture that are made of them. Low priority; never the real-time path.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "backend/archive.hpp"
#include "backend/cloud.hpp"
#include "backend/graph/corrected_path.hpp"
#include "board/map_beams.hpp"
#include "board/map_colours.hpp"
#include "board/map_keeper.hpp"
#include "board/run_folder.hpp"
#include "estimator/sweep_outcome.hpp"
#include "mapping/mesh_extraction.hpp"

namespace lxd {

class MapSink {
 public:
  // `extraction` outlives the sink; its storage is the arena's. With an earlier map the sub-meshes' numbers go on where
  // its end; a run that only localises keeps nothing but its path.
  static Result<MapSink> create(const RunFolder& folder, const Configuration& configuration, const Star& star,
                                MeshExtraction& extraction, const std::optional<EarlierMap>& earlier, BackEndPace pace);

  // Kept, and then shown to the keeper, in the filter's world.
  Status append(const SubMesh& sub_mesh, MapKeeper& keeper);
  // The points that a sweep's outcome hands over, at its stamp. sub_mesh_begin: of the one that it went into.
  Status append(const SweepOutcome& outcome, RigTime sub_mesh_begin);
  // Moves all to where the graph has it and writes what is made of the whole: the final path, mesh.ply, overview.png;
  // closes the archive and the cloud, whose points get their surfaces. What can be written is written whatever fails.
  // `path` is the filter's. Error: the first failure.
  Status finish(const RunFolder& folder, std::span<const StampedPose> path, const CorrectedPath& corrections);

  // Null: the map has none.
  [[nodiscard]] MapColours* colours() const { return colours_.get(); }

 private:
  MapSink(ArchiveWriter archive, std::optional<CloudWriter> cloud, MapBeams beams, double cell_size_m,
          MeshExtraction& extraction);

  MeshExtraction::Mesh extract(const SubMesh& sub_mesh, Status& kept);
  [[nodiscard]] bool keeps_map() const { return cloud_.has_value(); }
  Status finish_archive(std::span<const StampedPose> corrected, const CorrectedPath& corrections);
  Status add_earlier();
  Status add_cloud_surfaces(const RunFolder& folder, std::span<const StampedPose> path) const;

  ArchiveWriter archive_;
  std::optional<CloudWriter> cloud_;  // none: the run only localises
  MapBeams beams_;
  double cell_size_m_;
  MeshExtraction* extraction_;
  std::unique_ptr<MapColours> colours_;
  std::vector<Eigen::Vector3d> lidars_;  // in the reference, which the path is of
  std::vector<CloudPoint> points_;       // of one sweep, reused
  struct Stored {
    RigTime begin;
    Pose T_world;
  };
  Status move_sub_meshes(const CorrectedPath& corrections);

  std::vector<Stored> sub_meshes_;  // from first_id_ on
  std::optional<EarlierMap> earlier_;
  std::int64_t first_id_ = 0, session_ = 0;
};

}  // namespace lxd

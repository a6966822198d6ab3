// SPDX-License-Identifier: Apache-2.0
// Where a run's map goes: sub-meshes that left the filter's window into the archive, the thinned registered points into
// the cloud, and at the end the mesh and the picture that are made of them. Low priority; never the real-time path.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "backend/archive.hpp"
#include "backend/cloud.hpp"
#include "backend/graph/corrected_path.hpp"
#include "board/run_folder.hpp"
#include "estimator/sweep_outcome.hpp"
#include "mapping/mesh_extraction.hpp"

namespace lxd {

using SubmeshObserver = std::function<void(const SubmeshView&)>;

class MapSink {
 public:
  // `extraction` outlives the sink; its storage is the arena's.
  static Result<MapSink> create(const RunFolder& folder, double cell_size_m, MeshExtraction& extraction);

  // `see` is shown the surface, in the filter's world.
  Status append(const SubMesh& sub_mesh, const SubmeshObserver& see);
  // The points that a sweep's outcome hands over, at its stamp.
  Status append(const SweepOutcome& outcome);
  // Moves all to where the graph has it and writes what is made of the whole: the final path, mesh.ply, overview.png;
  // closes the archive and the cloud. What can be written is written whatever fails. `path` is the filter's. Error: the
  // first failure.
  Status finish(const RunFolder& folder, std::span<const StampedPose> path, const CorrectedPath& corrections);

 private:
  MapSink(ArchiveWriter archive, CloudWriter cloud, double cell_size_m, MeshExtraction& extraction);

  ArchiveWriter archive_;
  CloudWriter cloud_;
  double cell_size_m_;
  MeshExtraction* extraction_;
  std::vector<CloudPoint> points_;  // of one sweep, reused
  struct Stored {
    RigTime begin;
    Pose T_world;
  };
  Status move_sub_meshes(const CorrectedPath& corrections);

  std::vector<Stored> sub_meshes_;  // by their ids
};

}  // namespace lxd

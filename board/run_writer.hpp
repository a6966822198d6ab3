// SPDX-License-Identifier: Apache-2.0
// What becomes of the sweeps that the filter took, replayed or live: they go to the back-end and into the run's files,
// and the report tells of them. Low priority; one thread at a time, which need not be the filter's.
#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "board/map_keeper.hpp"
#include "board/report.hpp"
#include "board/run_output.hpp"
#include "board/tracking_log.hpp"

namespace lxd {

class RunWriter {
 public:
  RunWriter(const Configuration& configuration, const Star& star, BackEndPace pace);

  // First: the map that the run continues. Error: it cannot be.
  Status remember(const EarlierMapRequest& request, const std::filesystem::path& out);
  // Then: the run's folder. `extraction` outlives the writer. Error: it is something else, or cannot be written.
  Status create(const std::filesystem::path& out, const Configuration& configuration, const Star& star,
                MeshExtraction& extraction);

  // A sweep that the filter took, in order, and before it the fixes up to its end. Error: something had no room; it is
  // tried again with the next one.
  void take(const GnssFix& fix, Duration shift) { keeper_.take(fix, shift); }
  Status take(const SweepOutcome& outcome, const FilterView& view);
  // A sub-mesh that left the window; all that are in it.
  Status store(const SubMesh& sub_mesh) { return output_->store(sub_mesh, report_, keeper_); }
  Status store_window(const SurfaceMap& map);
  // The same when no sweep comes any more: nothing of these is left out for want of time.
  Status store_last_window(const SurfaceMap& map);
  // The filter begins again; all its sub-meshes are stored.
  void begin_again();

  // What is made of the whole, when all sub-meshes are stored.
  Status finish_map();
  // Then the report, when all else is in it.
  Status write_report();

  [[nodiscard]] Report& report() { return report_; }
  [[nodiscard]] const Report& report() const { return report_; }
  // Any thread: whom images are offered to.
  [[nodiscard]] SightImages* sight_images() { return keeper_.sight_images(); }
  [[nodiscard]] RunOutput& output() { return *output_; }
  // Of all sweeps that were taken.
  [[nodiscard]] std::span<const StampedPose> poses() const { return output_->poses(); }

 private:
  BackEndPace pace_;
  std::optional<EarlierMap> earlier_;
  std::optional<RunOutput> output_;
  MapKeeper keeper_;
  TrackingLog tracking_;
  Report report_;
};

}  // namespace lxd

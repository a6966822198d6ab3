// SPDX-License-Identifier: Apache-2.0
// The back-end's side of a run: cuts key frames out of the filter's path, hands them and the fixes of GNSS to the
// graph, and knows in the end where everything belongs. The filter hears nothing of it. Each time the filter begins
// again the path is another piece, in a frame of its own until it is found in what is finished: an earlier session's
// map or an earlier piece. One thread, beside the graph's own.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <semaphore>
#include <vector>

#include "backend/graph/corrected_path.hpp"
#include "backend/graph/smooth_correction.hpp"
#include "board/configuration.hpp"
#include "board/earlier_map.hpp"
#include "board/gnss_intake.hpp"
#include "board/graph_worker.hpp"
#include "board/key_frame_cutter.hpp"
#include "board/loop_closer.hpp"
#include "board/report.hpp"
#include "board/sight_intake.hpp"
#include "estimator/odometry.hpp"

namespace lxd {

// What the keeper must know of the filter besides a sweep's outcome, as it was then.
struct FilterView {
  RigTime sub_mesh_begin;  // of the sub-mesh that new points go into: its first sweep
  Eigen::Vector3d gravity_mps2 = Eigen::Vector3d::Zero();
  SightedImage sighted;  // of a camera in use, in the time of the sweep
};
FilterView view_of(const Odometry& odometry);

// Where loops are searched for and the graph is solved: within the calls; in a thread beside them, with the same
// result; or there and never waited for, with searches left out when it is too far behind.
enum class BackEndPace : std::uint8_t { within, beside, live };

class MapKeeper {
 public:
  MapKeeper(const Configuration& configuration, const Star& star, BackEndPace pace);

  // An earlier session's map, before the first sweep: what is found in it is in its frame. Error: it cannot be read.
  Status remember(const EarlierMap& earlier);

  // Fixes up to the end of the sweep that comes next; `shift` is added to their stamps.
  void take(const GnssFix& fix, Duration shift);
  // A sweep that the filter took, before the next step. The key frame that was cut from it, if one was.
  std::optional<KeyFrame> take(const SweepOutcome& outcome, const FilterView& view);
  // Where images go that may show places again; null: no camera is in use, or nobody asks.
  [[nodiscard]] SightImages* sight_images() { return sight_ ? &sight_->images() : nullptr; }
  // The key frames of a sub-mesh that nothing more goes into, in the filter's world; before it is taken.
  [[nodiscard]] std::vector<SubmeshKeyFrame> key_frames_of(const SubmeshView& sub_mesh) const;
  // That sub-mesh: loops that it closes go to the graph.
  void take(const SubmeshView& sub_mesh);

  // The filter begins again at zero, all its sub-meshes are taken: what comes is another piece.
  void begin_again();
  // Solves the graph to the end. Then corrections() are complete.
  void finish();

  [[nodiscard]] const CorrectedPath& corrections() const { return corrections_; }
  // What takes the filter's world to the map now; without leaps. At the sweep taken last.
  [[nodiscard]] const MapCorrection& correction() const { return correction_; }

  // After finish(): loops, fixes, and what they cost.
  void write(Report& report) const;

 private:
  struct Piece {
    int map;  // whose frame it is in
    std::uint64_t key_frames;
    std::uint64_t places;          // that put it there; 0: its own
    std::optional<RigTime> found;  // when it was there first
  };
  void correct(const SweepOutcome& outcome);
  void look(const std::optional<KeyFrame>& frame, const SightedImage& sighted);
  template <typename Room>
  [[nodiscard]] bool find_room(Room& room);
  void close(const LoopCloser::Closed& closed, PoseGraph& graph);
  int close();
  void count_rejected(const PoseGraph& graph);
  void note_loops(const PoseGraph& graph);
  [[nodiscard]] int main_map() const;
  void write_map(Report& report) const;
  void write_sight(Report& report) const;

  GraphConfig config_;
  BackEndPace pace_;
  bool feels_gravity_;
  KeyFrameCutter cutter_;
  std::unique_ptr<LoopCloser> closer_;  // the worker's, while there is one at work
  // Of sub-meshes that wait for their search: 320 m of way at 40 m each, some 16 MB.
  static constexpr int kSearchesMax = 8;
  std::counting_semaphore<kSearchesMax> room_{kSearchesMax};
  // Of images that wait to be described: 16 m of way, some 2.5 MB.
  static constexpr int kLooksMax = 8;
  std::counting_semaphore<kLooksMax> looks_room_{kLooksMax};
  std::optional<SightIntake> sight_;  // none: no camera is in use, or nobody asks
  std::optional<GnssIntake> gnss_;
  std::unique_ptr<GraphWorker> worker_;
  CorrectedPath corrections_;
  std::optional<EarlierMap> earlier_;
  std::vector<Piece> pieces_;  // that are closed
  bool in_finished_map_ = false;
  SmoothCorrection smooth_;
  MapCorrection correction_;
  struct Previous {
    RigTime stamp;
    Pose T_world_body;
  };
  std::optional<Previous> previous_;  // sweep
  std::deque<KeyFrame> noted_;        // whose sub-meshes are not finished
  std::uint64_t unsought_ = 0;        // sub-meshes whose loops were left out
  std::uint64_t unlooked_ = 0;        // key frames whose images were
  BackEndCounts counts_;
  Report::Counts loops_rejected_, fixes_rejected_;
  std::vector<LoopMeasurement> found_;  // of this piece; the worker's, while there is one at work
  std::vector<ClosedLoop> loops_;       // of the pieces that are closed
};

}  // namespace lxd

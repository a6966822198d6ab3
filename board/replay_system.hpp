// SPDX-License-Identifier: Apache-2.0
// A replay, wired: recording, sweep buffers, odometry, run folder. What the command line and the tests drive. At the
// recording's pace a thread of its own writes the run, as on the rig; else the caller's does it between two sweeps.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "board/configuration.hpp"
#include "board/lost_watch.hpp"
#include "board/mutes.hpp"
#include "board/real_time_meter.hpp"
#include "board/report.hpp"
#include "board/run_writer.hpp"
#include "board/sensor_streams.hpp"
#include "board/slam_core.hpp"
#include "board/sub_mesh_loan.hpp"
#include "board/sweep_feed.hpp"
#include "board/sweep_gaps.hpp"
#include "board/task_thread.hpp"
#include "drivers/replay/source.hpp"

namespace lxd {

struct ReplayRequest {
  std::filesystem::path recording;
  std::optional<std::filesystem::path> rig;
  std::optional<SensorSet> sensors;  // none: all that rig and recording have
  std::filesystem::path out;
  bool realtime = false;
  std::vector<std::string> choices;  // key=value
  std::vector<Mute> mutes;
  EarlierMapRequest map;
};

struct ReplayProgress {
  std::uint64_t sweeps = 0;            // taken through the filter
  std::optional<std::uint64_t> total;  // in the recording
  std::uint64_t dropped = 0;           // late, or refused by the filter
  std::uint64_t untracked = 0;         // sweeps that did not hold the pose
  double recorded_s = 0;               // of the recording, played
  double elapsed_s = 0;                // on the wall
  std::string unwritten;               // what could not be written, when that began; mapping goes on
};
// Called by the thread that writes, after each sweep.
using ReplayObserver = std::function<void(const ReplayProgress&)>;

class ReplaySystem {
 public:
  // Opens everything and cuts all memory out of `arena`. Errors are the caller's to mend: settings, rig, recording, the
  // run's folder, a rig that does not fit. The run's folder is touched only when all else is sound.
  static Result<std::unique_ptr<ReplaySystem>> open(const ReplayRequest& request, Arena& arena);

  // Plays the recording to its end, or until `stop` becomes true; both leave a complete run. An error (damaged
  // recording, not one usable sweep) leaves what was mapped so far; a full disk is an error in the end. Once.
  Status run(const ReplayObserver& observe, const std::atomic<bool>& stop);

  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }
  [[nodiscard]] const SensorSet& sensors() const { return configuration_.sensors; }
  [[nodiscard]] const Report& report() const { return writer_.report(); }

 private:
  ReplaySystem(const ReplayRequest& request, Configuration configuration, const Star& star,
               std::unique_ptr<SweepSource> source, SensorStreams streams, Arena& arena);

  Status create_writer(const ReplayRequest& request);
  void make_resident();
  void show_images();
  std::unique_ptr<SweepFeed> make_feed(const std::atomic<bool>& stop);
  Status play_all(const ReplayObserver& observe, const std::atomic<bool>& stop);
  Status play_once(const ReplayObserver& observe, const std::atomic<bool>& stop);
  Status begin_again();
  void forget();
  Status play(SweepFeed& feed, const ReplayObserver& observe, const std::atomic<bool>& stop);
  Status take(Sweep& sweep);
  Status step(const Sweep& sweep);
  // The pose through the sweeps that are missing before `begin`; until nothing carries it.
  Status carry_to(RigTime begin);
  Status carry_on(const std::atomic<bool>& stop);
  Status carry(const Sweep& missing);
  // Work of the thread that writes, or done at once.
  void write(TaskThread::Task task);
  void await_written();
  void write(const SweepOutcome& outcome);
  void collect_retired();
  void tell(const ReplayObserver& observe, const SweepFeed& feed);
  Status finish();
  void fill_report(Report& report);
  [[nodiscard]] Status check_used() const;
  void count_rejections();
  Status count_other_sensors();
  [[nodiscard]] bool wants_more() const;

  Configuration configuration_;
  std::filesystem::path recording_;
  bool realtime_ = false;
  Star star_;
  std::unique_ptr<SweepSource> source_;
  SensorStreams streams_;
  SlamCore core_;
  std::vector<std::string> remarks_;
  RealTimeMeter meter_;
  LostWatch lost_;
  SweepGaps gaps_;
  SubMeshLoan loan_;
  Report counted_;                // of which only sweeps, dropped ones and pools are filled
  std::optional<RigTime> begin_;  // of the first sweep
  RigTime end_;                   // of the last
  Duration loop_shift_;           // added to the stamps of this loop
  std::uint64_t loop_sweeps_ = 0;
  std::uint64_t late_ = 0;  // sweeps, of the loops before this one
  std::chrono::steady_clock::time_point started_;

  // The writing thread's while there is one, but when nothing is left for it to do.
  RunWriter writer_;
  Status written_ = success();         // the first thing that could not be
  bool told_ = false;                  // that there was one
  std::optional<TaskThread> writing_;  // last: ends before what it works on
};

}  // namespace lxd

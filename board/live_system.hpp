// SPDX-License-Identifier: Apache-2.0
// A live rig, wired. One thread reads all devices and makes samples of their bytes; the real-time thread takes sweeps
// through the filter; the caller's thread keeps house: it writes the run, watches sensors and threads, tells progress.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "board/configuration.hpp"
#include "board/event_log.hpp"
#include "board/io_loop.hpp"
#include "board/live_intake.hpp"
#include "board/lost_watch.hpp"
#include "board/outcome_mail.hpp"
#include "board/real_time_meter.hpp"
#include "board/run_writer.hpp"
#include "board/slam_core.hpp"
#include "board/sub_mesh_loan.hpp"
#include "board/sweep_gaps.hpp"
#include "board/thread_watch.hpp"

namespace lxd {

struct LiveRequest {
  std::filesystem::path rig, out;
  std::optional<SensorSet> sensors;  // none: all that have a wire
  std::vector<std::string> choices;  // key=value
  std::optional<Duration> duration;  // none: until told to stop
  std::optional<UdpEndpoint> poses;  // who is told the pose at every reading of the IMU
  LiveKernel kernel{};
  EarlierMapRequest map;
};

struct LiveProgress {
  std::uint64_t sweeps = 0;     // taken through the filter
  std::uint64_t dropped = 0;    // late, or refused by the filter
  std::uint64_t untracked = 0;  // sweeps that did not hold the pose
  double elapsed_s = 0;
  std::string silent;            // sensors that are not heard
  std::vector<RigEvent> events;  // since the last time
};
using LiveObserver = std::function<void(const LiveProgress&)>;

class LiveSystem {
 public:
  // Errors are the caller's to mend: settings, the rig file, a port, the run's folder, a rig that does not fit.
  static Result<std::unique_ptr<LiveSystem>> open(const LiveRequest& request, Arena& arena);

  // Until `stop` becomes true or the duration is over; leaves a complete run. Error: a full disk, or not one usable
  // sweep. Once.
  Status run(const LiveObserver& observe, const std::atomic<bool>& stop);

  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }
  [[nodiscard]] const SensorSet& sensors() const { return configuration_.sensors; }
  [[nodiscard]] const Report& report() const { return writer_.report(); }

 private:
  LiveSystem(const LiveRequest& request, Configuration configuration, LiveRig live, const Star& star,
             std::unique_ptr<HostClock> clock, std::unique_ptr<PosePort> poses, Arena& arena);

  Status create(const LiveRequest& request);
  void make_resident();

  // The reading thread's.
  void read_devices();

  // The vision thread's.
  void watch_camera();

  // The real-time thread's.
  void run_filter();
  [[nodiscard]] std::optional<SweepIndex> newest_sweep();
  void await_inertial(RigTime until);
  void take(const Sweep& sweep);
  void carry_to(RigTime begin);
  [[nodiscard]] const SweepOutcome& step(const Sweep& sweep);
  void begin_again();

  // The caller's thread's.
  void keep_house_until(const LiveObserver& observe, const std::atomic<bool>& stop);
  bool write_waiting();
  void store_piece();
  void write(const KeptOutcome& letter);
  void note_written(Status status);
  void look_after(const LiveObserver& observe);
  [[nodiscard]] LiveProgress progress();
  Status finish(bool interrupted);
  void fill_report(Report& report);

  Configuration configuration_;
  LiveRig live_;
  Star star_;
  std::optional<Duration> duration_;
  std::unique_ptr<HostClock> clock_;
  SlamCore core_;
  std::vector<std::string> remarks_;
  EventLog events_;
  SensorWatch watch_;
  std::optional<LiveVision> vision_;
  std::unique_ptr<PosePort> poses_;  // null: nobody is told
  LiveIntake intake_;
  SensorStreams streams_;
  std::optional<IoLoop> io_, camera_io_;
  OutcomeMail mail_;
  SubMeshLoan loan_;
  ThreadWatch threads_;
  RunWriter writer_;
  Status written_ = success();  // the first failure
  RigTime begin_, next_look_;
  std::size_t events_told_ = 0;
  std::atomic<bool> stopping_{false};

  // A filter that is lost asks for its window to be stored, lets sweeps go until it is, and begins again.
  enum class Beginning : std::uint8_t { none, asked, stored };
  std::atomic<Beginning> beginning_{Beginning::none};

  // Written by the real-time thread; read by others only where atomic, or when it has ended.
  RealTimeMeter meter_;
  SweepGaps gaps_;
  LostWatch lost_;
  LatencyHistogram latency_;  // from a sweep's end to its pose
  Report pools_;              // of which only the pools are filled
  std::atomic<std::uint64_t> sweeps_{0}, late_{0}, time_backwards_{0}, too_few_points_{0}, unwritten_{0}, overruns_{0},
      lost_sweeps_{0};
  std::optional<RigTime> first_begin_;
  RigTime last_end_;
};

}  // namespace lxd

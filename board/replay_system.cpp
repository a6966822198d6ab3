// SPDX-License-Identifier: Apache-2.0
#include "board/replay_system.hpp"

#include <algorithm>
#include <cstring>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "board/core_report.hpp"
#include "board/default/threads.hpp"
#include "board/kept_outcome.hpp"
#include "board/memory.hpp"
#include "board/recorded_sensors.hpp"
#include "drivers/replay/open.hpp"
#include "rt/prefault.hpp"

namespace lxd {
namespace {

constexpr Duration kOutlived = Duration::from_ns(500'000'000);
constexpr Duration kPauseBetweenLoops = Duration::from_ns(100'000'000);
constexpr std::size_t kRealTimeStackBytes = 512 * 1024;  // of the estimator's thread, made resident before it starts
constexpr std::size_t kUnwrittenMax = 128;  // tasks of the thread that writes: 3 s that a disk may stand still

ReplayOptions options_of(const Configuration& configuration) {
  const double angle_deg = configuration.settings.replay.kitti_vertical_angle_deg;
  return {pulsed_sensors(configuration.rig), angle_deg * std::numbers::pi / 180};
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

BackEndPace pace_of(const Configuration& configuration, bool realtime) {
  if (realtime) return BackEndPace::live;
  return configuration.settings.threads > 1 ? BackEndPace::beside : BackEndPace::within;
}

}  // namespace

Result<std::unique_ptr<ReplaySystem>> ReplaySystem::open(const ReplayRequest& request, Arena& arena) {
  return_large_blocks();
  auto configuration = configure(request.recording, request.rig, request.choices);
  if (!configuration) return configuration.error();
  configuration->sensors = request.sensors.value_or(recorded_sensors(request.recording, configuration->rig));
  auto source = open_recording(request.recording, options_of(*configuration));
  if (!source) return source.error();
  complete_by(*configuration, (*source)->traits());
  if (request.realtime) keep_pace(*configuration);
  const auto star = resolve_star(configuration->rig, configuration->sensors);
  if (!star) return star.error();
  auto streams = SensorStreams::open(request.recording, configuration->rig, configuration->sensors, *star);
  if (!streams) return streams.error();

  std::unique_ptr<ReplaySystem> system(
      new ReplaySystem(request, std::move(*configuration), *star, std::move(*source), std::move(*streams), arena));
  const Status fits = check_fits(arena);
  if (!fits) return fits.error();
  const Status created = system->create_writer(request);
  if (!created) return created.error();
  system->make_resident();
  return system;
}

ReplaySystem::ReplaySystem(const ReplayRequest& request, Configuration configuration, const Star& star,
                           std::unique_ptr<SweepSource> source, SensorStreams streams, Arena& arena)
    : configuration_(std::move(configuration)),
      recording_(request.recording),
      realtime_(request.realtime),
      star_(star),
      source_(std::move(source)),
      streams_(std::move(streams)),
      core_(configuration_, star_, arena),
      remarks_(configuration_.remarks),
      lost_(configuration_.settings.lost_after_s),
      writer_(configuration_, star_, pace_of(configuration_, realtime_)) {
  streams_.mute(Mutes(request.mutes));
  std::ranges::copy(source_->notes(), std::back_inserter(remarks_));
}

// Memory that cannot be pinned may be taken away later; that only matters to a run that must keep pace.
void ReplaySystem::make_resident() {
  const auto resident = prefault_process();
  if (!resident) {
    remarks_.push_back(resident.error().message);
  } else if (realtime_ && !resident->locked) {
    remarks_.push_back(fmt::format("memory is not locked: {} (see ulimit -l)", std::strerror(resident->lock_errno)));
  }
}

Status ReplaySystem::create_writer(const ReplayRequest& request) {
  Status ready = writer_.remember(request.map, request.out);
  if (!ready) return ready;
  ready = writer_.create(request.out, configuration_, star_, core_.mesh_extraction());
  if (!ready) return ready;
  show_images();
  if (realtime_) writing_.emplace(threads::kHousekeeping);
  return success();
}

// To those who tell colours by them, and to those who know places by them.
void ReplaySystem::show_images() {
  streams_.listen([this](const CameraImage& image, RigTime instant) {
    if (const auto offer = writer_.output().offer_of(image, instant))
      write([this, offer = *offer] { writer_.output().offer(offer); });
    if (SightImages* const images = writer_.sight_images()) images->offer(image.pixels, instant);
  });
}

std::unique_ptr<SweepFeed> ReplaySystem::make_feed(const std::atomic<bool>& stop) {
  const bool ahead = realtime_ || configuration_.settings.threads > 1;
  if (!ahead) return std::make_unique<DirectFeed>(*source_, core_.sweeps());
  return std::make_unique<AheadFeed>(*source_, core_.sweeps(), realtime_, stop);
}

Status ReplaySystem::run(const ReplayObserver& observe, const std::atomic<bool>& stop) {
  prefault_stack(kRealTimeStackBytes);
  started_ = std::chrono::steady_clock::now();
  Status first = play_all(observe, stop);
  const double elapsed_s = seconds_since(started_);
  await_written();
  Report& report = writer_.report();
  report.interrupted = stop;
  if (begin_) report.duration_s = (end_ - *begin_).seconds();
  if (elapsed_s > 0) report.real_time_factor = report.duration_s / elapsed_s;
  keep_first(first, written_);
  keep_first(first, finish());
  if (!stop) keep_first(first, check_used());
  return first;
}

Status ReplaySystem::play_all(const ReplayObserver& observe, const std::atomic<bool>& stop) {
  for (int loop = 1;; ++loop) {
    Status played = play_once(observe, stop);
    if (!played || stop || loop == configuration_.settings.replay.loops) return played;
    Status again = begin_again();
    if (!again) return again;
  }
}

// The feed ends before the source that it reads.
Status ReplaySystem::play_once(const ReplayObserver& observe, const std::atomic<bool>& stop) {
  const std::unique_ptr<SweepFeed> feed = make_feed(stop);
  Status played = play(*feed, observe, stop);
  late_ += feed->late();
  return played;
}

// The map so far is stored; the recording is opened once more, and its stamps go on where the last loop's ended.
Status ReplaySystem::begin_again() {
  forget();
  gaps_.restart();
  count_rejections();
  auto source = open_recording(recording_, options_of(configuration_));
  if (!source) return source.error();
  source_ = std::move(*source);
  auto streams = SensorStreams::open(recording_, configuration_.rig, configuration_.sensors, star_);
  if (!streams) return streams.error();
  streams->mute(streams_.mutes());
  streams_ = std::move(*streams);
  show_images();
  if (begin_) loop_shift_ = end_ - *begin_ + kPauseBetweenLoops;
  loop_sweeps_ = 0;
  return success();
}

// The filter begins anew; what it had is stored, and what comes may be found in it.
void ReplaySystem::forget() {
  await_written();
  (void)loan_.exchange(core_.odometry().map());
  keep_first(written_, writer_.store_window(core_.odometry().map()));
  core_.odometry().restart();
  writer_.begin_again();
  lost_.begin_again();
}

// A recording of which nothing could be used is a failure, not an empty success.
Status ReplaySystem::check_used() const {
  if (!writer_.poses().empty()) return success();
  return Error{fmt::format("{}: found no sweep that could be used ({})", recording_.string(), losses_text(report()))};
}

Status ReplaySystem::play(SweepFeed& feed, const ReplayObserver& observe, const std::atomic<bool>& stop) {
  while (!stop && wants_more()) {
    const auto index = feed.next();
    if (!index) return feed.status() ? carry_on(stop) : feed.status();
    const Status taken = take(core_.sweeps()[*index]);
    feed.give_back(*index);
    if (!taken) return taken;
    tell(observe, feed);
  }
  return success();
}

Status ReplaySystem::take(Sweep& sweep) {
  for (RigTime* const stamp : {&sweep.begin, &sweep.end, &sweep.stamp}) *stamp = *stamp + loop_shift_;
  if (!begin_) begin_ = sweep.begin;
  streams_.mutes().begin(*begin_);
  ++counted_.sweeps;
  ++loop_sweeps_;
  Status carried = carry_to(sweep.begin);
  if (!carried) return carried;
  if (streams_.mutes().silent("lidar0", sweep.begin)) {
    ++counted_.dropped["muted"];
    return success();
  }
  gaps_.came(sweep);
  Status stepped = step(sweep);
  if (core_.odometry().outcome().rejection != SweepRejection::none)
    ++counted_.dropped[name_of(core_.odometry().outcome().rejection)];
  return stepped;
}

// A sweep, or one that is missing, through the filter; what the filter rejects is published by nobody.
Status ReplaySystem::step(const Sweep& sweep) {
  end_ = sweep.end;
  streams_.feed(core_.odometry(), sweep.end, loop_shift_);
  streams_.feed_fixes(sweep.end, loop_shift_, [this](const GnssFix& fix) {
    write([this, fix, shift = loop_shift_] { writer_.take(fix, shift); });
  });
  const SweepOutcome& outcome = meter_.measure([&]() -> const SweepOutcome& { return core_.odometry().step(sweep); });
  streams_.note(sweep, core_.odometry(), star_);
  count_pools(core_, counted_);
  if (outcome.rejection != SweepRejection::none) return success();
  meter_.add(outcome.times);
  write(outcome);
  collect_retired();
  if (lost_.lost(outcome)) forget();
  return success();
}

Status ReplaySystem::carry_to(RigTime begin) {
  while (const auto missing = gaps_.missing(begin)) {
    Status carried = carry(*missing);
    if (!carried) return carried;
  }
  return success();
}

// Sensors end at their own times; only one that goes on for long has outlived the LiDAR.
Status ReplaySystem::carry_on(const std::atomic<bool>& stop) {
  if (!streams_.outlast(core_.odometry(), end_ + kOutlived, loop_shift_)) return success();
  while (!stop) {
    const auto missing = gaps_.next();
    if (!missing) break;
    Status carried = carry(*missing);
    if (!carried) return carried;
  }
  return success();
}

Status ReplaySystem::carry(const Sweep& missing) {
  gaps_.carried(missing);
  Status stepped = step(missing);
  if (core_.odometry().outcome().rejection != SweepRejection::none) gaps_.give_up();
  return stepped;
}

void ReplaySystem::write(TaskThread::Task task) {
  if (!writing_) return task();
  writing_->wait_until_left(kUnwrittenMax);
  writing_->post(std::move(task));
}

void ReplaySystem::await_written() {
  if (writing_) writing_->wait_until_left(0);
}

void ReplaySystem::write(const SweepOutcome& outcome) {
  const FilterView view = view_of(core_.odometry());
  if (!writing_) return keep_first(written_, writer_.take(outcome, view));
  const auto kept = std::make_shared<KeptOutcome>(outcome.registered.size());
  kept->keep(outcome, view);
  write([this, kept] { keep_first(written_, writer_.take(kept->outcome(), kept->view())); });
}

// What is stored at once is taken back at once.
void ReplaySystem::collect_retired() {
  SurfaceMap& map = core_.odometry().map();
  if (!loan_.exchange(map)) return;
  write([this] {
    keep_first(written_, writer_.store(*loan_.lent()));
    loan_.stored();
  });
  (void)loan_.exchange(map);
}

}  // namespace lxd

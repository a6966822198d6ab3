// SPDX-License-Identifier: Apache-2.0
// The two threads that LiveSystem starts: the one that reads devices and the one that filters.
#include <algorithm>
#include <chrono>
#include <thread>

#include "board/core_report.hpp"
#include "board/default/threads.hpp"
#include "board/live_system.hpp"

namespace lxd {
namespace {

constexpr std::chrono::milliseconds kLongestWait{50};  // for a sweep, between two looks whether to stop
// Readings of the IMU come later than the sweep that they belong to, by what its line and the host take. So much is
// waited for them, if they come at all.
constexpr Duration kInertialWait = Duration::from_ns(30'000'000);
constexpr std::chrono::milliseconds kInertialLook{1};

}  // namespace

void LiveSystem::read_devices() {
  place_this_thread(threads::kInput);
  while (!stopping_) {
    io_->turn(intake_);
    threads_.round(WatchedThread::input, clock_->now());
  }
}

// Images that wait for their trigger or for the IMU are looked at again soon.
void LiveSystem::watch_camera() {
  constexpr int kSoon_ms = 2;
  place_this_thread(threads::kVision);
  while (!stopping_) {
    camera_io_->turn(*vision_, vision_->waiting() ? kSoon_ms : IoLoop::kLongestWait_ms);
    vision_->turn();
  }
}

void LiveSystem::run_filter() {
  place_this_thread(threads::kFilter);
  count_pools(core_, pools_);  // makes their entries
  const Duration period = Duration::from_seconds(1 / configuration_.rig.lidar0.rate_hz);
  while (!stopping_) {
    threads_.round(WatchedThread::filter, clock_->now());
    const auto index = newest_sweep();
    if (beginning_ != Beginning::none) {
      if (index) core_.sweeps().release(*index);
      lost_sweeps_ += index ? 1 : 0;
      begin_again();
      (void)loan_.exchange(core_.odometry().map());
      continue;
    }
    // What is to come begins later than two periods ago, one for the sweep itself and one for its way.
    carry_to(index ? core_.sweeps()[*index].begin : clock_->now() - period * 2);
    if (index) {
      take(core_.sweeps()[*index]);
      core_.sweeps().release(*index);
    }
    (void)loan_.exchange(core_.odometry().map());
  }
}

// The newest that waits wins.
std::optional<SweepIndex> LiveSystem::newest_sweep() {
  if (!intake_.wait_for_sweep(kLongestWait)) return std::nullopt;
  auto newest = intake_.pop_sweep();
  while (newest && intake_.wait_for_sweep(std::chrono::milliseconds(0))) {
    const auto newer = intake_.pop_sweep();
    if (!newer) break;
    core_.sweeps().release(*newest);
    ++late_;
    newest = newer;
  }
  return newest;
}

// A sensor that is silent is not waited for: its last reading is long ago.
void LiveSystem::await_inertial(RigTime until) {
  const RigTime deadline = clock_->now() + kInertialWait;
  const Motion& motion = core_.odometry().motion();
  streams_.feed(core_.odometry(), until, Duration());
  if (!configuration_.sensors.imu || until - motion.inertial_until() > SensorWatch::kShortestSilence) return;
  while (motion.inertial_until() < until && clock_->now() < deadline && !stopping_) {
    std::this_thread::sleep_for(kInertialLook);
    streams_.feed(core_.odometry(), until, Duration());
  }
}

// While the LiDAR is silent the other sensors carry the pose on, if they can.
void LiveSystem::carry_to(RigTime begin) {
  while (const auto missing = gaps_.missing(begin)) {
    gaps_.carried(*missing);
    if (step(*missing).rejection != SweepRejection::none) gaps_.give_up();
  }
}

void LiveSystem::take(const Sweep& sweep) {
  if (!first_begin_) first_begin_ = sweep.begin;
  ++sweeps_;
  gaps_.came(sweep);
  await_inertial(sweep.end);
  const RigTime begin = clock_->now();
  const SweepRejection rejection = step(sweep).rejection;
  const RigTime end = clock_->now();
  if ((end - begin).seconds() * configuration_.rig.lidar0.rate_hz > 1) ++overruns_;
  latency_.add(end - sweep.end);
  if (rejection == SweepRejection::time_backwards) ++time_backwards_;
  if (rejection == SweepRejection::too_few_points) ++too_few_points_;
}

// Its sub-meshes are stored by then. Until that the map must stay as it is.
void LiveSystem::begin_again() {
  if (beginning_.load(std::memory_order_acquire) != Beginning::stored) return;
  if (core_.odometry().map().retired() != nullptr) return;  // lent
  core_.odometry().restart();
  gaps_.restart();
  lost_.begin_again();
  beginning_ = Beginning::none;
}

// A sweep, or one that is missing, through the filter; what the filter rejects is published by nobody.
const SweepOutcome& LiveSystem::step(const Sweep& sweep) {
  last_end_ = sweep.end;
  streams_.feed(core_.odometry(), sweep.end, Duration());
  const SweepOutcome& outcome = meter_.measure([&]() -> const SweepOutcome& { return core_.odometry().step(sweep); });
  streams_.note(sweep, core_.odometry(), star_);
  count_pools(core_, pools_);
  if (outcome.rejection != SweepRejection::none) return outcome;
  // For the poses between this sweep and the next.
  if (poses_) poses_->leave(anchor_of(core_.odometry()), outcome.covariance);
  meter_.add(outcome.times);
  if (!mail_.post(outcome, view_of(core_.odometry()))) ++unwritten_;
  if (lost_.lost(outcome)) beginning_.store(Beginning::asked, std::memory_order_release);
  return outcome;
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
#include "board/live_system.hpp"

#include <algorithm>
#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "board/core_report.hpp"
#include "board/default/threads.hpp"
#include "board/memory.hpp"
#include "rt/prefault.hpp"

namespace lxd {
namespace {

// Of the sensors with a wire those that are wanted.
Result<SensorSet> chosen(const SensorSet& wired, const std::optional<SensorSet>& wanted) {
  if (!wanted) return wired;
  SensorSet both;
  both.extra_lidar = wired.extra_lidar && wanted->extra_lidar;
  both.camera = wired.camera && wanted->camera;
  both.imu = wired.imu && wanted->imu;
  both.wheel = wired.wheel && wanted->wheel;
  both.gnss = wired.gnss && wanted->gnss;
  if (both == *wanted) return both;
  return Error{fmt::format("--sensors: found {}, wanted sensors that have a wire in the rig file: {}", text_of(*wanted),
                           text_of(wired))};
}

LidarTraits traits_of(const LiveLidar& lidar) {
  if (!lidar.metadata) return {};
  return {lidar.metadata->format.pixels_per_column, lidar.metadata->columns_per_frame, lidar.metadata->rate_hz};
}

// What is not chosen has no device.
LiveRig with_sensors(LiveRig live, const SensorSet& sensors) {
  live.sensors = sensors;
  live.triggers = live.triggers && sensors.camera;
  if (!sensors.extra_lidar) live.lidars.resize(1);
  return live;
}

std::optional<LiveVision> vision_of(const LiveRig& live, const Star& star, SensorWatch& watch, const HostClock& clock) {
  const auto camera = camera_of(live.rig, star);
  if (!camera) return std::nullopt;
  return std::optional<LiveVision>(std::in_place, live.rig, *camera, live.sensors.imu, watch, clock);
}

// Null: nobody wants to be told.
Result<std::unique_ptr<PosePort>> pose_port_of(const LiveRequest& request, const SensorSet& sensors, const Star& star) {
  if (!request.poses) return std::unique_ptr<PosePort>();
  if (!sensors.imu) return Error{"--poses: found no IMU in use, wanted one: poses are told at its readings"};
  return PosePort::open(*request.poses, star);
}

}  // namespace

Result<std::unique_ptr<LiveSystem>> LiveSystem::open(const LiveRequest& request, Arena& arena) {
  return_large_blocks();
  auto configuration = configure({}, request.rig, request.choices);
  if (!configuration) return configuration.error();
  auto live = make_live(configuration->rig, request.rig.parent_path());
  if (!live) return live.error();
  const auto sensors = chosen(live->sensors, request.sensors);
  if (!sensors) return sensors.error();
  configuration->sensors = *sensors;
  complete_by(*configuration, traits_of(live->lidars.front()));
  keep_pace(*configuration);
  const auto star = resolve_star(configuration->rig, configuration->sensors);
  if (!star) return star.error();
  auto poses = pose_port_of(request, *sensors, *star);
  if (!poses) return poses.error();
  std::unique_ptr<LiveSystem> system(new LiveSystem(request, std::move(*configuration),
                                                    with_sensors(std::move(*live), *sensors), *star,
                                                    std::make_unique<HostClock>(), std::move(*poses), arena));
  const Status fits = check_fits(arena);
  if (!fits) return fits.error();
  const Status created = system->create(request);
  if (!created) return created.error();
  system->make_resident();
  return system;
}

LiveSystem::LiveSystem(const LiveRequest& request, Configuration configuration, LiveRig live, const Star& star,
                       std::unique_ptr<HostClock> clock, std::unique_ptr<PosePort> poses, Arena& arena)
    : configuration_(std::move(configuration)),
      live_(std::move(live)),
      star_(star),
      duration_(request.duration),
      clock_(std::move(clock)),
      core_(configuration_, star_, arena),
      remarks_(configuration_.remarks),
      watch_(live_, events_),
      vision_(vision_of(live_, star_, watch_, *clock_)),
      poses_(std::move(poses)),
      intake_(live_, core_.sweeps(), watch_, {vision_ ? &*vision_ : nullptr, poses_.get()}),
      streams_(intake_.streams()),
      threads_(events_),
      writer_(configuration_, star_, BackEndPace::live),
      lost_(configuration_.settings.lost_after_s) {
  std::ranges::copy(live_.remarks, std::back_inserter(remarks_));
}

// The ports are opened last but the folder: from then on the kernel keeps what comes.
Status LiveSystem::create(const LiveRequest& request) {
  Status ready = writer_.remember(request.map, request.out);
  if (!ready) return ready;
  auto devices = open_devices(live_, LidarPorts::points, *clock_, request.kernel);
  if (!devices) return devices.error();
  std::ranges::move(devices->remarks, std::back_inserter(remarks_));
  io_.emplace(std::move(devices->devices), *clock_, events_);
  if (devices->camera) camera_io_.emplace(IoLoop::of(std::move(devices->camera)), *clock_, events_);
  ready = writer_.create(request.out, configuration_, star_, core_.mesh_extraction());
  if (!ready) return ready;
  const ColourCamera* const colours = writer_.output().colour_camera();
  if (vision_ && colours != nullptr) vision_->show_colours(*colours);
  if (vision_ && writer_.sight_images() != nullptr) vision_->keep_for_sight(*writer_.sight_images());
  return success();
}

void LiveSystem::make_resident() {
  const auto resident = prefault_process();
  if (!resident) {
    remarks_.push_back(resident.error().message);
  } else if (!resident->locked) {
    remarks_.push_back(fmt::format("memory is not locked: {} (see ulimit -l)", std::strerror(resident->lock_errno)));
  }
}

Status LiveSystem::run(const LiveObserver& observe, const std::atomic<bool>& stop) {
  begin_ = next_look_ = clock_->now();
  std::thread filter([this] { run_filter(); });
  std::thread reader([this] { read_devices(); });
  std::thread vision;
  if (vision_) vision = std::thread([this] { watch_camera(); });
  place_this_thread(threads::kHousekeeping);
  keep_house_until(observe, stop);
  stopping_ = true;
  reader.join();
  filter.join();
  if (vision.joinable()) vision.join();
  while (write_waiting()) {
  }
  Status finished = finish(stop);
  observe(progress());
  return finished;
}

void LiveSystem::keep_house_until(const LiveObserver& observe, const std::atomic<bool>& stop) {
  constexpr std::chrono::milliseconds kNothingWaits{5};
  while (!stop && !(duration_ && clock_->now() - begin_ >= *duration_)) {
    if (!write_waiting()) std::this_thread::sleep_for(kNothingWaits);
    look_after(observe);
  }
}

bool LiveSystem::write_waiting() {
  bool any = false;
  if (const SubMesh* const sub_mesh = loan_.lent()) {
    note_written(writer_.store(*sub_mesh));
    loan_.stored();
    any = true;
  }
  if (const KeptOutcome* const letter = mail_.front()) {
    write(*letter);
    mail_.release();
    any = true;
  }
  if (!any && beginning_.load(std::memory_order_acquire) == Beginning::asked) store_piece();
  return any;
}

// While it is asked for, the filter leaves its map alone.
void LiveSystem::store_piece() {
  note_written(writer_.store_window(core_.odometry().map()));
  writer_.begin_again();
  events_.add(clock_->now(), "filter", "lost; begins again");
  beginning_.store(Beginning::stored, std::memory_order_release);
}

void LiveSystem::write(const KeptOutcome& letter) {
  while (const auto fix = intake_.pop_fix(letter.outcome().stamp)) writer_.take(*fix, Duration());
  while (vision_) {
    auto colours = vision_->pop_colours();
    if (!colours) break;
    writer_.output().offer(std::move(*colours));
  }
  note_written(writer_.take(letter.outcome(), letter.view()));
}

// Said once: mapping goes on, and what there is room for is written again.
void LiveSystem::note_written(Status status) {
  if (written_ && !status) events_.add(clock_->now(), "run", status.error().message + "; mapping goes on");
  keep_first(written_, std::move(status));
}

void LiveSystem::look_after(const LiveObserver& observe) {
  constexpr Duration kLookPeriod = Duration::from_ns(100'000'000);
  const RigTime now = clock_->now();
  if (now < next_look_) return;
  next_look_ = now + kLookPeriod;
  watch_.look(now);
  threads_.look(now);
  observe(progress());
}

LiveProgress LiveSystem::progress() {
  LiveProgress progress;
  progress.sweeps = sweeps_;
  progress.dropped = late_ + time_backwards_ + too_few_points_;
  progress.untracked = writer_.report().updates.untracked;
  progress.elapsed_s = (clock_->now() - begin_).seconds();
  progress.silent = watch_.silent();
  progress.events = events_.after(events_told_);
  events_told_ += progress.events.size();
  return progress;
}

Status LiveSystem::finish(bool interrupted) {
  // Where it is stored, the filter did not come to begin again.
  if (beginning_ != Beginning::stored) keep_first(written_, writer_.store_last_window(core_.odometry().map()));
  keep_first(written_, writer_.finish_map());
  fill_report(writer_.report());
  writer_.report().interrupted = interrupted;
  keep_first(written_, writer_.write_report());
  if (writer_.poses().empty())
    keep_first(written_, Error{fmt::format("found no sweep that could be used ({})", losses_text(report()))});
  return written_;
}

void LiveSystem::fill_report(Report& report) {
  report.sweeps = sweeps_;
  if (first_begin_) report.duration_s = (last_end_ - *first_begin_).seconds();
  report.real_time_factor = 1;
  report.threads = vision_ ? 5 : 4;  // input, filter, graph, the one that writes, and vision
  count_rejected(report.dropped, "late", late_);
  count_rejected(report.dropped, name_of(SweepRejection::time_backwards), time_backwards_);
  count_rejected(report.dropped, name_of(SweepRejection::too_few_points), too_few_points_);
  count_rejected(report.dropped, "lost", lost_sweeps_);
  count_rejected(report.dropped, "unwritten", unwritten_);
  count_rejected(report.dropped, "sub_meshes", core_.odometry().map().lost_sub_meshes());
  meter_.write(report);
  report.pools = pools_.pools;
  report.peak_rss_mib = peak_rss_mib();
  for (const auto& [sensor, causes] : intake_.rejected())
    if (!causes.empty()) report.rejected[sensor] = causes;
  for (const auto& [sensor, causes] : streams_.rejected(core_.odometry()))
    for (const auto& [cause, times] : causes) report.rejected[sensor][cause] += times;
  report.hints = streams_.hints();
  add_calibration(core_.odometry(), star_, report);
  LiveReport& live = report.live.emplace();
  live.cycle_overruns = overruns_;
  live.threads_missed = threads_.missed();
  live.latency_ms = summarise(latency_);
  live.devices = io_->counts();
  if (camera_io_) live.devices.merge(camera_io_->counts());
  live.events = events_.after(0);
  if (poses_) live.poses = {{"sent", poses_->outlet().sent()}, {"unheard", poses_->outlet().unheard()}};
}

}  // namespace lxd

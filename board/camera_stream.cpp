// SPDX-License-Identifier: Apache-2.0
#include "board/camera_stream.hpp"

#include "board/signal_files.hpp"
#include "drivers/replay/camera_source.hpp"
#include "drivers/replay/gpio_log.hpp"

namespace lxd {

TriggerTiming trigger_timing_of(const Rig& rig) {
  const TriggersRig& triggers = *rig.triggers;
  TriggerTiming timing;
  timing.delay_min = Duration::from_seconds(triggers.delay_min_s);
  timing.delay_max = Duration::from_seconds(triggers.delay_max_s);
  timing.to_exposure = Duration::from_seconds(triggers.to_exposure_s);
  timing.exposure = Duration::from_seconds(rig.camera0->wire.exposure_s);
  return timing;
}

Result<CameraFolder> open_timed_camera(const std::filesystem::path& recording, const Rig& rig) {
  auto folder = open_camera(recording);
  if (!folder || !rig.camera0->wire.by_triggers()) return folder;
  auto edges = read_gpio_edges(recording / kGpioLogFile, kCameraLine, triggers_at(*rig.triggers) == GpioEdge::rising);
  if (!edges) return edges.error();
  folder->use_triggers(trigger_timing_of(rig), std::move(*edges));
  return folder;
}

Result<CameraStream> CameraStream::open(const std::filesystem::path& recording, const Rig& rig,
                                        const MountedCamera& camera) {
  auto folder = open_timed_camera(recording, rig);
  if (!folder) return folder.error();
  return CameraStream(std::move(*folder), camera);
}

bool CameraStream::read() {
  if (next_ || ended_) return !ended_;
  next_.emplace();
  ended_ = !folder_.next(*next_);
  return !ended_;
}

void CameraStream::feed(Odometry& odometry, const Mutes& mutes, RigTime until, Duration shift) {
  while (read()) {
    const RigTime stamp = next_->instant + shift;
    if (stamp > until) return;
    const bool heard = !mutes.silent("camera0", stamp);
    if (heard && listener_) listener_(*next_, stamp);
    const Duration delay = odometry.camera_delay();
    const auto turn = odometry.turn(follower_.frame().stamp - delay, stamp - delay);
    if (heard && follower_.follow(next_->pixels, stamp, turn)) odometry.add(follower_.frame());
    next_.reset();
  }
}

Rejections CameraStream::rejected() const {
  Rejections rejected = folder_.rejected();
  follower_.report(rejected);
  return rejected;
}

}  // namespace lxd

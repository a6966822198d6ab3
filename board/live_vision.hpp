// SPDX-License-Identifier: Apache-2.0
// The camera of a live rig: its images through the visual front-end in a thread of its own, as features for the
// real-time thread. That tells the front-end nothing; where features are sought is told by the gyroscope alone, whose
// bias is left in: some tenths of a pixel from image to image.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "board/colour_intake.hpp"
#include "board/image_follower.hpp"
#include "board/live_images.hpp"
#include "board/sensor_watch.hpp"
#include "board/sight_images.hpp"
#include "drivers/device/host_clock.hpp"
#include "estimator/imu_history.hpp"
#include "rt/imu_sample.hpp"
#include "rt/spsc_ring.hpp"

namespace lxd {

class LiveVision final : public ChunkSink {
 public:
  // inertial: an IMU will tell of turns. `watch` and `clock` outlive it.
  LiveVision(const Rig& rig, const MountedCamera& camera, bool inertial, SensorWatch& watch, const HostClock& clock);

  // Some images are shown in colour, too; before all threads. The camera outlives this.
  void show_colours(const ColourCamera& camera);

  // Every image is kept for a while there, for places that are seen again; before all threads. They outlive this.
  void keep_for_sight(SightImages& images) { sight_images_ = &images; }

  // Reading thread.
  void add_trigger(RigTime edge) { images_.add_trigger(edge); }
  void add(const ImuSample& sample) { (void)readings_.push(sample); }  // a lost one leaves a gap, and no prediction

  // Vision thread: a frame; then all images that are ready.
  void take(const Chunk& chunk) override;
  void turn();
  // An image waits for its trigger or for the IMU.
  [[nodiscard]] bool waiting() const { return images_.waiting(); }

  // Real-time thread: the oldest features that wait.
  [[nodiscard]] std::optional<FeatureFrame> pop() { return frames_.pop(); }

  // Writing thread: the oldest image that waits to tell colours.
  [[nodiscard]] std::optional<ColourOffer> pop_colours();

  // After all threads.
  [[nodiscard]] Rejections rejected() const;

 private:
  static constexpr std::size_t kFrames = 16, kReadings = 1024;
  static constexpr std::size_t kHistoryBytes = 1U << 20U;

  [[nodiscard]] bool too_early(const CameraImage& image, RigTime now) const;
  [[nodiscard]] std::optional<Eigen::Matrix3d> turned(RigTime then, RigTime now);

  SensorWatch& watch_;
  const HostClock& clock_;
  LiveImages images_;
  ImageFollower follower_;
  bool inertial_;
  std::vector<std::byte> history_block_;
  Arena history_arena_;
  ImuHistory history_;
  std::vector<ImuSample> reading_slots_;
  SpscRing<ImuSample> readings_;
  std::vector<FeatureFrame> frame_slots_;
  SpscRing<FeatureFrame> frames_;
  void keep_colours(const CameraImage& image, const ColourPixels& pixels);

  std::uint64_t no_room_ = 0;
  SightImages* sight_images_ = nullptr;  // null: nobody asks
  static constexpr std::size_t kColoursMax = 8;
  const ColourCamera* colour_camera_ = nullptr;  // null: nobody asks for colours
  std::mutex colours_mutex_;                     // neither thread is a real-time one
  std::deque<ColourOffer> colours_;
};

}  // namespace lxd

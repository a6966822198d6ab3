// SPDX-License-Identifier: Apache-2.0
// Gives key frames the image that was taken nearest to them, with what the filter knew of its features then. The thread
// that writes the run; descriptors are another's work.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "backend/pnp/visual_key_frame.hpp"
#include "board/sight_images.hpp"
#include "estimator/vision/reprojection.hpp"
#include "estimator/vision/sighted_image.hpp"
#include "rt/key_frame.hpp"

namespace lxd {

// A key frame with its image, before anything of it is described.
struct SightedKeyFrame {
  std::int64_t key_frame = 0;
  Pose T_body_camera;  // the camera at the image's time in the body at the key frame's
  std::vector<SightedFeature> features;
  float bearing_sigma_rad = 0;
  std::shared_ptr<const GreyPixels> image;
};

struct SightIntakeCounts {
  std::uint64_t images_gone = 0;  // had made room before they were asked for
};

class SightIntake {
 public:
  SightIntake(const MountedCamera& camera, double pixel_sigma_px, std::size_t image_bytes);

  // For the thread that reads the camera.
  [[nodiscard]] SightImages& images() { return images_; }

  // A key frame, then what the filter has seen in the same sweep; each sweep's, whether it is a key frame or not. The
  // key frame that has its image now, which may be one of some sweeps ago.
  void note(const KeyFrame& frame) { waiting_ = frame; }
  [[nodiscard]] std::optional<SightedKeyFrame> take(const SightedImage& sighted);

  // The filter begins again: who waits has no image any more.
  void begin_again() { waiting_.reset(); }

  [[nodiscard]] const SightIntakeCounts& counts() const { return counts_; }

 private:
  float bearing_sigma_rad_;
  SightImages images_;
  std::optional<KeyFrame> waiting_;
  SightIntakeCounts counts_;
};

// Its features, described; those too near to the image's border have none. Takes some milliseconds.
VisualKeyFrame describe(const SightedKeyFrame& sighted);

}  // namespace lxd

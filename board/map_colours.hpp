// SPDX-License-Identifier: Apache-2.0
// The colours of a run's map: key images as they come; sub-meshes as they are finished, each in a thread of low
// priority beside the writing one. What it stores does not depend on how long that takes, but in a live run: there the
// next sub-mesh does not wait, and images that were not looked at by then are left out.
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>

#include "backend/archive.hpp"
#include "backend/colour/colourist.hpp"
#include "board/colour_camera.hpp"
#include "board/colour_intake.hpp"
#include "board/configuration.hpp"
#include "board/map_keeper.hpp"
#include "board/report.hpp"
#include "board/star.hpp"

namespace lxd {

// Stays where it is: the thread knows it by its address.
class MapColours {
 public:
  MapColours(const MountedCamera& camera, const Settings& settings, BackEndPace pace);
  // Null: no camera is in use, or its colours are not wanted.
  static std::unique_ptr<MapColours> create(const Configuration& configuration, const Star& star, BackEndPace pace);

  [[nodiscard]] ColourIntake& intake() { return intake_; }
  [[nodiscard]] const ColourCamera& camera() const { return camera_; }

  // A finished sub-mesh, in the filter's world. Its vertices and faces are lent until collect().
  void begin(const SubmeshView& submesh);
  // Waits for the sub-mesh under way, or where another one is waiting for its end, and stores its colours.
  enum class Waiting : std::uint8_t { nobody, next_submesh };
  Status collect(ArchiveWriter& archive, Waiting waiting);
  // No sweep comes any more: from now on nothing is left out for the next sub-mesh's sake.
  void at_leisure() { hurries_ = false; }
  // The filter begins again.
  void begin_again();

  // Of all sub-meshes that were collected.
  [[nodiscard]] bool any() const { return colourist_.counts().coloured > 0; }
  void write(Report& report);

 private:
  ColourCamera camera_;
  ColourIntake intake_;
  Colourist colourist_;
  bool beside_, hurries_;
  std::atomic<bool> hurry_{false};
  bool new_piece_ = false;  // the next sub-mesh has nothing in common with the last
  std::int64_t id_ = 0;     // of the sub-mesh under way
  double work_s_ = 0;       // the thread's
  std::future<std::vector<VertexColour>> under_way_;
};

}  // namespace lxd

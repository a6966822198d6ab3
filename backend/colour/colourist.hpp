// SPDX-License-Identifier: Apache-2.0
// Colours of a finished sub-mesh, told from the key images that were taken while it was built (README, "Colour"). What
// neighbouring sub-meshes have in common is carried on: the gains of the last images. Low priority; one thread at a
// time; memory is bounded by the sub-mesh's vertices (some 120 bytes each) and the images.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "backend/archive.hpp"
#include "backend/colour/gains.hpp"
#include "backend/colour/key_image.hpp"
#include "backend/colour/mesh_tiles.hpp"
#include "backend/colour/visibility.hpp"
#include "backend/vertex_colour.hpp"
#include "rt/time.hpp"

namespace lxd {

struct ColourCounts {
  std::uint64_t images = 0;    // that colours were told from
  std::uint64_t hurried = 0;   // that were left out in a hurry
  std::uint64_t vertices = 0;  // of the sub-meshes
  std::uint64_t coloured = 0;  // of these
};

class Colourist {
 public:
  Colourist(const PinholeView& view, const SightLimits& limits) : view_(view), limits_(limits) {}

  // images: in order of time, in the frame that T_map_submesh leads to. One colour a vertex. Once `hurry` is true no
  // more images are looked at; those that were are spread over the time.
  std::vector<VertexColour> colour(const SubmeshView& submesh, std::vector<KeyImage> images,
                                   const std::atomic<bool>& hurry);
  // What comes has nothing in common with what was.
  void begin_again() { earlier_.clear(); }

  [[nodiscard]] const ColourCounts& counts() const { return counts_; }

 private:
  struct SettledImage {
    KeyImage image;
    ImageGain gain;
  };
  // What is told of the tiles' vertices.
  struct Looks {
    ColourSamples samples;
    std::vector<VertexSight> sightings;  // in the image that is looked at; between images all of them are none
  };
  void look(const MeshTiles& mesh, const Pose& T_camera_mesh, const KeyImage& image, std::size_t number, Looks& looks);

  PinholeView view_;
  SightLimits limits_;
  LensFalloff falloff_;
  std::vector<SettledImage> earlier_;  // the last of the sub-mesh before
  ColourCounts counts_;
};

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// The registered cloud of a run: written sweep by sweep with a fixed buffer, read back in chunks, converted on demand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <span>
#include <string>

#include "backend/part_file.hpp"
#include "backend/ply_header.hpp"
#include "backend/trajectory.hpp"
#include "backend/vertex_colour.hpp"
#include "rt/result.hpp"

namespace lxd {

// The surface that a point lies on, at the surface's vertex nearest to it.
struct PointSurface {
  float nx = 0, ny = 0, nz = 0;                                 // unit, towards the side that was seen; 0 0 0: on none
  float variance_m2 = std::numeric_limits<float>::quiet_NaN();  // the surface's, along the normal; NaN: unknown

  [[nodiscard]] bool known() const { return nx != 0 || ny != 0 || nz != 0; }
};

// As it lies in cloud.ply, packed; surface and colour only in a cloud that has them.
struct CloudPoint {
  float x_m = 0, y_m = 0, z_m = 0;  // map frame; as it was measured, not moved onto the surface
  float intensity = 0;              // the sensor's own scale
  double time_s = 0;                // rig time of the return
  PointSurface surface{};
  VertexColour colour{};
};
static_assert(offsetof(CloudPoint, surface) == 24 && offsetof(CloudPoint, colour) == 40);

// What the points of a cloud have besides place, intensity and time.
struct CloudFields {
  bool surface = false, colour = false;

  [[nodiscard]] std::size_t bytes_before_colour() const {
    return surface ? offsetof(CloudPoint, colour) : offsetof(CloudPoint, surface);
  }
  [[nodiscard]] std::size_t record_bytes() const { return bytes_before_colour() + (colour ? sizeof(VertexColour) : 0); }
};

// Binary little-endian PLY: float x y z intensity, double time; with surfaces float nx ny nz variance; with colours
// uchar red green blue views. Low-priority thread only.
class CloudWriter {
 public:
  static Result<CloudWriter> create(const std::filesystem::path& path, CloudFields fields = {});
  // Non-finite points are left out. Error: writing failed (disk full, ...), told from the first call that can know; the
  // next call tries again, without the points that had no room.
  Status append(std::span<const CloudPoint> points);
  // Patches the count into the head and gives the file its name.
  Status close();
  [[nodiscard]] std::uint64_t count() const { return (file_.size_bytes() - head_bytes_) / fields_.record_bytes(); }

 private:
  CloudWriter(PartFile file, CloudFields fields);
  PartFile file_;
  CloudFields fields_;
  std::uint64_t head_bytes_ = 0;
};

class CloudReader {
 public:
  // Any binary little-endian PLY whose vertices have x, y, z; what is missing of intensity and time reads as 0, of
  // surfaces and colours as none, of a variance as unknown.
  static Result<CloudReader> open(const std::filesystem::path& path);
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] CloudFields fields() const { return fields_; }

  // All points from the first, in chunks of bounded size; stops at the visitor's first error. Error: truncated file.
  using ChunkVisitor = std::function<Status(std::span<const CloudPoint>)>;
  Status for_each_chunk(const ChunkVisitor& visit);

 private:
  CloudReader(std::filesystem::path path, std::ifstream file, PlyElement vertex);
  [[nodiscard]] CloudPoint decode(const char* record) const;
  [[nodiscard]] PointSurface decode_surface(const char* record) const;
  [[nodiscard]] VertexColour decode_colour(const char* record) const;

  std::filesystem::path path_;
  std::ifstream file_;
  std::unique_ptr<PlyElement> vertex_;  // stays where it is when the reader moves: the properties point into it
  std::uint64_t size_ = 0;
  std::streamoff data_begin_ = 0;
  std::array<const PlyProperty*, 5> place_{};    // x y z intensity time
  std::array<const PlyProperty*, 4> surface_{};  // nx ny nz variance
  std::array<const PlyProperty*, 4> colour_{};   // red green blue views
  CloudFields fields_;
};

// Rewrites a cloud of which each point was seen from the path `from` at its time, as seen from the path `to`, which has
// the same stamps; normals are turned with them; in chunks. Points seen from poses that are not `kept` go; empty: all
// are. Error: reading, writing; the cloud is then as it was.
Status move_cloud(const std::filesystem::path& cloud_ply, std::span<const StampedPose> from,
                  std::span<const StampedPose> to, const std::vector<bool>& kept = {});

// Converts cloud.ply by the ending of `out`: .ply, .pcd (binary), .las (1.2, point format 1, with colours 3; gps_time
// holds rig time, extra bytes the surface).
// Error: ending unknown, cloud damaged, out of the format's range, writing failed.
Status export_cloud(const std::filesystem::path& cloud_ply, const std::filesystem::path& out);

}  // namespace lxd

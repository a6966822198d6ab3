// SPDX-License-Identifier: Apache-2.0
// The registered cloud of a run: written sweep by sweep with a fixed buffer, read back in chunks, converted on demand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string>

#include "backend/part_file.hpp"
#include "backend/ply_header.hpp"
#include "backend/trajectory.hpp"
#include "backend/vertex_colour.hpp"
#include "rt/result.hpp"

namespace lxd {

// Begins as it lies in cloud.ply, packed; the colour only in a cloud that has colours.
struct CloudPoint {
  float x_m = 0, y_m = 0, z_m = 0;  // map frame
  float intensity = 0;              // the sensor's own scale
  double time_s = 0;                // rig time of the return
  VertexColour colour{};
};
inline constexpr std::size_t kCloudRecordBytes = 24, kColouredRecordBytes = kCloudRecordBytes + sizeof(VertexColour);
static_assert(offsetof(CloudPoint, colour) == kCloudRecordBytes);

// Binary little-endian PLY: float x y z intensity, double time; of a coloured one uchar red green blue views.
// Low-priority thread only.
class CloudWriter {
 public:
  static Result<CloudWriter> create(const std::filesystem::path& path, bool coloured = false);
  // Non-finite points are left out. Error: writing failed (disk full, ...), told from the first call that can know; the
  // next call tries again, without the points that had no room.
  Status append(std::span<const CloudPoint> points);
  // Patches the count into the head and gives the file its name.
  Status close();
  [[nodiscard]] std::uint64_t count() const { return (file_.size_bytes() - head_bytes_) / record_bytes_; }

 private:
  CloudWriter(PartFile file, bool coloured);
  PartFile file_;
  std::size_t record_bytes_;
  std::uint64_t head_bytes_ = 0;
};

class CloudReader {
 public:
  // Any binary little-endian PLY whose vertices have x, y, z; what is missing of intensity and time reads as 0, of
  // colours as none.
  static Result<CloudReader> open(const std::filesystem::path& path);
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] bool has_time() const { return fields_[4] != nullptr; }
  [[nodiscard]] bool coloured() const {
    return colour_[0] != nullptr && colour_[1] != nullptr && colour_[2] != nullptr;
  }

  // All points from the first, in chunks of bounded size; stops at the visitor's first error. Error: truncated file.
  using ChunkVisitor = std::function<Status(std::span<const CloudPoint>)>;
  Status for_each_chunk(const ChunkVisitor& visit);

 private:
  CloudReader(std::filesystem::path path, std::ifstream file, PlyElement vertex);
  [[nodiscard]] CloudPoint decode(const char* record) const;
  [[nodiscard]] VertexColour decode_colour(const char* record) const;

  std::filesystem::path path_;
  std::ifstream file_;
  std::unique_ptr<PlyElement> vertex_;  // stays where it is when the reader moves: fields_ point into it
  std::uint64_t size_ = 0;
  std::streamoff data_begin_ = 0;
  std::array<const PlyProperty*, 5> fields_{};  // x y z intensity time
  std::array<const PlyProperty*, 4> colour_{};  // red green blue views
};

// Rewrites a cloud of which each point was seen from the path `from` at its time, as seen from the path `to`, which has
// the same stamps; in chunks. Points seen from poses that are not `kept` go; empty: all are. Error: reading, writing;
// the cloud is then as it was.
Status move_cloud(const std::filesystem::path& cloud_ply, std::span<const StampedPose> from,
                  std::span<const StampedPose> to, const std::vector<bool>& kept = {});

// Converts cloud.ply by the ending of `out`: .ply, .pcd (binary), .las (1.2, point format 1, with colours 3; gps_time
// holds rig time).
// Error: ending unknown, cloud damaged, out of the format's range, writing failed.
Status export_cloud(const std::filesystem::path& cloud_ply, const std::filesystem::path& out);

}  // namespace lxd

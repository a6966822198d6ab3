// SPDX-License-Identifier: Apache-2.0
// LAS 1.2 (ASPRS, LAS specification version 1.2, 2008). Two passes: bounds for the head, then the points.
#include "backend/cloud_las.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <Eigen/Core>
#include <fmt/format.h>

namespace lxd {
namespace {

constexpr double kScale_m = 0.001;
constexpr double kIntensityMax = 65535;

// Plain arrays: a member of a packed structure may lie anywhere, where std::array may not be called.
struct __attribute__((packed)) LasHeader {
  char signature[4]{'L', 'A', 'S', 'F'};
  std::uint16_t file_source_id = 0;
  std::uint16_t global_encoding = 0;
  std::uint8_t project_guid[16]{};
  std::uint8_t version_major = 1;
  std::uint8_t version_minor = 2;
  char system_identifier[32]{};
  char generating_software[32]{};
  std::uint16_t creation_day = 0;
  std::uint16_t creation_year = 0;
  std::uint16_t header_bytes = 227;
  std::uint32_t points_offset = 227;
  std::uint32_t variable_records = 0;
  std::uint8_t point_format = 1;
  std::uint16_t point_bytes = 28;
  std::uint32_t points = 0;
  std::uint32_t points_by_return[5]{};
  double scale[3]{kScale_m, kScale_m, kScale_m};
  double offset[3]{};
  double bounds[6]{};  // max x, min x, max y, min y, max z, min z
};
static_assert(sizeof(LasHeader) == 227);

struct __attribute__((packed)) LasPoint {
  std::int32_t position[3];
  std::uint16_t intensity = 0;
  std::uint8_t returns = 1 | 1 << 3;  // return 1 of 1
  std::uint8_t classification = 0;
  std::int8_t scan_angle = 0;
  std::uint8_t user_data = 0;
  std::uint16_t point_source = 0;
  double gps_time = 0;
};
static_assert(sizeof(LasPoint) == 28);

// What point format 3 has behind format 1.
struct __attribute__((packed)) LasColour {
  std::uint16_t rgb[3];
};

struct Extent {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector3d high = -low;
  double intensity_max = 0;

  void add(const CloudPoint& p) {
    const Eigen::Vector3d q(p.x_m, p.y_m, p.z_m);
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
    intensity_max = std::max<double>(intensity_max, p.intensity);
  }
};

// Whole metres, so that the coordinates keep their decimals.
Eigen::Vector3d middle_of(const Extent& extent) { return (0.5 * (extent.low + extent.high)).array().round(); }

LasHeader header_of(const Extent& extent, std::uint32_t points, bool coloured) {
  LasHeader header;
  if (coloured) {
    header.point_format = 3;
    header.point_bytes = sizeof(LasPoint) + sizeof(LasColour);
  }
  std::strncpy(header.system_identifier, "LXD-SLAM", sizeof(header.system_identifier));
  std::strncpy(header.generating_software, "LXD-SLAM", sizeof(header.generating_software));
  header.points = points;
  header.points_by_return[0] = points;
  if (points == 0) return header;
  const Eigen::Vector3d middle = middle_of(extent);
  for (int axis = 0; axis < 3; ++axis) {
    header.offset[axis] = middle[axis];
    header.bounds[2 * axis] = extent.high[axis];
    header.bounds[2 * axis + 1] = extent.low[axis];
  }
  return header;
}

LasPoint encode(const CloudPoint& p, const Eigen::Vector3d& middle, double intensity_scale) {
  const Eigen::Vector3d offset_m = Eigen::Vector3d(p.x_m, p.y_m, p.z_m) - middle;
  LasPoint point{};
  for (int axis = 0; axis < 3; ++axis)
    point.position[axis] = static_cast<std::int32_t>(std::lround(offset_m[axis] / kScale_m));
  const double intensity = std::clamp(std::round(p.intensity * intensity_scale), 0.0, kIntensityMax);
  point.intensity = static_cast<std::uint16_t>(intensity);
  point.returns = LasPoint{}.returns;
  point.user_data = p.colour.views;
  point.gps_time = p.time_s;
  return point;
}

// Eight bits spread over sixteen, as the specification wants it.
LasColour las_colour(const VertexColour& colour) {
  constexpr std::uint16_t kSpread = 257;
  const auto spread = [](std::uint8_t level) { return static_cast<std::uint16_t>(level * kSpread); };
  return {{spread(colour.red), spread(colour.green), spread(colour.blue)}};
}

Result<Extent> extent_of(CloudReader& cloud, const std::filesystem::path& out) {
  Extent extent;
  const Status read = cloud.for_each_chunk([&](std::span<const CloudPoint> points) {
    for (const CloudPoint& p : points) extent.add(p);
    return success();
  });
  if (!read.ok()) return read.error();
  if (cloud.size() > std::numeric_limits<std::uint32_t>::max())
    return Error{fmt::format("{}: LAS 1.2 ends at 2^32 - 1 points, the cloud has {}", out.string(), cloud.size())};
  constexpr double kSpanMax_m = kScale_m * std::numeric_limits<std::uint32_t>::max();
  if (cloud.size() > 0 && (extent.high - extent.low).maxCoeff() >= kSpanMax_m)
    return Error{fmt::format("{}: LAS ends at {:.0f} m across, the cloud has {:.0f} m", out.string(), kSpanMax_m,
                             (extent.high - extent.low).maxCoeff())};
  return extent;
}

}  // namespace

Status write_las(CloudReader& cloud, const std::filesystem::path& out) {
  const Result<Extent> extent = extent_of(cloud, out);
  if (!extent.ok()) return extent.error();
  Result<PartFile> file = PartFile::create(out);
  if (!file.ok()) return file.error();
  const bool coloured = cloud.coloured();
  file->write_value(header_of(*extent, static_cast<std::uint32_t>(cloud.size()), coloured));
  const Eigen::Vector3d middle = cloud.size() > 0 ? middle_of(*extent) : Eigen::Vector3d::Zero();
  const double intensity_scale = extent->intensity_max <= 1 ? kIntensityMax : 1;
  const Status written = cloud.for_each_chunk([&](std::span<const CloudPoint> points) {
    for (const CloudPoint& p : points) {
      file->write_value(encode(p, middle, intensity_scale));
      if (coloured) file->write_value(las_colour(p.colour));
    }
    return file->status();
  });
  return written.ok() ? file->commit() : written;
}

}  // namespace lxd

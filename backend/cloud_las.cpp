// SPDX-License-Identifier: Apache-2.0
// Two passes: bounds for the head, then the points.
#include "backend/cloud_las.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include <Eigen/Core>
#include <fmt/format.h>

#include "backend/cloud_las_format.hpp"

namespace lxd {
namespace {

constexpr double kIntensityMax = 65535;

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

// Of a fixed length, filled up with zeros.
template <std::size_t N>
void set_text(char (&field)[N], const char* text) {
  std::strncpy(field, text, N);
}

// What stands behind each point. PDAL and CloudCompare know normals by these names.
struct SurfaceRecord {
  LasRecordHeader header;
  std::array<LasExtraDimension, sizeof(PointSurface) / sizeof(float)> dimensions{};
};
static_assert(sizeof(SurfaceRecord) == sizeof(LasRecordHeader) + 4 * sizeof(LasExtraDimension));

SurfaceRecord surface_record() {
  SurfaceRecord record;
  record.header.bytes = sizeof(record.dimensions);
  set_text(record.header.description, "surface at the nearest vertex");
  constexpr std::array kNames{"NormalX", "NormalY", "NormalZ", "variance"};
  constexpr const char *kNormal = "towards where it was seen from", *kVariance = "m2, along the normal; NaN: none";
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    set_text(record.dimensions[i].name, kNames[i]);
    set_text(record.dimensions[i].description, i < 3 ? kNormal : kVariance);
  }
  return record;
}

LasHeader header_of(const Extent& extent, std::uint32_t points, CloudFields fields) {
  LasHeader header;
  if (fields.colour) {
    header.point_format = 3;
    header.point_bytes += sizeof(LasColour);
  }
  if (fields.surface) {
    header.variable_records = 1;
    header.points_offset += sizeof(SurfaceRecord);
    header.point_bytes += sizeof(PointSurface);
  }
  set_text(header.system_identifier, "LXD-SLAM");
  set_text(header.generating_software, "LXD-SLAM");
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
    point.position[axis] = static_cast<std::int32_t>(std::lround(offset_m[axis] / kLasScale_m));
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
  constexpr double kSpanMax_m = kLasScale_m * std::numeric_limits<std::uint32_t>::max();
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
  const CloudFields fields = cloud.fields();
  file->write_value(header_of(*extent, static_cast<std::uint32_t>(cloud.size()), fields));
  if (fields.surface) file->write_value(surface_record());
  const Eigen::Vector3d middle = cloud.size() > 0 ? middle_of(*extent) : Eigen::Vector3d::Zero();
  const double intensity_scale = extent->intensity_max <= 1 ? kIntensityMax : 1;
  const Status written = cloud.for_each_chunk([&](std::span<const CloudPoint> points) {
    for (const CloudPoint& p : points) {
      file->write_value(encode(p, middle, intensity_scale));
      if (fields.colour) file->write_value(las_colour(p.colour));
      if (fields.surface) file->write_value(p.surface);
    }
    return file->status();
  });
  return written.ok() ? file->commit() : written;
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// cloud.ply, written while its length is not yet known: the head keeps room for the count.
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "backend/cloud.hpp"

namespace lxd {
namespace {

constexpr std::string_view kHeadBegin = "ply\nformat binary_little_endian 1.0\n";
constexpr std::string_view kCloudProperties =
    "property float x\nproperty float y\nproperty float z\nproperty float intensity\nproperty double time\n";
constexpr std::string_view kCloudSurfaceProperties =
    "property float nx\nproperty float ny\nproperty float nz\nproperty float variance\n";
constexpr std::string_view kCloudColourProperties =
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar views\n";
constexpr std::string_view kHeadEnd = "end_header\n";

// Always of the same length whatever the count: a comment takes up what the digits leave.
std::string count_lines(std::uint64_t count) {
  const std::string digits = fmt::format("{}", count);
  constexpr std::size_t kDigitsMax = 20;  // of 2^64
  return fmt::format("element vertex {}\ncomment LXD-SLAM cloud; metres, map frame, rig time in seconds{}\n", digits,
                     std::string(kDigitsMax - digits.size(), '.'));
}

bool finite(const CloudPoint& p) { return std::isfinite(p.x_m) && std::isfinite(p.y_m) && std::isfinite(p.z_m); }

}  // namespace

Result<CloudWriter> CloudWriter::create(const std::filesystem::path& path, CloudFields fields) {
  Result<PartFile> file = PartFile::create(path);
  if (!file.ok()) return file.error();
  return CloudWriter(std::move(*file), fields);
}

CloudWriter::CloudWriter(PartFile file, CloudFields fields) : file_(std::move(file)), fields_(fields) {
  file_.write_text(kHeadBegin);
  file_.write_text(count_lines(0));
  file_.write_text(kCloudProperties);
  if (fields.surface) file_.write_text(kCloudSurfaceProperties);
  if (fields.colour) file_.write_text(kCloudColourProperties);
  file_.write_text(kHeadEnd);
  file_.flush();
  head_bytes_ = file_.size_bytes();
}

// A disk that was full may have room again: points between are lost.
Status CloudWriter::append(std::span<const CloudPoint> points) {
  if (!file_.ok()) file_.resume();
  for (const CloudPoint& p : points) {
    if (!finite(p)) continue;
    file_.write(std::as_bytes(std::span(&p, 1)).first(fields_.bytes_before_colour()));
    if (fields_.colour) file_.write_value(p.colour);
  }
  return file_.status();
}

// Of a file whose end had no room, the points that had.
Status CloudWriter::close() {
  file_.flush();
  if (!file_.ok()) file_.resume();
  const std::string lines = count_lines(count());
  file_.overwrite(kHeadBegin.size(), std::as_bytes(std::span(lines)));
  return file_.commit();
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// Conversion of cloud.ply into the formats that point cloud programs read, in chunks.
#include <algorithm>

#include <fmt/format.h>

#include "backend/cloud.hpp"
#include "backend/cloud_las.hpp"

namespace lxd {
namespace {

Status write_ply(CloudReader& cloud, const std::filesystem::path& out) {
  Result<CloudWriter> writer = CloudWriter::create(out);
  if (!writer.ok()) return writer.error();
  const Status copied =
      cloud.for_each_chunk([&](std::span<const CloudPoint> points) { return writer->append(points); });
  return copied.ok() ? writer->close() : copied;
}

// PCD 0.7 (https://pointclouds.org/documentation/tutorials/pcd_file_format.html): CloudPoint is the record as it is.
Status write_pcd(CloudReader& cloud, const std::filesystem::path& out) {
  Result<PartFile> file = PartFile::create(out);
  if (!file.ok()) return file.error();
  file->write_text(fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity time\nSIZE 4 4 4 4 8\n"
      "TYPE F F F F F\nCOUNT 1 1 1 1 1\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      cloud.size()));
  const Status copied = cloud.for_each_chunk([&](std::span<const CloudPoint> points) {
    file->write_values(points);
    return file->status();
  });
  return copied.ok() ? file->commit() : copied;
}

}  // namespace

Status export_cloud(const std::filesystem::path& cloud_ply, const std::filesystem::path& out) {
  Result<CloudReader> cloud = CloudReader::open(cloud_ply);
  if (!cloud.ok()) return cloud.error();
  const std::string ending = out.extension().string();
  if (ending == ".ply") return write_ply(*cloud, out);
  if (ending == ".pcd") return write_pcd(*cloud, out);
  if (ending == ".las") return write_las(*cloud, out);
  return Error{fmt::format("{}: found ending '{}', wanted .ply, .pcd or .las", out.string(), ending)};
}

}  // namespace lxd

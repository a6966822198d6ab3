// SPDX-License-Identifier: Apache-2.0
// Conversion of cloud.ply into the formats that point cloud programs read, in chunks.
#include <algorithm>

#include <fmt/format.h>

#include "backend/cloud.hpp"
#include "backend/cloud_las.hpp"

namespace lxd {
namespace {

Status write_ply(CloudReader& cloud, const std::filesystem::path& out) {
  Result<CloudWriter> writer = CloudWriter::create(out, cloud.coloured());
  if (!writer.ok()) return writer.error();
  const Status copied =
      cloud.for_each_chunk([&](std::span<const CloudPoint> points) { return writer->append(points); });
  return copied.ok() ? writer->close() : copied;
}

// As PCL packs a colour into the bits of a float.
std::uint32_t packed_rgb(const VertexColour& colour) {
  return std::uint32_t{colour.red} << 16U | std::uint32_t{colour.green} << 8U | colour.blue;
}

void write_pcd_points(PartFile& file, std::span<const CloudPoint> points, bool coloured) {
  for (const CloudPoint& p : points) {
    file.write(std::as_bytes(std::span(&p, 1)).first(kCloudRecordBytes));
    if (!coloured) continue;
    file.write_value(packed_rgb(p.colour));
    file.write_value(p.colour.views);
  }
}

// PCD 0.7 (https://pointclouds.org/documentation/tutorials/pcd_file_format.html): the record as CloudPoint begins; then
// `rgb`, and `views`, 0 where no camera saw.
Status write_pcd(CloudReader& cloud, const std::filesystem::path& out) {
  Result<PartFile> file = PartFile::create(out);
  if (!file.ok()) return file.error();
  const bool coloured = cloud.coloured();
  file->write_text(fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity time{1}\nSIZE 4 4 4 4 8{2}\n"
      "TYPE F F F F F{3}\nCOUNT 1 1 1 1 1{4}\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA "
      "binary\n",
      cloud.size(), coloured ? " rgb views" : "", coloured ? " 4 1" : "", coloured ? " F U" : "",
      coloured ? " 1 1" : ""));
  const Status copied = cloud.for_each_chunk([&](std::span<const CloudPoint> points) {
    write_pcd_points(*file, points, coloured);
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

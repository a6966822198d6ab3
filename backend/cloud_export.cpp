// SPDX-License-Identifier: Apache-2.0
// Conversion of cloud.ply into the formats that point cloud programs read, in chunks.
#include <algorithm>

#include <fmt/format.h>

#include "backend/cloud.hpp"
#include "backend/cloud_las.hpp"

namespace lxd {
namespace {

Status write_ply(CloudReader& cloud, const std::filesystem::path& out) {
  Result<CloudWriter> writer = CloudWriter::create(out, cloud.fields());
  if (!writer.ok()) return writer.error();
  const Status copied =
      cloud.for_each_chunk([&](std::span<const CloudPoint> points) { return writer->append(points); });
  return copied.ok() ? writer->close() : copied;
}

// As PCL packs a colour into the bits of a float.
std::uint32_t packed_rgb(const VertexColour& colour) {
  return std::uint32_t{colour.red} << 16U | std::uint32_t{colour.green} << 8U | colour.blue;
}

// What a PCD head says of the fields, in the order of its lines.
struct PcdColumns {
  std::string names, sizes, types, counts;

  void operator+=(const PcdColumns& more) {
    names += more.names;
    sizes += more.sizes;
    types += more.types;
    counts += more.counts;
  }
};

void write_pcd_points(PartFile& file, std::span<const CloudPoint> points, CloudFields fields) {
  for (const CloudPoint& p : points) {
    file.write(std::as_bytes(std::span(&p, 1)).first(fields.bytes_before_colour()));
    if (!fields.colour) continue;
    file.write_value(packed_rgb(p.colour));
    file.write_value(p.colour.views);
  }
}

// PCD 0.7 (https://pointclouds.org/documentation/tutorials/pcd_file_format.html): the record as CloudPoint begins, the
// normals by PCL's names; then `rgb`, and `views`, 0 where no camera saw.
Status write_pcd(CloudReader& cloud, const std::filesystem::path& out) {
  Result<PartFile> file = PartFile::create(out);
  if (!file.ok()) return file.error();
  const CloudFields fields = cloud.fields();
  PcdColumns columns{"x y z intensity time", "4 4 4 4 8", "F F F F F", "1 1 1 1 1"};
  if (fields.surface) columns += {" normal_x normal_y normal_z variance", " 4 4 4 4", " F F F F", " 1 1 1 1"};
  if (fields.colour) columns += {" rgb views", " 4 1", " F U", " 1 1"};
  file->write_text(fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {1}\nSIZE {2}\nTYPE {3}\nCOUNT {4}\nWIDTH {0}\n"
      "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      cloud.size(), columns.names, columns.sizes, columns.types, columns.counts));
  const Status copied = cloud.for_each_chunk([&](std::span<const CloudPoint> points) {
    write_pcd_points(*file, points, fields);
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

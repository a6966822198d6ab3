// SPDX-License-Identifier: Apache-2.0
// Reading PLY meshes: our own, and the worlds that others made.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>

#include <fmt/format.h>

#include "backend/ply_header.hpp"
#include "tools/evaluate/triangle_mesh.hpp"

namespace lxd {
namespace {

constexpr std::size_t kReserveMax = std::size_t{1} << 24U;  // a head may promise more than the file holds
constexpr std::size_t kPolygonMax = 255;

// One number after the other, whatever the encoding.
class NumberStream {
 public:
  NumberStream(std::istream& in, const PlyHeader& header)
      : in_(in), ascii_(header.ascii), big_endian_(header.big_endian) {}

  bool read(PlyType type, double& value) {
    if (ascii_) return static_cast<bool>(in_ >> value);
    std::array<char, 8> bytes{};
    const std::size_t size = std::min(size_bytes(type), bytes.size());
    in_.read(bytes.data(), static_cast<std::streamsize>(size));
    std::array<char, 8> little = bytes;
    for (std::size_t i = 0; big_endian_ && i < size; ++i) little[i] = bytes[size - 1 - i];
    value = read_ply_number(little.data(), type);
    return static_cast<bool>(in_);
  }

  // A property that is a list, or a list of one.
  bool read(const PlyProperty& property, std::vector<double>& values) {
    double count = 1;
    if (property.list_count && !read(*property.list_count, count)) return false;
    if (!(count >= 0 && count <= kPolygonMax)) return false;
    values.resize(static_cast<std::size_t>(count));
    for (double& value : values)
      if (!read(property.type, value)) return false;
    return true;
  }

 private:
  std::istream& in_;
  bool ascii_;
  bool big_endian_;
};

struct Record {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  bool has_variance = false;
  double variance_m2 = 0;
  std::vector<double> corners;
  bool has_glass = false;
  bool glass = false;
};

// The cause when the record is not as it should be, else empty.
std::string add_vertex(TriangleMesh& mesh, const Record& vertex) {
  if (!vertex.position.allFinite()) return "is not finite";
  mesh.vertices_m.push_back(vertex.position);
  if (!vertex.has_variance) return "";
  if (!(vertex.variance_m2 >= 0 && std::isfinite(vertex.variance_m2)))
    return fmt::format("has the variance {}, wanted 0 or more", vertex.variance_m2);
  mesh.variance_m2.push_back(vertex.variance_m2);
  return "";
}

std::string add_polygon(TriangleMesh& mesh, const Record& polygon) {
  const std::vector<double>& corners = polygon.corners;
  for (const double corner : corners)
    if (!(corner >= 0 && corner < static_cast<double>(mesh.vertices_m.size())))
      return fmt::format("names vertex {}, wanted below {}", corner, mesh.vertices_m.size());
  const auto index = [&](std::size_t i) { return static_cast<std::uint32_t>(corners[i]); };
  for (std::size_t i = 2; i < corners.size(); ++i) mesh.faces.push_back({index(0), index(i - 1), index(i)});
  if (polygon.has_glass) mesh.glass.resize(mesh.faces.size(), polygon.glass ? 1 : 0);
  return "";
}

bool read_record(NumberStream& in, const PlyElement& element, Record& record) {
  std::vector<double> values;
  for (const PlyProperty& property : element.properties) {
    if (!in.read(property, values)) return false;
    if (property.name == "x") record.position.x() = values.at(0);
    if (property.name == "y") record.position.y() = values.at(0);
    if (property.name == "z") record.position.z() = values.at(0);
    if (property.name == "variance") {
      record.has_variance = true;
      record.variance_m2 = values.at(0);
    }
    if (property.name == "glass") {
      record.has_glass = true;
      record.glass = values.at(0) != 0;
    }
    if (property.name == "vertex_indices" || property.name == "vertex_index") record.corners.swap(values);
  }
  return true;
}

std::string read_element(NumberStream& in, const PlyElement& element, TriangleMesh& mesh) {
  Record record;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (!read_record(in, element, record))
      return fmt::format("{} {} of {}: truncated or no number", element.name, i, element.count);
    std::string wrong;
    if (element.name == "vertex") wrong = add_vertex(mesh, record);
    if (element.name == "face") wrong = add_polygon(mesh, record);
    if (!wrong.empty()) return fmt::format("{} {} {}", element.name, i, wrong);
  }
  return "";
}

std::string missing_of(const PlyHeader& header) {
  const PlyElement* const vertex = header.find("vertex");
  const PlyElement* const face = header.find("face");
  if (vertex == nullptr || vertex->has_list() || !vertex->find("x") || !vertex->find("y") || !vertex->find("z"))
    return "no vertices with x, y, z";
  if (face == nullptr || !(face->find("vertex_indices") || face->find("vertex_index"))) return "no faces";
  return vertex < face ? "" : "faces before vertices";
}

std::size_t room_for(const PlyElement& element) {
  return static_cast<std::size_t>(std::min<std::uint64_t>(element.count, kReserveMax));
}

}  // namespace

Result<TriangleMesh> load_mesh_ply(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))};
  const Result<PlyHeader> header = read_ply_header(file, path);
  if (!header.ok()) return header.error();
  if (const std::string found = missing_of(*header); !found.empty())
    return Error{fmt::format("{}: found {}, wanted a PLY triangle mesh", path.string(), found)};
  TriangleMesh mesh;
  mesh.vertices_m.reserve(room_for(*header->find("vertex")));
  mesh.faces.reserve(room_for(*header->find("face")));
  NumberStream numbers(file, *header);
  for (const PlyElement& element : header->elements)
    if (const std::string wrong = read_element(numbers, element, mesh); !wrong.empty())
      return Error{fmt::format("{}: {}", path.string(), wrong)};
  return mesh;
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// Reading a PLY cloud back in chunks.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "backend/cloud.hpp"

namespace lxd {
namespace {

constexpr std::size_t kChunkPoints = std::size_t{1} << 14U;
constexpr std::array<const char*, 5> kPlaceNames{"x", "y", "z", "intensity", "time"};
constexpr std::array<const char*, 4> kSurfaceNames{"nx", "ny", "nz", "variance"};
constexpr std::array<const char*, 4> kColourNames{"red", "green", "blue", "views"};

std::string missing_of(const PlyHeader& header) {
  if (header.ascii) return "an ascii file";
  if (header.big_endian) return "a big-endian file";
  if (header.elements.empty() || header.elements[0].name != "vertex") return "a file that does not begin with vertices";
  const PlyElement& vertex = header.elements[0];
  if (vertex.has_list()) return "vertices with lists";
  const bool whole = vertex.find("x") != nullptr && vertex.find("y") != nullptr && vertex.find("z") != nullptr;
  return whole ? "" : "vertices without x, y, z";
}

// Fewer than three components are neither a normal nor a colour; what comes fourth may be missing.
bool has_three(const std::array<const PlyProperty*, 4>& properties) {
  return std::find(properties.begin(), properties.begin() + 3, nullptr) == properties.begin() + 3;
}

}  // namespace

Result<CloudReader> CloudReader::open(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))};
  Result<PlyHeader> header = read_ply_header(file, path);
  if (!header.ok()) return header.error();
  if (const std::string found = missing_of(*header); !found.empty())
    return Error{fmt::format("{}: found {}, wanted a binary PLY cloud", path.string(), found)};
  return CloudReader(path, std::move(file), std::move(header->elements[0]));
}

CloudReader::CloudReader(std::filesystem::path path, std::ifstream file, PlyElement vertex)
    : path_(std::move(path)),
      file_(std::move(file)),
      vertex_(std::make_unique<PlyElement>(std::move(vertex))),
      size_(vertex_->count),
      data_begin_(file_.tellg()) {
  for (std::size_t i = 0; i < place_.size(); ++i) place_[i] = vertex_->find(kPlaceNames[i]);
  for (std::size_t i = 0; i < surface_.size(); ++i) surface_[i] = vertex_->find(kSurfaceNames[i]);
  for (std::size_t i = 0; i < colour_.size(); ++i) colour_[i] = vertex_->find(kColourNames[i]);
  fields_ = {.surface = has_three(surface_), .colour = has_three(colour_)};
}

// Another program's normals may be NaN where there is none.
PointSurface CloudReader::decode_surface(const char* record) const {
  if (!fields_.surface) return {};
  const auto value = [&](std::size_t i) {
    return static_cast<float>(read_ply_number(record + surface_[i]->offset, surface_[i]->type));
  };
  PointSurface surface{value(0), value(1), value(2)};
  if (!std::isfinite(surface.nx) || !std::isfinite(surface.ny) || !std::isfinite(surface.nz)) return {};
  if (surface_[3] != nullptr) surface.variance_m2 = value(3);
  return surface;
}

// Another program's colours do not say how often they were seen.
VertexColour CloudReader::decode_colour(const char* record) const {
  if (!fields_.colour) return {};
  std::array<std::uint8_t, 4> levels{0, 0, 0, 1};
  for (std::size_t i = 0; i < colour_.size(); ++i) {
    if (colour_[i] == nullptr) continue;
    constexpr double kLevelMax = 255;
    const double level = read_ply_number(record + colour_[i]->offset, colour_[i]->type);
    levels[i] = static_cast<std::uint8_t>(std::clamp(level, 0.0, kLevelMax));
  }
  return {levels[0], levels[1], levels[2], levels[3]};
}

CloudPoint CloudReader::decode(const char* record) const {
  std::array<double, 5> values{};
  for (std::size_t i = 0; i < place_.size(); ++i)
    if (place_[i] != nullptr) values[i] = read_ply_number(record + place_[i]->offset, place_[i]->type);
  return {static_cast<float>(values[0]),
          static_cast<float>(values[1]),
          static_cast<float>(values[2]),
          static_cast<float>(values[3]),
          values[4],
          decode_surface(record),
          decode_colour(record)};
}

Status CloudReader::for_each_chunk(const ChunkVisitor& visit) {
  const std::size_t record_bytes = vertex_->record_bytes();
  std::vector<char> raw(kChunkPoints * record_bytes);
  std::vector<CloudPoint> points;
  points.reserve(kChunkPoints);
  file_.clear();
  file_.seekg(data_begin_);
  for (std::uint64_t done = 0; done < size_;) {
    const std::uint64_t wanted = std::min<std::uint64_t>(kChunkPoints, size_ - done);
    file_.read(raw.data(), static_cast<std::streamsize>(wanted * record_bytes));
    const std::uint64_t got = static_cast<std::uint64_t>(file_.gcount()) / record_bytes;
    if (got < wanted)
      return Error{fmt::format("{}: truncated: {} points, the head promises {}", path_.string(), done + got, size_)};
    points.clear();
    for (std::uint64_t i = 0; i < wanted; ++i) points.push_back(decode(raw.data() + i * record_bytes));
    if (const Status visited = visit(points); !visited.ok()) return visited;
    done += wanted;
  }
  return success();
}

}  // namespace lxd

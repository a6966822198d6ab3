// SPDX-License-Identifier: Apache-2.0
#include "backend/cloud_colour.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <vector>

#include "backend/cloud.hpp"
#include "backend/colour/srgb.hpp"

namespace lxd {
namespace {

// The coloured vertices of one sub-mesh, found by place: lists by hash of cells twice the radius wide, so that eight of
// them hold all that is near.
class ColouredSurface {
 public:
  explicit ColouredSurface(double radius_m) : radius_m_(static_cast<float>(radius_m)) {}

  void load(const Archive& archive, const PlacedSubmesh& submesh) {
    T_submesh_cloud_ = submesh.T_cloud_submesh.inverse();
    next_.clear();
    heads_.clear();
    const bool whole = archive.read_vertices(submesh.id, vertices_) && archive.read_colours(submesh.id, colours_) &&
                       colours_.size() == vertices_.size();
    if (!whole) return;
    heads_.assign(std::bit_ceil(vertices_.size() + 1), kEnd);
    next_.assign(vertices_.size(), kEnd);
    for (std::uint32_t i = 0; i < vertices_.size(); ++i) {
      if (!colours_[i].known()) continue;
      std::uint32_t& head = heads_[slot_of(cell_of_place(vertices_[i].position_m, 0))];
      next_[i] = head;
      head = i;
    }
  }

  // Of the vertices around that show the side which the nearest shows, the nearer the more.
  [[nodiscard]] VertexColour at(const CloudPoint& point) {
    if (heads_.empty()) return {};
    const Eigen::Vector3f p = (T_submesh_cloud_ * Eigen::Vector3d(point.x_m, point.y_m, point.z_m)).cast<float>();
    gather(p);
    if (near_.empty()) return {};
    const Near& nearest = *std::ranges::min_element(near_, {}, &Near::squared_m2);
    const Eigen::Vector3f normal = vertices_[nearest.vertex].normal;
    Eigen::Array3f sum = Eigen::Array3f::Zero();
    float weights = 0;
    for (const Near& near : near_) {
      constexpr float kSameSide = 0.5F, kSoftening = 0.01F;
      if (vertices_[near.vertex].normal.dot(normal) < kSameSide) continue;
      const float weight = 1 / (near.squared_m2 + kSoftening * radius_m_ * radius_m_);
      sum += weight * light_of(&colours_[near.vertex].red);
      weights += weight;
    }
    sum /= weights;
    return {level_of(sum[0]), level_of(sum[1]), level_of(sum[2]), colours_[nearest.vertex].views};
  }

 private:
  static constexpr std::uint32_t kEnd = 0xFFFFFFFF;
  using Place = std::array<std::int32_t, 3>;
  struct Near {
    std::uint32_t vertex;
    float squared_m2;
  };

  [[nodiscard]] Place cell_of_place(const Eigen::Vector3f& p, float shift) const {
    const Eigen::Array3f cell = ((p.array() + shift) / (2 * radius_m_)).floor();
    return {static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]), static_cast<std::int32_t>(cell[2])};
  }

  [[nodiscard]] std::size_t slot_of(const Place& place) const {
    constexpr std::array<std::uint64_t, 3> kPrimes{73'856'093, 19'349'663, 83'492'791};  // Teschner et al., 2003
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < 3; ++i) hash ^= static_cast<std::uint64_t>(std::int64_t{place[i]}) * kPrimes[i];
    return static_cast<std::size_t>((hash ^ hash >> 29U) & (heads_.size() - 1));
  }

  // Slots may hold other cells' vertices: the distance tells.
  void gather(const Eigen::Vector3f& p) {
    near_.clear();
    const Place low = cell_of_place(p, -radius_m_), high = cell_of_place(p, radius_m_);
    std::array<std::size_t, 8> slots{};
    std::size_t count = 0;
    for (std::int32_t x = low[0]; x <= high[0]; ++x)
      for (std::int32_t y = low[1]; y <= high[1]; ++y)
        for (std::int32_t z = low[2]; z <= high[2] && count < slots.size(); ++z) {
          const std::size_t slot = slot_of({x, y, z});
          if (std::find(slots.begin(), slots.begin() + count, slot) != slots.begin() + count) continue;
          slots[count++] = slot;
          gather(p, heads_[slot]);
        }
  }

  void gather(const Eigen::Vector3f& p, std::uint32_t head) {
    for (std::uint32_t i = head; i != kEnd; i = next_[i]) {
      const float squared_m2 = (vertices_[i].position_m - p).squaredNorm();
      if (squared_m2 <= radius_m_ * radius_m_) near_.push_back({i, squared_m2});
    }
  }

  float radius_m_;
  Pose T_submesh_cloud_;
  std::vector<MeshVertex> vertices_;
  std::vector<VertexColour> colours_;
  std::vector<std::uint32_t> heads_, next_;
  std::vector<Near> near_;
};

}  // namespace

Status colour_cloud(const std::filesystem::path& cloud_ply, const Archive& archive,
                    std::span<const PlacedSubmesh> submeshes, double radius_m) {
  auto reader = CloudReader::open(cloud_ply);
  if (!reader) return reader.error();
  auto writer = CloudWriter::create(cloud_ply, true);
  if (!writer) return writer.error();
  ColouredSurface surface(radius_m);
  std::optional<std::size_t> loaded;
  std::vector<CloudPoint> coloured;
  const Status done = reader->for_each_chunk([&](std::span<const CloudPoint> points) {
    coloured.assign(points.begin(), points.end());
    for (CloudPoint& point : coloured) {
      const auto after =
          std::ranges::find_if(submeshes.begin() + static_cast<std::ptrdiff_t>(loaded.value_or(0)), submeshes.end(),
                               [&](const PlacedSubmesh& submesh) { return submesh.begin.seconds() > point.time_s; });
      if (after == submeshes.begin()) continue;  // before all
      const auto wanted = static_cast<std::size_t>(after - submeshes.begin()) - 1;
      if (loaded != wanted) surface.load(archive, submeshes[wanted]);
      loaded = wanted;
      point.colour = surface.at(point);
    }
    return writer->append(coloured);
  });
  return done ? writer->close() : done;
}

}  // namespace lxd

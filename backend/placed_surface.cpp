// SPDX-License-Identifier: Apache-2.0
#include "backend/placed_surface.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "backend/colour/srgb.hpp"

namespace lxd {

void PlacedSurface::load(const Archive& archive, const PlacedSubmesh& submesh, bool coloured) {
  T_cloud_submesh_ = submesh.T_cloud_submesh;
  T_submesh_cloud_ = submesh.T_cloud_submesh.inverse();
  if (!archive.read_vertices(submesh.id, vertices_)) vertices_.clear();
  const bool known = coloured && archive.read_colours(submesh.id, colours_) && colours_.size() == vertices_.size();
  if (!known) colours_.clear();
  count_slots();
  sort_by_slot();
}

void PlacedSurface::count_slots() {
  begins_.assign(std::bit_ceil(vertices_.size() + 1) + 1, 0);
  for (std::size_t i = 0; i < vertices_.size(); ++i) ++begins_[slot_of_vertex(i) + 1];
  for (std::size_t slot = 1; slot < begins_.size(); ++slot) begins_[slot] += begins_[slot - 1];
}

// In place (American flag sort): a second copy of a large sub-mesh would be 25 MiB.
void PlacedSurface::sort_by_slot() {
  unsorted_ = begins_;
  for (std::size_t slot = 0; slot + 1 < begins_.size(); ++slot)
    while (unsorted_[slot] < begins_[slot + 1]) {
      const std::uint32_t from = unsorted_[slot], to = unsorted_[slot_of_vertex(from)]++;
      if (from == to) continue;
      std::swap(vertices_[from], vertices_[to]);
      if (!colours_.empty()) std::swap(colours_[from], colours_[to]);
    }
}

void PlacedSurface::tell(CloudPoint& point, std::span<const Eigen::Vector3d> eyes) {
  const Eigen::Vector3d place(point.x_m, point.y_m, point.z_m);
  gather((T_submesh_cloud_ * place).cast<float>());
  if (near_.empty()) return;
  rays_.clear();
  for (const Eigen::Vector3d& eye : eyes)
    rays_.push_back((T_submesh_cloud_.R * (eye - place)).normalized().cast<float>());
  const Near& nearest = nearest_shown();
  const MeshVertex& vertex = vertices_[nearest.vertex];
  const float sign = averted(nearest) ? -1.0F : 1.0F;
  const Eigen::Vector3f normal = sign * (T_cloud_submesh_.R * vertex.normal.cast<double>()).cast<float>();
  point.surface = {normal.x(), normal.y(), normal.z(), vertex.variance_m2};
  if (!colours_.empty()) point.colour = colour_around(vertex.normal);
}

// Seen at a grazing angle a surface may have a normal that is a little off.
bool PlacedSurface::averted(const Near& near) const {
  constexpr float kAverted = -0.17F;  // by more than 10 degrees
  const Eigen::Vector3f& normal = vertices_[near.vertex].normal;
  return !rays_.empty() &&
         std::ranges::all_of(rays_, [&](const Eigen::Vector3f& ray) { return normal.dot(ray) < kAverted; });
}

const PlacedSurface::Near& PlacedSurface::nearest_shown() {
  const auto away = [this](const Near& near) { return averted(near); };
  if (!std::ranges::all_of(near_, away)) std::erase_if(near_, away);
  return *std::ranges::min_element(near_, {}, &Near::squared_m2);
}

VertexColour PlacedSurface::colour_around(const Eigen::Vector3f& normal) const {
  const Near* nearest = nullptr;
  Eigen::Array3f sum = Eigen::Array3f::Zero();
  float weights = 0;
  for (const Near& near : near_) {
    constexpr float kSameSide = 0.5F, kSoftening = 0.01F;
    if (!colours_[near.vertex].known() || vertices_[near.vertex].normal.dot(normal) < kSameSide) continue;
    if (nearest == nullptr || near.squared_m2 < nearest->squared_m2) nearest = &near;
    const float weight = 1 / (near.squared_m2 + kSoftening * radius_m_ * radius_m_);
    sum += weight * light_of(&colours_[near.vertex].red);
    weights += weight;
  }
  if (nearest == nullptr) return {};
  sum /= weights;
  return {level_of(sum[0]), level_of(sum[1]), level_of(sum[2]), colours_[nearest->vertex].views};
}

PlacedSurface::Place PlacedSurface::cell_of_place(const Eigen::Vector3f& p, float shift) const {
  constexpr float kCellsMax = 1 << 30;  // what a lost filter says may be anywhere
  const Eigen::Array3f cell = ((p.array() + shift) / (2 * radius_m_)).floor().max(-kCellsMax).min(kCellsMax);
  return {static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]), static_cast<std::int32_t>(cell[2])};
}

std::size_t PlacedSurface::slot_of(const Place& place) const {
  constexpr std::array<std::uint64_t, 3> kPrimes{73'856'093, 19'349'663, 83'492'791};  // Teschner et al., 2003
  std::uint64_t hash = 0;
  for (std::size_t i = 0; i < 3; ++i) hash ^= static_cast<std::uint64_t>(std::int64_t{place[i]}) * kPrimes[i];
  return static_cast<std::size_t>((hash ^ hash >> 29U) & (begins_.size() - 2));
}

std::size_t PlacedSurface::slot_of_vertex(std::size_t vertex) const {
  return slot_of(cell_of_place(vertices_[vertex].position_m, 0));
}

void PlacedSurface::gather(const Eigen::Vector3f& p) {
  near_.clear();
  if (vertices_.empty()) return;
  const Place low = cell_of_place(p, -radius_m_), high = cell_of_place(p, radius_m_);
  std::array<std::size_t, 8> slots{};
  std::size_t count = 0;
  for (std::int32_t x = low[0]; x <= high[0]; ++x)
    for (std::int32_t y = low[1]; y <= high[1]; ++y)
      for (std::int32_t z = low[2]; z <= high[2] && count < slots.size(); ++z) {
        const std::size_t slot = slot_of({x, y, z});
        if (std::find(slots.begin(), slots.begin() + count, slot) != slots.begin() + count) continue;
        slots[count++] = slot;
        gather(p, slot);
      }
}

// Slots may hold other cells' vertices: the distance tells.
void PlacedSurface::gather(const Eigen::Vector3f& p, std::size_t slot) {
  for (std::uint32_t i = begins_[slot]; i < begins_[slot + 1]; ++i) {
    const float squared_m2 = (vertices_[i].position_m - p).squaredNorm();
    if (squared_m2 <= radius_m_ * radius_m_) near_.push_back({i, squared_m2});
  }
}

}  // namespace lxd

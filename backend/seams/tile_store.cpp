// SPDX-License-Identifier: Apache-2.0
#include "backend/seams/tile_store.hpp"

#include <algorithm>
#include <unordered_map>

namespace lxd {
namespace {

// Where the vertices of one sub-mesh belong: tiles are numbered as they are met.
class TileSort {
 public:
  explicit TileSort(const SeamScale& scale) : inverse_tile_pm_(1.0 / scale.tile_m()), halo_m_(scale.halo_m()) {}

  // Its own tile, and those whose halo it is in.
  void add(std::uint32_t vertex, const Eigen::Vector3d& p_m) {
    const CellIndex own = cell_of(p_m, inverse_tile_pm_);
    if (!p_m.allFinite() || is_last_cell(own)) return;
    const Eigen::Vector3d halo = Eigen::Vector3d::Constant(halo_m_);
    const CellIndex low = cell_of(p_m - halo, inverse_tile_pm_), high = cell_of(p_m + halo, inverse_tile_pm_);
    for (int x = low.x(); x <= high.x(); ++x)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int z = low.z(); z <= high.z(); ++z) {
          const CellIndex tile(x, y, z);
          entries_.push_back(std::uint64_t{number_of(pack(tile))} << kTileShift |
                             std::uint64_t{tile == own ? 0U : 1U} << kHaloShift | vertex);
        }
  }

  void sort() { std::ranges::sort(entries_); }

  [[nodiscard]] std::span<const std::uint64_t> entries() const { return entries_; }
  [[nodiscard]] CellKey tile(std::uint64_t entry) const {
    return tiles_[static_cast<std::size_t>(entry >> kTileShift)];
  }
  static bool in_halo(std::uint64_t entry) { return (entry >> kHaloShift & 1U) != 0; }
  static std::uint32_t vertex(std::uint64_t entry) { return static_cast<std::uint32_t>(entry); }

 private:
  static constexpr unsigned kHaloShift = 32, kTileShift = 33;

  std::uint32_t number_of(CellKey tile) {
    const auto [place, is_new] = numbers_.try_emplace(tile, static_cast<std::uint32_t>(tiles_.size()));
    if (is_new) tiles_.push_back(tile);
    return place->second;
  }

  double inverse_tile_pm_, halo_m_;
  std::vector<CellKey> tiles_;
  std::unordered_map<CellKey, std::uint32_t> numbers_;
  std::vector<std::uint64_t> entries_;
};

}  // namespace

Result<TileStore> TileStore::create(const std::filesystem::path& folder, const SeamScale& scale) {
  Result<ScratchFile> file = ScratchFile::create(folder);
  if (!file.ok()) return file.error();
  return TileStore(std::move(*file), scale);
}

Status TileStore::append(const SubmeshView& submesh, std::span<const std::uint8_t> rings) {
  constexpr std::size_t kBuffered = 8192;
  TileSort sort(scale_);
  for (std::uint32_t i = 0; i < submesh.vertices.size(); ++i)
    if (submesh.vertices[i].normal.allFinite() && submesh.vertices[i].variance_m2 >= 0)
      sort.add(i, submesh.T_map_submesh * submesh.vertices[i].position_m.cast<double>());
  sort.sort();
  std::vector<SeamVertex> buffer;
  std::uint64_t written = vertices_;
  const auto flush = [&] {
    Status status = file_.write(written * sizeof(SeamVertex), std::as_bytes(std::span(buffer)));
    written += buffer.size();
    buffer.clear();
    return status;
  };
  for (const std::uint64_t entry : sort.entries()) {
    const CellKey tile = sort.tile(entry);
    if (runs_.empty() || runs_.back().submesh != submeshes_ || runs_.back().tile != tile)
      runs_.push_back({tile, submeshes_, 0, 0, vertices_});
    ++(TileSort::in_halo(entry) ? runs_.back().halo : runs_.back().inner);
    ++vertices_;
    const std::uint32_t i = TileSort::vertex(entry);
    const MeshVertex& v = submesh.vertices[i];
    const Eigen::Vector3d p_m = submesh.T_map_submesh * v.position_m.cast<double>() - corner_m(tile);
    const Eigen::Vector3f normal = (submesh.T_map_submesh.R * v.normal.cast<double>()).cast<float>();
    const VertexColour colour = submesh.colours.empty() ? VertexColour{} : submesh.colours[i];
    buffer.push_back(
        {p_m.cast<float>(), normal, v.variance_m2, colour, submeshes_, i, rings[i], TileSort::in_halo(entry)});
    if (buffer.size() < kBuffered) continue;
    if (const Status status = flush(); !status.ok()) return status;
  }
  ++submeshes_;
  return flush();
}

std::vector<std::span<const TileStore::Run>> TileStore::shared_tiles() {
  by_tile_ = runs_;
  std::ranges::stable_sort(by_tile_, {}, &Run::tile);
  const auto next_tile = [this](auto begin) {
    return std::find_if(begin, by_tile_.end(), [begin](const Run& run) { return run.tile != begin->tile; });
  };
  auto kept = by_tile_.begin();
  for (auto begin = by_tile_.begin(), end = begin; begin != by_tile_.end(); begin = end) {
    end = next_tile(begin);
    kept = end - begin > 1 ? std::move(begin, end, kept) : kept;
  }
  by_tile_.erase(kept, by_tile_.end());
  std::erase_if(runs_, [this](const Run& run) { return !is_shared(run.tile); });
  std::vector<std::span<const Run>> tiles;
  for (auto begin = by_tile_.begin(), end = begin; begin != by_tile_.end(); begin = end) {
    end = next_tile(begin);
    tiles.emplace_back(begin, end);
  }
  return tiles;
}

bool TileStore::is_shared(CellKey tile) const { return std::ranges::binary_search(by_tile_, tile, {}, &Run::tile); }

Status TileStore::read(const Run& run, std::span<SeamVertex> vertices) const {
  return file_.read(run.first * sizeof(SeamVertex), std::as_writable_bytes(vertices));
}

Status TileStore::write(const Run& run, std::span<const SeamVertex> inner) {
  return file_.write(run.first * sizeof(SeamVertex), std::as_bytes(inner));
}

std::span<const TileStore::Run> TileStore::runs_of(std::uint32_t submesh) const {
  const auto [begin, end] = std::ranges::equal_range(runs_, submesh, {}, &Run::submesh);
  return {begin, end};
}

}  // namespace lxd

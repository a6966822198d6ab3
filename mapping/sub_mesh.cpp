// SPDX-License-Identifier: Apache-2.0
#include "mapping/sub_mesh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "mapping/layer_orientation.hpp"

namespace lxd {
namespace {

// Points whose surface estimate is still vague may be far off it; but beyond this share of the cell they are something
// else.
constexpr float kGateMaxShare = 0.15f;
constexpr int kBatchQuadsMin = 2;  // quads that a look must have seen of a layer to be worth a regression

// A candidate as heights over the lattice plane across `axis`.
class LatticePlane {
 public:
  LatticePlane(const PlaneCandidate& plane, int axis)
      : slope_u_(-plane.normal[axis_u(axis)] / plane.normal[axis]),
        slope_v_(-plane.normal[axis_v(axis)] / plane.normal[axis]),
        height_m_(plane.centre_m[axis] - slope_u_ * plane.centre_m[axis_u(axis)] -
                  slope_v_ * plane.centre_m[axis_v(axis)]) {}
  float operator()(float u_m, float v_m) const { return height_m_ + slope_u_ * u_m + slope_v_ * v_m; }

 private:
  float slope_u_, slope_v_, height_m_;
};

// How the points deviate from the heights that are known, at the vertices.
template <typename Height>
GpPrediction deviation_from(const Height& known_m, GpBatch batch, const GpKernel& kernel) {
  for (int i = 0; i < batch.count; ++i) batch.height_m[i] -= known_m(batch.u_m[i], batch.v_m[i]);
  GpPrediction out;
  regress(batch, kernel, amplitude_of(batch, kernel), out);
  return out;
}

std::size_t hash_slots(std::uint32_t cells) { return std::bit_ceil(std::size_t{cells} * 2); }

}  // namespace

SubMesh::SubMesh(const MappingConfig& config, const SubMeshCapacity& capacity, Arena& arena)
    : config_(config),
      cell_size_(static_cast<float>(config.cell_size_m)),
      inverse_cell_size_(1.0f / cell_size_),
      inverse_spacing_(kQuadsPerEdge / cell_size_),
      kernel_{1.0f / static_cast<float>(config.kernel_length_m), static_cast<float>(config.surface_roughness_m),
              cell_size_},
      cells_(arena.take<Cell>("map cells", capacity.cells)),
      layers_(arena.take<Layer>("map layers", capacity.layers)),
      waiting_(capacity.waiting_blocks, arena),
      next_(arena.take<std::uint32_t>("map point lists", capacity.points_per_sweep)),
      touched_(arena.take<std::uint32_t>("map touched cells", capacity.cells)),
      hash_(arena.take<CellHash::Slot>("map hash", hash_slots(capacity.cells))),
      occupancy_(arena.take<std::uint64_t>("map occupancy", OccupancyFilter::kWords)) {}

void SubMesh::reset(const Eigen::Vector3d& near_world_m, RigTime begin) {
  hash_.clear();
  occupancy_.clear();
  waiting_.clear();
  cell_count_ = layer_count_ = 0;
  counters_ = {};
  origin_ = cell_of(near_world_m, 1.0 / config_.cell_size_m);
  begin_ = end_ = begin;
}

double SubMesh::fill() const {
  return std::max(static_cast<double>(cell_count_) / static_cast<double>(cells_.size()),
                  static_cast<double>(layer_count_) / static_cast<double>(layers_.size()));
}

void SubMesh::insert(std::span<const MapPoint> points, const Eigen::Vector3d& origin_world_m,
                     const Eigen::Vector3f& sensor_m, std::uint32_t sweep) noexcept {
  distribute(points, origin_world_m);
  for (const std::uint32_t index : touched_.first(touched_count_)) {
    Cell& cell = cells_[index];
    const Eigen::Vector3d corner = cell.index.cast<double>() * config_.cell_size_m;
    fuse_cell(cell, points, (origin_world_m - corner).cast<float>(), sensor_m, sweep);
    cell.batch_head = kNone;
  }
}

// Links every point into the list of its cell.
void SubMesh::distribute(std::span<const MapPoint> points, const Eigen::Vector3d& origin_world_m) {
  const CellIndex base = cell_of(origin_world_m, 1.0 / config_.cell_size_m);
  touched_count_ = 0;
  if (is_last_cell(base)) {
    counters_.cells_full += points.size();
    return;
  }
  const Eigen::Vector3f fraction = (origin_world_m / config_.cell_size_m - base.cast<double>()).cast<float>();
  CellIndex last_index = CellIndex::Constant(std::numeric_limits<int>::max());
  std::uint32_t last_cell = kNone;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const CellIndex index =
        base + (points[i].position_m * inverse_cell_size_ + fraction).array().floor().matrix().cast<int>();
    if (index != last_index) {  // consecutive returns mostly fall into one cell
      last_index = index;
      last_cell = find_or_create(index);
    }
    if (last_cell == kNone) {
      ++counters_.cells_full;
      continue;
    }
    Cell& cell = cells_[last_cell];
    if (cell.batch_head == kNone) touched_[touched_count_++] = last_cell;
    next_[i] = cell.batch_head;
    cell.batch_head = i;
  }
}

std::uint32_t SubMesh::find_or_create(const CellIndex& index) {
  const CellKey key = pack(index);
  const std::uint32_t found = hash_.find(key);
  if (found != kNone) return found;
  if (cell_count_ == cells_.size()) return kNone;
  const std::uint32_t created = cell_count_++;
  cells_[created] = {index, {kNone, kNone, kNone}, kNone, kNone, 0};
  hash_.insert(key, created);
  return created;
}

struct SubMesh::Batches {
  std::array<QuadBins, kLayersPerCell> bins;
};

void SubMesh::fuse_cell(Cell& cell, std::span<const MapPoint> points, const Eigen::Vector3f& origin_m,
                        const Eigen::Vector3f& sensor_m, std::uint32_t sweep) {
  if (is_resting(cell, sweep)) return;
  Batches batches;
  for (std::uint32_t i = cell.batch_head; i != kNone; i = next_[i]) {
    const Eigen::Vector3f p_cell = points[i].position_m + origin_m;
    const int k = fitting_layer(cell, p_cell, points[i].variance_m2);
    if (k >= 0) {
      const int axis = layers_[cell.layers[k]].axis;
      batches.bins[k].add(p_cell[axis_u(axis)], p_cell[axis_v(axis)], p_cell[axis], points[i].variance_m2,
                          inverse_spacing_);
    } else {
      wait(cell, p_cell, points[i].variance_m2, sensor_m + origin_m, sweep);
    }
  }
  for (std::uint32_t k = 0; k < cell.layer_count; ++k) {
    const QuadBins& bins = batches.bins[k];
    if (std::popcount(bins.seen()) >= kBatchQuadsMin) fuse_layer(layers_[cell.layers[k]], bins, sensor_m + origin_m);
  }
  if (cell.waiting != kNone && waiting_[cell.waiting].count >= waiting_[cell.waiting].next_attempt)
    try_new_layers(cell);
}

// A cell whose layers are all well known takes points only now and then; the turns are spread over the sweeps.
bool SubMesh::is_resting(const Cell& cell, std::uint32_t sweep) const {
  if (cell.layer_count == 0) return false;
  const auto interval = static_cast<std::uint32_t>(config_.refresh_interval);
  if ((scatter(pack(cell.index)) + sweep) % interval == 0) return false;
  const auto converged = static_cast<float>(config_.converged_sigma_m * config_.converged_sigma_m);
  for (std::uint32_t k = 0; k < cell.layer_count; ++k)
    if (layers_[cell.layers[k]].mean_variance_m2 > converged) return false;
  return true;
}

int SubMesh::fitting_layer(const Cell& cell, const Eigen::Vector3f& p_cell_m, float variance_m2) const {
  const auto gate = static_cast<float>(config_.layer_gate_sigmas * config_.layer_gate_sigmas);
  const float far = kGateMaxShare * cell_size_;
  int best = -1;
  float best_ratio = gate;
  for (std::uint32_t k = 0; k < cell.layer_count; ++k) {
    const LayerDistance d = distance_to(layers_[cell.layers[k]], p_cell_m, inverse_spacing_);
    const float square = d.distance_m * d.distance_m;
    const float ratio = square / (d.variance_m2 + variance_m2 + kernel_.roughness_min_m * kernel_.roughness_min_m);
    if (square > far * far || ratio >= best_ratio) continue;
    best = static_cast<int>(k);
    best_ratio = ratio;
  }
  return best;
}

// Recursive inverse-variance fusion at the vertices (paper, eq. of mu_new and sigma_new^2), written as an innovation:
// what a look leaves open, such as the slope across a strip of points, stays as it is.
void SubMesh::fuse_layer(Layer& layer, const QuadBins& bins, const Eigen::Vector3f& sensor_cell_m) {
  const GpPrediction look = deviation_from(
      [&](float u, float v) { return sample(layer, u, v, inverse_spacing_).height_m; }, bins.batch(), kernel_);
  const auto share = static_cast<float>(1.0 / config_.independent_looks_max);
  for (int i = 0; i < kLayerVertices; ++i) {
    const float s_old = layer.variance_m2[i], s_obs = look.variance_m2[i];
    const float sum = s_old + s_obs;
    layer.height_m[i] += look.mean_m[i] * s_old / sum;
    layer.variance_m2[i] = std::max(s_old * s_obs / sum, std::min(s_old, s_obs * share));
  }
  layer.seen_quads |= bins.seen();
  update_means(layer, inverse_spacing_);
  // Asked at every look, since the few points that a layer is born of may have it wrong.
  layer.side = side_of(layer, sensor_cell_m, cell_size_);
  ++counters_.regressions;
}

// Where the next point goes, or kWaitingMax. Once all slots are taken they remain a fair sample of what was offered
// (reservoir sampling): the first points of a near cell are all of one scan line, which is no surface.
std::size_t SubMesh::waiting_slot(WaitingBlock& block, CellKey key) {
  ++block.offered;
  if (block.count < kWaitingMax) return block.count++;
  return static_cast<std::size_t>(std::min<std::uint64_t>(scatter(key + block.offered) % block.offered, kWaitingMax));
}

void SubMesh::wait(Cell& cell, const Eigen::Vector3f& p_cell_m, float variance_m2, const Eigen::Vector3f& sensor_cell_m,
                   std::uint32_t sweep) {
  if (cell.waiting == kNone && !borrow_block(cell, sweep)) return;
  WaitingBlock& block = waiting_[cell.waiting];
  block.last_sweep = sweep;
  const std::size_t slot = waiting_slot(block, pack(cell.index));
  if (slot == kWaitingMax) return;
  block.points[slot] = quantise(p_cell_m, std::sqrt(variance_m2), inverse_cell_size_);
  block.towards_sensor_m = sensor_cell_m - Eigen::Vector3f::Constant(0.5f * cell_size_);
}

bool SubMesh::borrow_block(Cell& cell, std::uint32_t sweep) {
  if (cell.layer_count == kLayersPerCell) return false;  // no room for another surface in this cell
  const WaitingPool::Loan loan = waiting_.lend(static_cast<std::uint32_t>(&cell - cells_.data()), sweep);
  counters_.waiting_full += loan.block == kNone;
  if (loan.block == kNone) return false;
  if (loan.robbed != kNone) cells_[loan.robbed].waiting = kNone;
  waiting_[loan.block].next_attempt = static_cast<std::uint16_t>(config_.layer_points_min);
  cell.waiting = loan.block;
  return true;
}

// The cell's waiting points make new layers while they can. What is left waits on; when the block is full and no
// surface is in it, the points are vegetation or noise and are given up (paper, "pruned").
void SubMesh::try_new_layers(Cell& cell) {
  WaitingBlock& block = waiting_[cell.waiting];
  std::array<Eigen::Vector3f, kWaitingMax> points;
  while (block.count >= config_.layer_points_min && cell.layer_count < kLayersPerCell) {
    float noise = 0;
    for (int i = 0; i < block.count; ++i) {
      points[i] = position_of(block.points[i], cell_size_);
      noise += variance_of(block.points[i]) / static_cast<float>(block.count);
    }
    const std::span<const Eigen::Vector3f> waiting(points.data(), block.count);
    const PlaneCandidate plane = search_plane(waiting, noise, config_, pack(cell.index) + block.count);
    if (!plane.found || !birth(cell, block, plane, waiting)) break;
    const std::uint16_t kept = remove_members(block, plane.members);
    block.count = kept;
  }
  if (block.count == kWaitingMax || cell.layer_count == kLayersPerCell) block.count = 0;
  block.offered = block.count;
  block.next_attempt = static_cast<std::uint16_t>(
      std::min(kWaitingMax, std::max(config_.layer_points_min, 2 * static_cast<int>(block.count))));
  if (block.count == 0) {
    waiting_.give_back(cell.waiting);
    cell.waiting = kNone;
  }
}

std::uint16_t SubMesh::remove_members(WaitingBlock& block, std::uint32_t members) {
  std::uint16_t kept = 0;
  for (int i = 0; i < block.count; ++i)
    if ((members >> i & 1u) == 0) block.points[kept++] = block.points[i];
  return kept;
}

bool SubMesh::birth(Cell& cell, const WaitingBlock& block, const PlaneCandidate& plane,
                    std::span<const Eigen::Vector3f> points) {
  if (layer_count_ == layers_.size()) {
    ++counters_.layers_full;
    return false;
  }
  const int axis = axis_for(*this, cell.index, plane.normal, cell_size_);
  QuadBins bins;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (plane.members >> i & 1u)
      bins.add(points[i][axis_u(axis)], points[i][axis_v(axis)], points[i][axis], variance_of(block.points[i]),
               inverse_spacing_);
  const float spacing = cell_size_ / kQuadsPerEdge;
  const LatticePlane prior(plane, axis);
  const GpPrediction look = deviation_from(prior, bins.batch(), kernel_);

  Layer& layer = layers_[layer_count_];
  for (int i = 0; i < kLayerVertices; ++i)
    layer.height_m[i] = look.mean_m[i] + prior(spacing * static_cast<float>(i % kVerticesPerEdge),
                                               spacing * static_cast<float>(i / kVerticesPerEdge));
  layer.variance_m2 = look.variance_m2;
  layer.cell = static_cast<std::uint32_t>(&cell - cells_.data());
  layer.seen_quads = bins.seen();
  layer.axis = static_cast<std::uint8_t>(axis);
  const float towards = plane.normal.dot(block.towards_sensor_m) * plane.normal[axis];
  layer.side = towards >= 0 ? std::int8_t{1} : std::int8_t{-1};
  update_means(layer, inverse_spacing_);
  cell.layers[cell.layer_count++] = layer_count_++;
  occupancy_.insert(cell.index);
  ++counters_.regressions;
  return true;
}

}  // namespace lxd

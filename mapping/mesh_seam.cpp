// SPDX-License-Identifier: Apache-2.0
#include "mapping/mesh_seam.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace lxd {
namespace {

constexpr float kCubeShare = 1.6f;      // edge of the search grid's cubes, in spacings: the longest reach of all
constexpr float kWeldReach = 1.0f;      // spacings between two boundary vertices that become one
constexpr float kMoveMax = 1.0f;        // spacings that a vertex is moved by a weld
constexpr float kStitchReach = 1.6f;    // spacings; longest edge of a stitched triangle: a square's diagonal and some
constexpr float kOpposed = -0.5f;       // cosine: patches whose normals differ by more than 120 degrees do not meet
constexpr float kTurnCosineMin = 0.3f;  // between a face's normal before and after a move, and of a stitched face
constexpr float kFlatShare = 0.1f;      // least height of a triangle over its longest edge
constexpr float kPullToMean = 0.02f;    // weight of the mean against the planes: decides where they are parallel
constexpr int kStitchRounds = 4;

// What a step of so many cubes adds to a key.
std::uint64_t key_step(int dx, int dy, int dz) {
  const auto axis = [](int i) { return static_cast<std::uint64_t>(std::int64_t{i}); };
  return (axis(dx) << (2 * kKeyBits)) + (axis(dy) << kKeyBits) + axis(dz);
}

// Height over the longest edge, relative to that edge.
bool is_flat(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const float longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return (b - a).cross(c - a).norm() < kFlatShare * longest;
}

}  // namespace

std::uint64_t MeshSeam::close() {
  const std::uint64_t lost = collect_boundary();
  weld();
  topology_.update_normals();
  for (int round = 0; round < kStitchRounds; ++round) {
    collect_boundary_again();
    if (stitch() == 0) break;
  }
  return lost + no_room_;
}

std::uint64_t MeshSeam::cube_of(const Eigen::Vector3f& p_m) const {
  const float inverse = 1.0f / (kCubeShare * spacing_m_);
  return pack((p_m * inverse).array().floor().cast<int>().matrix());
}

std::uint64_t MeshSeam::collect_boundary() {
  std::uint64_t lost = 0;
  std::size_t count = 0;
  for (std::uint32_t v = 0; v < topology_.vertices().size(); ++v) {
    if (!topology_.on_boundary(v)) continue;
    if (count < storage_.size())
      storage_[count++].vertex = v;
    else
      ++lost;
  }
  sort_boundary(count);
  return lost;
}

void MeshSeam::collect_boundary_again() {
  const auto inside = std::ranges::remove_if(
      boundary_, [&](const BoundaryEntry& entry) { return !topology_.on_boundary(entry.vertex); });
  sort_boundary(boundary_.size() - inside.size());
}

void MeshSeam::sort_boundary(std::size_t count) {
  boundary_ = storage_.first(count);
  for (BoundaryEntry& entry : boundary_) entry.cube = cube_of(topology_.vertex(entry.vertex).position_m);
  std::sort(boundary_.begin(), boundary_.end(), [](const BoundaryEntry& a, const BoundaryEntry& b) {
    return std::tie(a.cube, a.vertex) < std::tie(b.cube, b.vertex);
  });
}

std::size_t MeshSeam::first_in(std::uint64_t cube, std::size_t from) const {
  const auto is_before = [&](std::size_t i) { return boundary_[i].cube < cube; };
  std::size_t low = 0, high = boundary_.size();  // all below low are before, none from high on
  if (from < high && is_before(from)) {
    low = from + 1;
    for (std::size_t step = 1; low + step < high; step *= 2) {
      if (is_before(low + step)) {
        low += step + 1;
      } else {
        high = low + step;
        break;
      }
    }
  } else {
    high = std::min(from, high);
    for (std::size_t step = 1; step <= high; step *= 2) {
      if (is_before(high - step)) {
        low = high - step + 1;
        break;
      }
      high -= step;
    }
  }
  const auto part = boundary_.subspan(low, high - low);
  const auto found = std::ranges::lower_bound(part, cube, {}, &BoundaryEntry::cube);
  return low + static_cast<std::size_t>(found - part.begin());
}

// The keys of a column of three cubes are successive: nine searches.
template <typename Visit>
void MeshSeam::for_each_near(const Eigen::Vector3f& p_m, Visit&& visit) {
  const std::uint64_t lowest = cube_of(p_m) - key_step(1, 1, 1);
  for (int column = 0; column < 9; ++column) {
    const std::uint64_t first = lowest + key_step(column / 3, column % 3, 0);
    std::size_t& found = found_[static_cast<std::size_t>(column)];
    found = first_in(first, found);
    for (std::size_t i = found; i < boundary_.size() && boundary_[i].cube <= first + 2; ++i) visit(boundary_[i].vertex);
  }
}

// Twice: at a corner of three patches the first round makes one of two, the second joins the third.
void MeshSeam::weld() {
  for (int round = 0; round < 2; ++round)
    for (const BoundaryEntry& entry : boundary_) weld_to_nearest(entry.vertex);
}

std::uint32_t MeshSeam::nearest_of_other_axis(std::uint32_t vertex) {
  if (!topology_.has_faces(vertex)) return kNone;
  const MeshVertex& v = topology_.vertex(vertex);
  std::uint32_t best = kNone;
  float best_square = kWeldReach * kWeldReach * spacing_m_ * spacing_m_;
  for_each_near(v.position_m, [&](std::uint32_t other) {
    if (!topology_.has_faces(other) || (topology_.axes(other) & topology_.axes(vertex)) != 0) return;
    const float square = (topology_.vertex(other).position_m - v.position_m).squaredNorm();
    if (square >= best_square || v.normal.dot(topology_.vertex(other).normal) < kOpposed) return;
    best = other;
    best_square = square;
  });
  return best;
}

void MeshSeam::weld_to_nearest(std::uint32_t vertex) {
  const std::uint32_t other = nearest_of_other_axis(vertex);
  if (other == kNone || nearest_of_other_axis(other) != vertex || !topology_.can_merge(vertex, other)) return;
  const Eigen::Vector3f meeting = meeting_point(vertex, other);
  if (!may_move(vertex, meeting) || !may_move(other, meeting)) return;
  MeshVertex& kept = topology_.vertex(vertex);
  kept.position_m = meeting;
  kept.variance_m2 = std::max(kept.variance_m2, topology_.vertex(other).variance_m2);
  topology_.merge(vertex, other);
}

// Least squares of the distances to the planes of the faces around both, drawn to their mean a little.
Eigen::Vector3f MeshSeam::meeting_point(std::uint32_t a, std::uint32_t b) const {
  const Eigen::Vector3f mean = 0.5f * (topology_.vertex(a).position_m + topology_.vertex(b).position_m);
  Eigen::Matrix3f A = kPullToMean * Eigen::Matrix3f::Identity();
  Eigen::Vector3f rhs = Eigen::Vector3f::Zero();
  for (const std::uint32_t v : {a, b}) {
    topology_.around(v, [&](std::uint32_t face, std::uint32_t, std::uint32_t) {
      const Eigen::Vector3f n = topology_.face_normal(face).stableNormalized();
      A += n * n.transpose();
      rhs += n * n.dot(topology_.vertex(v).position_m - mean);
    });
  }
  const Eigen::Vector3f offset = A.llt().solve(rhs);
  return mean + offset;
}

bool MeshSeam::may_move(std::uint32_t vertex, const Eigen::Vector3f& to_m) const {
  bool possible = (to_m - topology_.vertex(vertex).position_m).norm() <= kMoveMax * spacing_m_;
  topology_.around(vertex, [&](std::uint32_t face, std::uint32_t x, std::uint32_t y) {
    const Eigen::Vector3f& px = topology_.vertex(x).position_m;
    const Eigen::Vector3f& py = topology_.vertex(y).position_m;
    const Eigen::Vector3f before = topology_.face_normal(face), after = (px - to_m).cross(py - to_m);
    possible = possible && !is_flat(to_m, px, py) && after.dot(before) > kTurnCosineMin * after.norm() * before.norm();
  });
  return possible;
}

// Every open edge is offered a triangle with the boundary vertex that makes the shortest one. Returns those added.
std::uint64_t MeshSeam::stitch() {
  std::uint64_t added = 0;
  for (const BoundaryEntry& entry : boundary_) {
    const std::uint32_t a = entry.vertex;
    for (bool again = true; again;) {
      again = false;
      std::uint32_t open_b = kNone, open_face = kNone;
      topology_.around(a, [&](std::uint32_t face, std::uint32_t b, std::uint32_t) {
        if (open_b == kNone && !topology_.has_edge(b, a)) open_b = b, open_face = face;
      });
      if (open_b == kNone) break;
      again = stitch_edge(a, open_b, open_face);
      added += again;
    }
  }
  return added;
}

bool MeshSeam::stitch_edge(std::uint32_t a, std::uint32_t b, std::uint32_t face) {
  const Eigen::Vector3f pa = topology_.vertex(a).position_m, pb = topology_.vertex(b).position_m;
  const Eigen::Vector3f normal = topology_.face_normal(face).stableNormalized();
  const float reach = kStitchReach * spacing_m_;
  std::uint32_t best = kNone;
  float best_way = 2 * reach;
  for_each_near(0.5f * (pa + pb), [&](std::uint32_t c) {
    if (c == a || c == b) return;
    const Eigen::Vector3f& pc = topology_.vertex(c).position_m;
    const float way_a = (pc - pa).norm(), way_b = (pc - pb).norm();
    if (std::max(way_a, way_b) > reach || way_a + way_b >= best_way || !fits(a, b, c, normal)) return;
    best = c;
    best_way = way_a + way_b;
  });
  if (best == kNone) return false;
  const auto outcome = topology_.add_face(b, a, best);
  no_room_ += outcome == MeshTopology::Added::no_room;
  return outcome == MeshTopology::Added::yes;
}

// May the triangle (b, a, c) continue the surface beyond the open edge a -> b?
bool MeshSeam::fits(std::uint32_t a, std::uint32_t b, std::uint32_t c, const Eigen::Vector3f& face_normal) const {
  if (topology_.face_of_edge(a, c) != kNone || topology_.has_edge(c, b)) return false;
  const MeshVertex &va = topology_.vertex(a), &vb = topology_.vertex(b), &vc = topology_.vertex(c);
  const Eigen::Vector3f &pa = va.position_m, &pb = vb.position_m, &pc = vc.position_m;
  if (is_flat(pa, pb, pc)) return false;
  const Eigen::Vector3f normal = (pa - pb).cross(pc - pb).stableNormalized();
  if (normal.dot(face_normal) < kTurnCosineMin) return false;
  for (const MeshVertex* v : {&va, &vb, &vc})
    if (normal.dot(v->normal) < kTurnCosineMin) return false;
  return is_free_direction(a, pc) && is_free_direction(b, pc) && is_free_direction(c, 0.5f * (pa + pb));
}

// Does no face around the vertex lie that way already?
bool MeshSeam::is_free_direction(std::uint32_t vertex, const Eigen::Vector3f& towards_m) const {
  constexpr float kMargin = 0.02f;  // sine: along an edge is free
  const MeshVertex& v = topology_.vertex(vertex);
  const Eigen::Vector3f way = (towards_m - v.position_m).stableNormalized();
  bool is_free = true;
  topology_.around(vertex, [&](std::uint32_t, std::uint32_t x, std::uint32_t y) {
    const Eigen::Vector3f to_x = (topology_.vertex(x).position_m - v.position_m).stableNormalized();
    const Eigen::Vector3f to_y = (topology_.vertex(y).position_m - v.position_m).stableNormalized();
    if (to_x.cross(way).dot(v.normal) > kMargin && way.cross(to_y).dot(v.normal) > kMargin) is_free = false;
  });
  return is_free;
}

}  // namespace lxd

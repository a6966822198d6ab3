// SPDX-License-Identifier: Apache-2.0
#include "backend/loops/surfels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lxd {
namespace {

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
  bool operator<(const Keyed& other) const { return key != other.key ? key < other.key : index < other.index; }
};

constexpr int kCoordinateBits = 20;  // a million voxels each way about the sub-mesh's origin
constexpr std::int64_t kCoordinateMax = std::int64_t{1} << (kCoordinateBits - 1);

// 0..5: the axis along which the normal is longest, and its sign.
std::uint64_t facing(const Eigen::Vector3f& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return static_cast<std::uint64_t>(2 * axis + (normal[axis] < 0 ? 1 : 0));
}

bool place_key(const Eigen::Vector3f& p_m, const Eigen::Vector3f& normal, double voxel_m, std::uint64_t& key) {
  key = facing(normal);
  for (int axis = 0; axis < 3; ++axis) {
    const double i = std::floor(static_cast<double>(p_m[axis]) / voxel_m);
    constexpr auto kMax = static_cast<double>(kCoordinateMax);
    if (!(i >= -kMax && i < kMax)) return false;  // as a number: far out no integer holds it
    key = (key << kCoordinateBits) | static_cast<std::uint64_t>(static_cast<std::int64_t>(i) + kCoordinateMax);
  }
  return true;
}

class Sum {
 public:
  void add(const Surfel& s) {
    position_ += s.position_m.cast<double>();
    normal_ += s.normal.cast<double>();
    variance_ += static_cast<double>(s.variance_m2);
    confidence_ += static_cast<double>(s.confidence_pm2);
    ++count_;
  }
  [[nodiscard]] Surfel mean() const {
    const double share = 1.0 / count_;
    return {(position_ * share).cast<float>(), normal_.normalized().cast<float>(),
            static_cast<float>(variance_ * share), static_cast<float>(confidence_)};
  }

 private:
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), normal_ = Eigen::Vector3d::Zero();
  double variance_ = 0, confidence_ = 0;
  int count_ = 0;
};

template <typename SurfelAt>
std::vector<Surfel> merge(std::vector<Keyed>& keyed, const SurfelAt& at) {
  std::sort(keyed.begin(), keyed.end());
  std::vector<Surfel> out;
  for (std::size_t i = 0; i < keyed.size();) {
    Sum sum;
    const std::uint64_t key = keyed[i].key;
    for (; i < keyed.size() && keyed[i].key == key; ++i) sum.add(at(keyed[i].index));
    out.push_back(sum.mean());
  }
  return out;
}

}  // namespace

std::vector<Surfel> thin_surfels(std::span<const MeshVertex> vertices, const ThinningConfig& config) {
  std::vector<Keyed> keyed;
  keyed.reserve(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const MeshVertex& v = vertices[i];
    const bool sound = v.position_m.allFinite() && v.normal.allFinite() && v.variance_m2 >= 0;
    if (!sound || static_cast<double>(v.variance_m2) > config.variance_max_m2) continue;
    std::uint64_t key = 0;
    if (place_key(v.position_m, v.normal, config.voxel_m, key)) keyed.push_back({key, i});
  }
  const auto epsilon = static_cast<float>(config.epsilon_m2);
  return merge(keyed, [&](std::uint32_t i) {
    const MeshVertex& v = vertices[i];
    return Surfel{v.position_m, v.normal, v.variance_m2, 1.0F / (v.variance_m2 + epsilon)};
  });
}

std::vector<Surfel> thin_surfels(std::span<const Surfel> surfels, double voxel_m) {
  std::vector<Keyed> keyed;
  keyed.reserve(surfels.size());
  for (std::uint32_t i = 0; i < surfels.size(); ++i) {
    std::uint64_t key = 0;
    if (place_key(surfels[i].position_m, surfels[i].normal, voxel_m, key)) keyed.push_back({key, i});
  }
  return merge(keyed, [&](std::uint32_t i) { return surfels[i]; });
}

}  // namespace lxd

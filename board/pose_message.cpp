// SPDX-License-Identifier: Apache-2.0
#include "board/pose_message.hpp"

#include <bit>
#include <cstring>

namespace lxd {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::array<char, 4> kMagic{'L', 'X', 'D', 'P'};
constexpr std::uint16_t kVersion = 1;

class Packer {
 public:
  template <typename T>
  void put(const T& value) noexcept {
    std::memcpy(bytes.data() + at, &value, sizeof(value));
    at += sizeof(value);
  }
  void put(const Eigen::Vector3d& v) noexcept {
    for (const double x : {v.x(), v.y(), v.z()}) put(x);
  }

  std::array<std::uint8_t, kPoseMessageBytes> bytes{};
  std::size_t at = 0;
};

}  // namespace

std::array<std::uint8_t, kPoseMessageBytes> encode(const PoseMessage& message) noexcept {
  Packer packer;
  packer.put(kMagic);
  packer.put(kVersion);
  packer.put(static_cast<std::uint16_t>(message.tracked));
  packer.put(message.count);
  packer.put(message.t.ns());
  packer.put(message.reach.ns());
  packer.put(message.T_world_reference.p);
  const Eigen::Quaterniond q = message.T_world_reference.quaternion();
  for (const double x : {q.x(), q.y(), q.z(), q.w()}) packer.put(x);
  packer.put(message.v_world_mps);
  packer.put(message.rate_radps);
  packer.put(message.sigma_m);
  packer.put(message.sigma_rad);
  return packer.bytes;
}

}  // namespace lxd

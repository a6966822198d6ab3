// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/vectornav_encoder.hpp"

#include <bit>

#include "drivers/imu/crc16.hpp"
#include "drivers/ouster/bit_field.hpp"

namespace lxd::sim {
namespace {

constexpr std::size_t kVectorBytes = 3 * sizeof(float);

class Frame {
 public:
  explicit Frame(const VectorNavLayout& layout) : layout_(layout), bytes_(layout.frame_bytes()) {
    bytes_[0] = kVectorNavSync;
    bytes_[1] = layout.groups;
    std::uint8_t* at = &bytes_[2];
    for (std::size_t group = 0; group < kVectorNavGroups; ++group) {
      if ((layout.groups >> group & 1U) == 0) continue;
      bytes_at(0, 2).set(at, layout.fields[group]);
      at += sizeof(std::uint16_t);
    }
  }

  void put(VectorNavField field, std::int64_t value) {
    if (const auto at = layout_.offset_of(field)) bytes_at(0, 8).set(&bytes_[*at], static_cast<std::uint64_t>(value));
  }
  void put(VectorNavField field, std::size_t skip, const Eigen::Vector3d& v) {
    const auto at = layout_.offset_of(field);
    if (!at) return;
    for (int i = 0; i < 3; ++i) {
      bytes_at(4 * i, 4).set(&bytes_[*at + skip], std::bit_cast<std::uint32_t>(static_cast<float>(v[i])));
    }
  }
  std::vector<std::uint8_t> sealed() {
    const std::size_t end = bytes_.size() - kVectorNavCrcBytes;
    const unsigned crc = crc16(std::span(bytes_).subspan(1, end - 1));
    bytes_[end] = static_cast<std::uint8_t>(crc >> 8U);
    bytes_[end + 1] = static_cast<std::uint8_t>(crc);
    return std::move(bytes_);
  }

 private:
  const VectorNavLayout& layout_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

VectorNavLayout vectornav_layout() {
  VectorNavLayout layout;
  layout.add(vectornav::kTimeStartup);
  layout.add(vectornav::kImu);
  return layout;
}

std::vector<std::uint8_t> encode_vectornav(const VectorNavLayout& layout, std::int64_t sensor_ns,
                                           const Inertial& sample) {
  namespace v = vectornav;
  Frame frame(layout);
  for (const VectorNavField field : {v::kTimeStartup, v::kTimeGps, v::kTimeGroupStartup, v::kTimeGroupGps})
    frame.put(field, sensor_ns);
  for (const VectorNavField field : {v::kAngularRate, v::kImuGroupUncompGyro, v::kImuGroupAngularRate})
    frame.put(field, 0, sample.gyro_radps);
  for (const VectorNavField field : {v::kAccel, v::kImu, v::kImuGroupUncompAccel, v::kImuGroupAccel})
    frame.put(field, 0, sample.accel_mps2);
  frame.put(v::kImu, kVectorBytes, sample.gyro_radps);
  return frame.sealed();
}

}  // namespace lxd::sim

// SPDX-License-Identifier: Apache-2.0
// Any bytes as a ROS 1 message of the type that the first byte says; what is accepted can be used.
#include <cmath>
#include <cstdlib>

#include "drivers/ros1/inertial.hpp"
#include "drivers/ros1/livox_points.hpp"
#include "drivers/ros1/picture.hpp"
#include "drivers/ros1/point_cloud.hpp"
#include "drivers/ros1/satellite_fix.hpp"
#include "drivers/ros1/truth_pose.hpp"

namespace {

using namespace lxd;

void want(bool sound) {
  if (!sound) std::abort();
}

void check(const Ros1Scan& scan) {
  for (const Ros1Point& point : scan.points) {
    want(std::isfinite(point.x_m) && std::isfinite(point.y_m) && std::isfinite(point.z_m));
    want(std::isfinite(point.intensity) && point.offset_ns >= 0 && point.offset_ns <= kNanosPerSecond);
  }
}
void check(const Ros1Inertial& sample) { want(sample.gyro_radps.allFinite() && sample.accel_mps2.allFinite()); }
void check(const Ros1Picture& picture) {
  for (std::uint32_t y = 0; y < picture.height; ++y) want(picture.row(y).size() == picture.width * picture.channels);
}
void check(const Ros1CompressedPicture& picture) { want(!picture.data.empty()); }
void check(const Ros1SatelliteFix& fix) { want(!fix.fix.has_position() || std::abs(*fix.fix.latitude_deg) <= 90); }
void check(const Ros1Sentence& sentence) { want(!sentence.text.empty()); }
void check(const Ros1TruthPose& pose) { want(pose.p.allFinite() && std::abs(pose.q.norm() - 1) < 1e-6); }

template <typename Message>
void run(Ros1Fault (*read)(Ros1Reader::Bytes, Message&), Ros1Reader::Bytes bytes) {
  Message message;
  if (read(bytes, message) == Ros1Fault::none) check(message);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Ros1Reader::Bytes bytes(data + 1, size - 1);
  constexpr std::uint8_t kTypes = 9;
  switch (data[0] % kTypes) {
    case 0:
      run(read_ros1_point_cloud, bytes);
      break;
    case 1:
      run(read_ros1_livox_points, bytes);
      break;
    case 2:
      run(read_ros1_inertial, bytes);
      break;
    case 3:
      run(read_ros1_picture, bytes);
      break;
    case 4:
      run(read_ros1_compressed_picture, bytes);
      break;
    case 5:
      run(read_ros1_satellite_fix, bytes);
      break;
    case 6:
      run(read_ros1_sentence, bytes);
      break;
    case 7:
      run(read_ros1_pose, bytes);
      break;
    default:
      run(read_ros1_odometry, bytes);
  }
  return 0;
}

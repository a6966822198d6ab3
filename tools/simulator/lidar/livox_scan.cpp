// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/livox_scan.hpp"

#include <algorithm>
#include <array>

namespace lxd::sim {
namespace {

constexpr double kReachBeyond_m = 5;      // noise may bring a surface beyond the range limit back into it
constexpr double kDiffuseWhite = 150;     // reflectivity of a white diffuse surface; above are retroreflectors
constexpr double kTrailingNoticed = 0.7;  // of the points between two surfaces: the sensor tags them
constexpr double kOutlierNoticed = 0.5;
constexpr std::uint8_t kTrailingTag = 0x02, kOutlierTag = 0x20;  // noise, in the classes of drivers/livox

// The sensor's pose over a packet's half millisecond: a straight line between both ends, which at 10 m/s^2 and
// 10 rad/s^2 is off by less than a micrometre and a microradian.
class StraightMotion {
 public:
  StraightMotion(const Pose& begin, const Pose& end)
      : begin_(begin), way_(end.p - begin.p), q_begin_(begin.R), q_end_(end.R) {}

  [[nodiscard]] Pose at(double part) const {
    return {q_begin_.slerp(part, q_end_).toRotationMatrix(), begin_.p + part * way_};
  }

 private:
  Pose begin_;
  Eigen::Vector3d way_;
  Eigen::Quaterniond q_begin_, q_end_;
};

// The fault kOneVoxel: Cartesian packets can put every shot where another sensor's plate is.
LivoxReturn heaped(const Eigen::Vector3d& direction) {
  constexpr std::uint8_t kReflectivity = 50;
  LivoxReturn wire;
  wire.p_m = Eigen::Vector3d(kPlate_m, 0, 0) + kPlateHalfSide_m * direction;
  wire.reflectivity = kReflectivity;
  return wire;
}

}  // namespace

LivoxScanner::LivoxScanner(const Context& context, const LivoxConfig& config)
    : context_(context), config_(config), returns_(config.returns, context.scene.world()) {}

LivoxFrame LivoxScanner::scan(std::uint64_t number, ShotFault fault) const {
  Random random(context_.seed, config_.sensor + "/frame", number);
  LivoxFrame frame{number, livox_first_packet(number), fault, {}};
  const std::uint64_t packets = livox_first_packet(number + 1) - frame.first_packet;
  frame.shots.reserve(packets * kLivoxPacketPoints);
  Aim aimed;
  std::vector<Hit> hits(kLivoxPacketPoints);
  std::array<Shot, kLivoxLines> before;
  for (std::uint64_t packet = frame.first_packet; packet < frame.first_packet + packets; ++packet) {
    aim(packet, aimed);
    context_.scene.cast(aimed.rays, hits);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const Shot shot{aimed.rays[i], hits[i]};
      Shot& neighbour = before[i % kLivoxLines];
      const Eigen::Vector3d& direction = aimed.directions[i];
      frame.shots.push_back(fault == ShotFault::kOneVoxel
                                ? heaped(direction)
                                : wire_return(returns_.measure(shot, &neighbour, fault, random), direction, random));
      neighbour = shot;
    }
  }
  return frame;
}

void LivoxScanner::aim(std::uint64_t packet, Aim& aim) const {
  const auto pose = [this](double t_s) { return context_.motion.pose(t_s) * config_.T_body_sensor; };
  const StraightMotion motion(pose(livox_shot_s(packet, 0)), pose(livox_shot_s(packet + 1, 0)));
  const auto reach_m = static_cast<float>(config_.returns.range_max_m + kReachBeyond_m);
  aim.rays.clear();
  aim.directions.clear();
  for (std::uint64_t shot = 0; shot < kLivoxPacketPoints; ++shot) {
    const double t_s = livox_shot_s(packet, shot);
    const Pose T_world_sensor = motion.at(static_cast<double>(shot) / static_cast<double>(kLivoxPacketPoints));
    aim.directions.push_back(livox_direction(t_s, shot % kLivoxLines));
    const Eigen::Vector3d direction = T_world_sensor.R * aim.directions.back();
    aim.rays.push_back({T_world_sensor.p.cast<float>(), direction.cast<float>(), static_cast<float>(t_s), reach_m});
  }
}

LivoxReturn LivoxScanner::wire_return(const Return& measured, const Eigen::Vector3d& direction, Random& random) {
  LivoxReturn wire;
  if (!measured.found()) return wire;
  wire.p_m = measured.range_m * direction;
  wire.reflectivity =
      static_cast<std::uint8_t>(std::lround(std::clamp<double>(measured.brightness, 0, 1) * kDiffuseWhite));
  if (measured.trailing && random.chance(kTrailingNoticed)) wire.tag = kTrailingTag;
  if (measured.outlier && random.chance(kOutlierNoticed)) wire.tag = kOutlierTag;
  return wire;
}

}  // namespace lxd::sim

// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/return_model.hpp"

#include <algorithm>
#include <cmath>

namespace lxd::sim {
namespace {

constexpr double kReferenceAlbedo = 0.1;  // data sheets give ranges for it, with nine of ten shots detected
constexpr double kOddsAtReference = 1.0 / 9;
constexpr double kDetectionSlope = 4;  // how fast chances fall beyond: at half the signal, 4 of 10 return
constexpr double kLeastCosine = 0.2;   // noise grows with incidence up to here (78 degrees)
constexpr double kEdge_m = 0.05;       // two surfaces further apart than this make an edge
constexpr double kPulse_m = 1.0;       // echoes of surfaces nearer to each other than this melt into one
constexpr double kOutlierBrightness = 0.05;
constexpr float kEverywhereRange_m = 30, kEverywhereBrightness = 0.3F;

Return fixed_return(float range_m, float brightness) { return {range_m, brightness, brightness, false, false}; }

Eigen::Vector3f place(const Shot& shot) { return shot.ray.origin_m + shot.hit.range_m * shot.ray.direction; }

constexpr ValueRange kRange{0, 1000, "m", "is it in millimetres?"};
constexpr ValueRange kSigma{0, 1, "m", "is it in millimetres?"};
constexpr ValueRange kPart{0, 1, "", "is it in percent?"};

}  // namespace

ReturnConfig without_errors(ReturnConfig config) {
  config.range_sigma_m = config.detection_range_m = config.mixed_part = config.outlier_part = 0;
  return config;
}

void read_keys(YamlSection& section, ReturnConfig& config) {
  section.read("range_min_m", config.range_min_m, kRange);
  section.read("range_max_m", config.range_max_m, kRange);
  section.read("range_sigma_m", config.range_sigma_m, kSigma);
  section.read("detection_range_m", config.detection_range_m, kRange);
  section.read("mixed_part", config.mixed_part, kPart);
  section.read("outlier_part", config.outlier_part, kPart);
  section.read("glass_part", config.glass_part, kPart);
  if (config.range_max_m <= config.range_min_m) {
    section.complain("range_max_m", "found no more than range_min_m, wanted more");
  }
}

Return plate_return(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d at = direction * (kPlate_m / direction.x());
  if (direction.x() <= 0 || std::max(std::abs(at.y()), std::abs(at.z())) > kPlateHalfSide_m) return {};
  return fixed_return(static_cast<float>(at.norm()), kEverywhereBrightness);
}

Return ReturnModel::measure(const Shot& shot, const Shot* neighbour, ShotFault fault, Random& random) const {
  if (fault == ShotFault::kEmpty || fault == ShotFault::kZero) return {};
  const Return sound = measure_sound(shot, neighbour, random);
  if (fault == ShotFault::kMaxPoints && !sound.found()) return fixed_return(kEverywhereRange_m, kEverywhereBrightness);
  return sound;
}

Return ReturnModel::measure_sound(const Shot& shot, const Shot* neighbour, Random& random) const {
  const Hit& hit = shot.hit;
  if (random.chance(config_.outlier_part)) {
    const double farthest_m = std::clamp<double>(hit.range_m, config_.range_min_m, config_.range_max_m);
    Return outlier = fixed_return(static_cast<float>(random.uniform(config_.range_min_m, farthest_m)),
                                  static_cast<float>(kOutlierBrightness));
    outlier.outlier = true;
    return outlier;
  }
  if (!hit.found() || passes_glass(hit, random)) return {};
  Return found;
  double range_m = hit.range_m;
  found.trailing = neighbour != nullptr && mix(shot, *neighbour, random, range_m);
  const double cos_incidence = std::clamp(std::abs(static_cast<double>(hit.normal.dot(shot.ray.direction))), 0.0, 1.0);
  found.albedo = hit.albedo;
  found.brightness = static_cast<float>(hit.albedo * cos_incidence);
  const double strength = signal(range_m, found.brightness);
  if (!detected(strength, random)) return {};
  range_m += noise_m(strength, cos_incidence, random);
  if (range_m < config_.range_min_m || range_m > config_.range_max_m) return {};
  found.range_m = static_cast<float>(range_m);
  return found;
}

bool ReturnModel::passes_glass(const Hit& hit, Random& random) const {
  return world_.materials[hit.material].glass && random.chance(config_.glass_part);
}

// Of a Lambertian surface that fills the beam, as a multiple of the reference surface's at the detection range: the
// LiDAR equation for extended targets (Wagner et al., ISPRS J. Photogramm. 60(2), 2006).
double ReturnModel::signal(double range_m, double brightness) const {
  const double ratio = config_.detection_range_m / std::max(range_m, 1e-3);
  return brightness / kReferenceAlbedo * ratio * ratio;
}

bool ReturnModel::detected(double signal, Random& random) const {
  if (config_.detection_range_m == 0) return true;
  return random.uniform() * (1 + kOddsAtReference * std::pow(signal, -kDetectionSlope)) < 1;
}

bool ReturnModel::mix(const Shot& shot, const Shot& neighbour, Random& random, double& range_m) const {
  if (!neighbour.hit.found() || config_.mixed_part == 0) return false;
  const Eigen::Vector3f apart = place(shot) - place(neighbour);
  const double off_own = std::abs(shot.hit.normal.dot(apart)), off_other = std::abs(neighbour.hit.normal.dot(apart));
  if (std::min(off_own, off_other) < kEdge_m || !random.chance(config_.mixed_part)) return false;
  const double gap_m = neighbour.hit.range_m - shot.hit.range_m;
  if (std::abs(gap_m) > kPulse_m) return false;  // two echoes: the stronger is reported, and it is the shot's own
  range_m += gap_m * random.uniform();
  return true;
}

// Noise grows with incidence as the footprint grows long, and as the signal gets weak: Soudarissanane et al., "Scanning
// geometry: Influencing factor on the quality of terrestrial laser scanning points", ISPRS J. 66(4), 2011.
double ReturnModel::noise_m(double signal, double cos_incidence, Random& random) const {
  if (config_.range_sigma_m == 0) return 0;
  const double weak = config_.detection_range_m == 0 ? 0 : 1 / std::max(signal, 0.25);
  return random.normal(config_.range_sigma_m * std::sqrt(1 + weak) / std::max(cos_incidence, kLeastCosine));
}

}  // namespace lxd::sim

// SPDX-License-Identifier: Apache-2.0
// One pass over the IMU's samples, then one over the sweeps: the order of the noise's draws.
#include "tools/boxroom/recording.hpp"

#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "tools/boxroom/sensors.hpp"
#include "tools/boxroom/world_ply.hpp"

namespace lxd::boxroom {
namespace {

constexpr double kMovingEpoch_s = 1000.0;  // stamp of the moving recording's first firing
constexpr double kLead_s = 0.2;            // truth and IMU begin this long before the first sweep
constexpr double kTruthTail_s = 0.3, kImuTail_s = 0.2;
constexpr double kTruthPeriod_s = 0.01;

// Files below one folder; keeps the first failure and then writes no more.
class Folder {
 public:
  explicit Folder(std::filesystem::path root) : root_(std::move(root)) {}

  void save(const std::filesystem::path& name, std::string_view bytes) {
    if (error_) return;
    const std::filesystem::path path = root_ / name;
    std::error_code code;
    std::filesystem::create_directories(path.parent_path(), code);
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) error_ = Error{fmt::format("{}: cannot be written", path.string())};
  }
  void save(const std::filesystem::path& name, std::span<const float> values) {
    save(name, std::string_view(reinterpret_cast<const char*>(values.data()), values.size_bytes()));
  }

  [[nodiscard]] Status status() const { return error_ ? Status(*error_) : success(); }

 private:
  std::filesystem::path root_;
  std::optional<Error> error_;
};

std::string tum_line(double t_s, const Pose& T) {
  const Eigen::Quaterniond q = T.quaternion();
  return fmt::format("{:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", t_s, T.p.x(), T.p.y(), T.p.z(), q.x(),
                     q.y(), q.z(), q.w());
}

// KITTI's: the upper three rows of the matrix.
std::string kitti_line(const Pose& T) {
  std::string line;
  for (int row = 0; row < 3; ++row)
    line += fmt::format("{:.12g} {:.12g} {:.12g} {:.12g}{}", T.R(row, 0), T.R(row, 1), T.R(row, 2), T.p[row],
                        row < 2 ? " " : "\n");
  return line;
}

std::string yaml_matrix(const Pose& T) {
  std::string rows;
  for (int row = 0; row < 3; ++row)
    rows += fmt::format("[{:.15g}, {:.15g}, {:.15g}, {:.15g}], ", T.R(row, 0), T.R(row, 1), T.R(row, 2), T.p[row]);
  return fmt::format("[{}[0, 0, 0, 1]]", rows);
}

std::string rig_yaml(int beams) {
  return fmt::format(
      "reference: imu\n"
      "imu: {{update_rate: 200, gyroscope_noise_density: 1.061e-4, accelerometer_noise_density: 1.414e-3}}\n"
      "lidar0: {{model: spinning, beams: {}, columns: {}, rate_hz: 10, fov_deg: [-25, 15], range_m: [0.3, 80], "
      "range_sigma_m: 0.01,\n  T_reference_sensor: {}}}\n",
      beams, kColumns, yaml_matrix(body_lidar()));
}

void write_truth(Folder& folder, const Motion& motion, double duration_s) {
  std::string body, lidar;
  for (double t_s = -kLead_s; t_s < duration_s + kTruthTail_s; t_s += kTruthPeriod_s) {
    const Pose T_world_body = motion.world_body(t_s);
    body += tum_line(kMovingEpoch_s + t_s, T_world_body);
    lidar += tum_line(t_s, T_world_body * body_lidar());
  }
  folder.save("moving/truth.tum", body);
  folder.save("frozen/truth.tum", lidar);
}

void write_imu(Folder& folder, const Motion& motion, double duration_s, Noise& noise) {
  std::string csv = "t,gx,gy,gz,ax,ay,az\n";
  for (double t_s = -kLead_s; t_s < duration_s + kImuTail_s; t_s += kImuPeriod_s) {
    const ImuSample sample = measure(motion, t_s, noise);
    const auto &g = sample.angular_rate_rad_s, &a = sample.specific_force_m_s2;
    csv += fmt::format("{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f}\n", kMovingEpoch_s + t_s, g.x(), g.y(), g.z(),
                       a.x(), a.y(), a.z());
  }
  folder.save("moving/imu.csv", csv);
}

void write_sweeps(Folder& folder, const World& world, const Motion& motion, const Options& options, Noise& noise) {
  std::string moving_times, frozen_times, poses;
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    const double begin_s = sweep * kSweepPeriod_s;
    moving_times += fmt::format("{:.9f}\n", kMovingEpoch_s + begin_s);
    frozen_times += fmt::format("{:.9f}\n", begin_s);
    poses += kitti_line(motion.world_body(begin_s) * body_lidar());
    const Turn turn = scan(world, motion, options.beams, begin_s, noise);
    folder.save(fmt::format("moving/lidar0/{:06d}.bin", sweep), turn.moving);
    folder.save(fmt::format("frozen/velodyne/{:06d}.bin", sweep), turn.frozen);
  }
  folder.save("moving/lidar0/times.txt", moving_times);
  folder.save("frozen/times.txt", frozen_times);
  folder.save("frozen/poses.txt", poses);
}

}  // namespace

Status write_recording(const Options& options) {
  const Motion motion(options.rest_s, options.angular_speed);
  Noise noise(options.seed);
  const World world(noise, motion);
  const double duration_s = options.sweeps * kSweepPeriod_s;
  Folder folder(options.out);
  folder.save("world.ply", world_ply(world));
  folder.save("moving/rig.yaml", rig_yaml(options.beams));
  write_truth(folder, motion, duration_s);
  write_imu(folder, motion, duration_s, noise);
  write_sweeps(folder, world, motion, options, noise);
  return folder.status();
}

}  // namespace lxd::boxroom

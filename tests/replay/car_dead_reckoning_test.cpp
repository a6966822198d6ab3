// SPDX-License-Identifier: Apache-2.0
// A real car's minute on a fast road, by IMU and wheels alone: the filter's dead reckoning against the true path. Bytes
// of its bus and a phone's readings go through the product's own readers. The phone lies as it lies; how, its own
// readings and the wheels tell, as whoever writes a rig file would find it.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "drivers/replay/imu_source.hpp"
#include "drivers/replay/wheel_source.hpp"
#include "estimator/motion.hpp"
#include "tests/support/data_folders.hpp"
#include "tests/support/mapping_scene.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/evaluate/align.hpp"

namespace lxd::car_dead_reckoning_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kTrack_m = 1.57, kWheelbase_m = 2.66;
constexpr double kPhoneAhead_m = 1.9, kPhoneUp_m = 1.0;  // of the rear axle: behind the windscreen
constexpr double kStep_s = 0.1;
constexpr double kHeading_s = 10;  // the path's first part, whose direction is taken from the truth
// A phone in a car that drives: its force is shaken, and so is what it reads on average.
constexpr ImuNoise kPhone{3e-4, 0.3, 1e-6, 3e-3, 0, 0};
// Of two tyres that differ by half a thousandth: the rear ones tell 0.004 rad/s of turning that is none.
constexpr double kUnmatchedTyres_radps = 0.5;
constexpr double kBiasSigma_radps = 1e-4;

// The phone's gyroscope reads 3.9 degrees a second at rest, and the car does not rest in this minute: what it reads is
// told from the wheels' turning, or is known as from a stand before it (here: by the true turn of the first 15 s).
enum class GyroBias : std::uint8_t { from_the_wheels, known };

struct Fix {
  double t_s;
  Vector3d p_m;
  Matrix3d R = Matrix3d::Identity();  // of the camera's carrier; of the truth alone
};

std::vector<std::vector<double>> rows_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<std::vector<double>> rows;
  std::string line;
  for (std::getline(in, line); std::getline(in, line);) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream text(line);
    std::vector<double>& row = rows.emplace_back();
    for (double value = 0; text >> value;) row.push_back(value);
  }
  return rows;
}

// The true path, east, north and up of its begin.
std::vector<Fix> truth_of(const std::filesystem::path& path) {
  std::vector<Fix> truth;
  for (const auto& row : rows_of(path))
    truth.push_back(
        {row[0], {row[1], row[2], row[3]}, Eigen::Quaterniond(row[4], row[5], row[6], row[7]).toRotationMatrix()});
  const Vector3d zero = truth.front().p_m, up = zero.normalized();  // by 0.2 degrees: 3 mm of 1 km of way
  Matrix3d E;
  E.row(0) = Vector3d(-up.y(), up.x(), 0).normalized();
  E.row(2) = up;
  E.row(1) = up.cross(E.row(0).transpose());
  for (Fix& fix : truth) fix.p_m = E * (fix.p_m - zero);
  return truth;
}

Vector3d at(const std::vector<Fix>& path, double t_s) {
  const auto after = std::ranges::find_if(path, [&](const Fix& fix) { return fix.t_s >= t_s; });
  if (after == path.begin()) return path.front().p_m;
  if (after == path.end()) return path.back().p_m;
  const Fix &a = *(after - 1), &b = *after;
  return a.p_m + (t_s - a.t_s) / (b.t_s - a.t_s) * (b.p_m - a.p_m);
}

double length_m(const std::vector<Fix>& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i].p_m - path[i - 1].p_m).norm();
  return length;
}

// How the phone lies: force = forward * acceleration + up * g + noise, by least squares over the minute.
Matrix3d found_mount(const std::vector<ImuSample>& imu, const std::vector<WheelSample>& wheel) {
  constexpr std::size_t kApart = 45;  // readings: half a second
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 2, 3> B = Eigen::Matrix<double, 2, 3>::Zero();
  std::size_t k = 0;
  for (std::size_t i = kApart; i < wheel.size(); i += kApart) {
    const WheelSample &a = wheel[i - kApart], &b = wheel[i];
    const Eigen::Vector2d row((b.speed_mps - a.speed_mps) / (b.received - a.received).seconds(), 1);
    Vector3d force = Vector3d::Zero();
    double count = 0;
    for (; k < imu.size() && imu[k].t < b.received; ++k, ++count) force += imu[k].accel_mps2;
    if (count == 0) continue;
    A += row * row.transpose();
    B += row * (force / count).transpose();
  }
  const Eigen::Matrix<double, 2, 3> found = A.ldlt().solve(B);
  const Vector3d up = found.row(1).normalized();
  const Vector3d left = up.cross(found.row(0).transpose()).normalized();
  Matrix3d R_imu_wheel;
  R_imu_wheel << left.cross(up), left, up;
  return R_imu_wheel;
}

class CarMinute : public testing::Test {
 protected:
  void SetUp() override {
    const auto packed = test::shared_data("can/toyota_rav4_60s.candump.xz");
    if (!packed) GTEST_SKIP() << "no LXD_SHARED_DATA with can/toyota_rav4_60s.candump.xz";
    const std::filesystem::path can = packed->parent_path(), folder = folder_.path();
    if (std::system(("xz -dc '" + packed->string() + "' > '" + (folder / kCanLogFile).string() + "'").c_str()) != 0)
      GTEST_SKIP() << "no xz";
    write_imu(can, folder / kImuTextFile);
    truth_ = truth_of(can / "toyota_rav4_truth_ecef.csv");
    read_imu(folder);
  }

  static void write_imu(const std::filesystem::path& can, const std::filesystem::path& path) {
    const auto gyro = rows_of(can / "toyota_rav4_gyro.csv"), accel = rows_of(can / "toyota_rav4_accel.csv");
    ASSERT_EQ(gyro.size(), accel.size());
    std::ofstream out(path);
    out.precision(12);
    out << "t,gx,gy,gz,ax,ay,az\n";
    for (std::size_t i = 0; i < gyro.size(); ++i)
      out << gyro[i][0] << ',' << gyro[i][1] << ',' << gyro[i][2] << ',' << gyro[i][3] << ',' << accel[i][1] << ','
          << accel[i][2] << ',' << accel[i][3] << '\n';
  }
  void read_imu(const std::filesystem::path& folder) {
    auto source = open_imu_source(folder, ImuProtocol::kVectorNav, 115200);
    ASSERT_TRUE(source.ok()) << source.error().message;
    for (ImuSample sample; (*source)->next(sample);) imu_.push_back(sample);
  }
  [[nodiscard]] std::vector<WheelSample> read_wheels(WheelSource kind) const {
    std::vector<WheelSample> samples;
    WheelDecoderConfig config{{}, kind, kTrack_m};
    config.wheelbase_m = kWheelbase_m;
    const auto messages = toyota_messages();
    auto source = open_wheel_source(folder_.path(), {messages.begin(), messages.end()}, config);
    EXPECT_TRUE(source.ok());
    for (WheelSample sample; source.ok() && (*source)->next(sample);) samples.push_back(sample);
    return samples;
  }

  // The body's path by the filter, levelled by the gravity that it has found.
  std::vector<Fix> drive(const std::vector<WheelSample>& wheels, GyroBias bias) {
    const Matrix3d R_imu_wheel = found_mount(imu_, wheels);
    const Vector3d axle = R_imu_wheel * Vector3d(-kPhoneAhead_m, 0, -kPhoneUp_m);
    test::OwnedArena arena(std::size_t{1} << 22);
    MotionSetup setup;
    setup.imu = kPhone;
    setup.wheel =
        WheelModel{{R_imu_wheel, axle}, 0.05, bias == GyroBias::from_the_wheels ? 0.02 : kUnmatchedTyres_radps};
    Motion motion(setup, *arena);
    Ieskf filter;
    std::size_t next_reading = 0, next_wheel = 0;
    const auto feed = [&](RigTime until) {
      for (; next_reading < imu_.size() && imu_[next_reading].t <= until + Duration::from_seconds(0.02); ++next_reading)
        motion.add(InertialReading{imu_[next_reading].t, imu_[next_reading].gyro_radps, imu_[next_reading].accel_mps2});
      for (; next_wheel < wheels.size() && wheels[next_wheel].received <= until; ++next_wheel)
        motion.add(
            WheelReading{wheels[next_wheel].received, wheels[next_wheel].speed_mps, wheels[next_wheel].yaw_rate_radps});
    };
    const RigTime begin = wheels.front().received, first = begin + Duration::from_seconds(kStep_s);
    feed(first);
    Motion::Beginning known = motion.begin(begin, first);
    known.x.v = known.x.R * R_imu_wheel.col(0) * wheels[next_wheel - 1].speed_mps;
    known.x.b_g = -wheels[next_wheel - 1].yaw_rate_radps * R_imu_wheel.col(2);
    filter.reset(known.x, known.P);
    motion.align(known.x, begin, first);
    std::vector<Fix> path;
    for (RigTime now = first; now.seconds() + kStep_s < truth_.back().t_s;
         now = now + Duration::from_seconds(kStep_s)) {
      const RigTime then = now + Duration::from_seconds(kStep_s);
      feed(then);
      motion.predict(filter, now, then);
      if (bias == GyroBias::known && path.empty()) know_bias(filter, R_imu_wheel.col(2));
      path.push_back({then.seconds(), filter.state().p});
    }
    slipping_ = motion.slipping();
    const Matrix3d level = Eigen::Quaterniond::FromTwoVectors(-filter.state().g, Vector3d::UnitZ()).toRotationMatrix();
    for (Fix& fix : path) fix.p_m = level * fix.p_m;
    return path;
  }

  void know_bias(Ieskf& filter, const Vector3d& up_imu) const {
    const auto from = truth_.begin() + 20, to = from + 300;
    Vector3d turned = Vector3d::Zero();
    double count = 0;
    for (const ImuSample& sample : imu_) {
      if (sample.t.seconds() < from->t_s || sample.t.seconds() > to->t_s) continue;
      turned += sample.gyro_radps;
      ++count;
    }
    const Vector3d true_radps = Log(from->R.transpose() * to->R) / (to->t_s - from->t_s);
    Calibration c = filter.calibration();
    auto P = c.P.topLeftCorner<3, 3>();
    c.b_g += up_imu * up_imu.dot(turned / count - true_radps - c.b_g);
    P -= (up_imu.dot(P * up_imu) - kBiasSigma_radps * kBiasSigma_radps) * up_imu * up_imu.transpose();
    filter.replace(c);
  }

  // Of the last pose, when the whole path is aligned as `evaluate` does it.
  [[nodiscard]] double evaluated_end_m(const std::vector<Fix>& path) const {
    std::vector<PosePair> pairs(path.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
      pairs[i].estimate.p = path[i].p_m;
      pairs[i].truth.p = at(truth_, path[i].t_s);
    }
    return (align_path(pairs, 0) * pairs.back().estimate.p - pairs.back().truth.p).norm();
  }

  // Estimate less truth at the end, when the first seconds have the true direction.
  [[nodiscard]] Vector3d error_at_end_m(const std::vector<Fix>& path) const {
    const double begin_s = path.front().t_s, turn_s = begin_s + kHeading_s, end_s = path.back().t_s;
    const auto way = [](const auto& of, double from_s, double to_s) -> Vector3d {
      return at(of, to_s) - at(of, from_s);
    };
    const Vector3d ours = way(path, begin_s, turn_s), theirs = way(truth_, begin_s, turn_s);
    const double heading = std::atan2(theirs.y(), theirs.x()) - std::atan2(ours.y(), ours.x());
    return Exp(Vector3d(0, 0, heading)) * way(path, begin_s, end_s) - way(truth_, begin_s, end_s);
  }

  test::TemporaryFolder folder_;
  std::vector<ImuSample> imu_;
  std::vector<Fix> truth_;
  std::uint64_t slipping_ = 0;
};

// What is left is the wheels' scale: they tell 0.9 % less than the car drives.
TEST_F(CarMinute, ImuAndWheelsEndWithinAHundredthOfTheWay) {
  for (const WheelSource kind : {WheelSource::rear_wheels, WheelSource::four_wheels}) {
    const std::vector<Fix> path = drive(read_wheels(kind), GyroBias::known);
    const double way_m = length_m(truth_);
    EXPECT_GT(way_m, 1000);
    EXPECT_NEAR(length_m(path), way_m, 0.015 * way_m);  // less the first and the last tenths of seconds
    EXPECT_LT(evaluated_end_m(path), 0.01 * way_m);
    EXPECT_LT(error_at_end_m(path).norm(), 0.013 * way_m);  // the direction of the first 10 s alone is known
    EXPECT_LT(slipping_, 10U);
  }
}

// Where nothing tells the gyroscope's bias but tyres that do not match, the path bends.
TEST_F(CarMinute, WithoutAStandTheBiasIsAsGoodAsTheTyres) {
  const double way_m = length_m(truth_);
  EXPECT_LT(evaluated_end_m(drive(read_wheels(WheelSource::rear_wheels), GyroBias::from_the_wheels)), 0.025 * way_m);
  EXPECT_LT(evaluated_end_m(drive(read_wheels(WheelSource::four_wheels), GyroBias::from_the_wheels)), 0.015 * way_m);
}

}  // namespace
}  // namespace lxd::car_dead_reckoning_test

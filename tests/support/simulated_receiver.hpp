// SPDX-License-Identifier: Apache-2.0
// Writes a simulated receiver's log, reads it back, and says for every fix how far it is from the antenna.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/gnss/nmea_parser.hpp"
#include "drivers/replay/nmea_log.hpp"
#include "tests/support/simulated_drive.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/gnss/gnss_writer.hpp"

namespace lxd::test {

inline sim::GnssConfig exact_gnss() {
  sim::GnssConfig config;
  config.antenna_in_reference_m = {0.3, -0.2, 1.4};
  config.enu_yaw_rad = 0.4;
  config.sigma_single_m = config.sigma_float_m = config.sigma_fixed_m = 0;
  config.speed_sigma_mps = config.multipath_m = config.rtk_losses_per_hour = 0;
  return config;
}

class SimulatedReceiver : public testing::Test {
 protected:
  struct Fix {
    GnssFix fix;
    double t_s;               // true time of the epoch, from its place in the log
    Eigen::Vector3d enu_m;    // of the origin
    Eigen::Vector3d error_m;  // east, north, up
  };

  static sim::World open_ground_with_roof(std::uint16_t material = 0) {
    sim::World world = open_ground();
    add_quad(world, {-60, 0, 4}, {120, 0, 0}, {0, 60, 0}, material);
    return world;
  }

  static Eigen::Vector3d antenna_enu(const Drive& drive, const sim::GnssConfig& config, double t_s) {
    return Eigen::AngleAxisd(config.enu_yaw_rad, Eigen::Vector3d::UnitZ()) *
           (drive.motion.at(t_s).T_world_body * config.antenna_in_reference_m);
  }

  std::vector<Fix> read(const Drive& drive, const sim::GnssConfig& config) {
    const auto log = sim::write_gnss(drive.context, config, folder_.path());
    EXPECT_TRUE(log.ok());
    log_ = *log;
    auto reader = NmeaLog::open(folder_ / "gnss.nmea");
    NmeaParser parser;
    std::vector<Fix> fixes;
    const auto frame = EnuFrame::at(config.origin);
    const auto add = [&](const GnssFix& fix) {
      const double t_s = first_epoch_s(drive, config) + static_cast<double>(fixes.size()) / config.rate_hz;
      Fix found{fix, t_s, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
      if (fix.has_position()) {
        found.enu_m = frame->to_enu({*fix.latitude_deg, *fix.longitude_deg, fix.ellipsoid_height_m().value()});
        found.error_m = found.enu_m - antenna_enu(drive, config, t_s);
      }
      fixes.push_back(found);
    };
    for (NmeaChunk chunk; reader->next(chunk);) parser.feed(chunk.bytes, chunk.received, add);
    if (const auto last = parser.flush()) add(*last);
    EXPECT_EQ(reader->garbage(), 0U);
    EXPECT_EQ(fixes.size(), log_.epochs);
    return fixes;
  }

  static std::size_t count(const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
  }

  TemporaryFolder folder_;
  sim::GnssLog log_;

 private:
  // The start is a whole second; UTC is ahead of the rig by the clock's offset.
  static double first_epoch_s(const Drive&, const sim::GnssConfig& config) {
    const double period_s = 1 / config.rate_hz;
    const double phase_s = std::fmod(config.clock.offset_s, period_s);
    return phase_s == 0 ? 0 : period_s - phase_s;
  }
};

}  // namespace lxd::test

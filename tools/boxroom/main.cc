// SPDX-License-Identifier: Apache-2.0
// lxd-boxroom: an exact recording to try the product on, where no sensor is at hand.
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tools/boxroom/recording.hpp"

int main(int argc, char** argv) {
  lxd::boxroom::Options options;
  CLI::App app("Writes an exact recording: a hall with boxes, a spinning LiDAR and an IMU, with the true path.");
  app.add_option("--out", options.out, "Folder for moving/ (generic) and frozen/ (KITTI odometry)")->required();
  app.add_option("--seed", options.seed, "Seed of the world and of the noise")->capture_default_str();
  app.add_option("--angular-speed", options.angular_speed, "Turn this many times as fast, on the same path")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  app.add_option("--sweeps", options.sweeps, "Number of sweeps, 10 a second")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--beams", options.beams, "Beams of the LiDAR")->check(CLI::Range(2, 256))->capture_default_str();
  app.add_option("--rest", options.rest_s, "Seconds at rest before the motion begins")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = app.exit(error) == 0;
    return asked_for_help ? 0 : 2;
  }
  const lxd::Status status = lxd::boxroom::write_recording(options);
  if (status) return 0;
  fmt::print(stderr, "{}\n", status.error().message);
  return 1;
}

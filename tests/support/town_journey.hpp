// SPDX-License-Identifier: Apache-2.0
// A journey through towns, as the back-end of a run hears of it: a sub-mesh a town, key frames a metre apart.
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "board/map_keeper.hpp"
#include "tests/support/loop_scene.hpp"

namespace lxd::test {

inline constexpr int kTownFrames = 9;

// Of the i-th key frame in a town; the body leans and turns.
inline Pose body_in_town(int i) {
  return {Exp(Eigen::Vector3d(0.05, -0.03, 0.4 * i)), Eigen::Vector3d(i - kTownFrames / 2, 0.1 * i, 1.5)};
}

class TownJourney {
 public:
  explicit TownJourney(MapKeeper& keeper, double begin_s = 100) : keeper_(keeper), time_s_(begin_s) {}

  struct Seen {
    RigTime stamp;
    Pose T_world_body, T_town_body;
  };
  // Through a town that odometry has at this pose. What it saw there.
  std::vector<Seen> drive(std::uint32_t seed, const Pose& T_world_town) {
    const RigTime begin = RigTime::from_seconds(time_s_);
    std::vector<Seen> seen;
    for (int i = 0; i < kTownFrames; ++i) {
      SweepOutcome outcome;
      outcome.stamp = RigTime::from_seconds(time_s_);
      outcome.T_world_body = T_world_town * body_in_town(i);
      keeper_.take(outcome, {begin, {0, 0, -9.8}, {}});
      seen.push_back({outcome.stamp, outcome.T_world_body, body_in_town(i)});
      time_s_ += kKeyFrame_s;
    }
    const SyntheticMesh mesh = town(seed);
    SubmeshView view = mesh.view(next_id_++, T_world_town);
    view.first = begin;
    view.last = seen.back().stamp;
    kept_.push_back(keeper_.key_frames_of(view));
    keeper_.take(view);
    return seen;
  }

  [[nodiscard]] const std::vector<std::vector<SubmeshKeyFrame>>& key_frames() const { return kept_; }

 private:
  static constexpr double kKeyFrame_s = 5;  // each sweep becomes one
  MapKeeper& keeper_;
  double time_s_;
  std::int64_t next_id_ = 1000;
  std::vector<std::vector<SubmeshKeyFrame>> kept_;  // of each sub-mesh
};

// An archive of towns, each at its pose.
inline void write_town_map(const std::filesystem::path& file,
                           const std::vector<std::pair<std::uint32_t, Pose>>& towns) {
  auto writer = ArchiveWriter::create(file);
  ASSERT_TRUE(writer.ok());
  std::vector<SubmeshKeyFrame> frames;
  for (int i = 0; i < kTownFrames; ++i) frames.push_back({RigTime::from_seconds(i), body_in_town(i)});
  std::int64_t id = 0;
  for (const auto& [seed, T_map_town] : towns) {
    const SyntheticMesh mesh = town(seed);
    SubmeshView view = mesh.view(id++, T_map_town);
    view.key_frames = frames;
    ASSERT_TRUE(writer->append(view).ok());
  }
  ASSERT_TRUE(writer->finish().ok());
}

}  // namespace lxd::test

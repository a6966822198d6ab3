// SPDX-License-Identifier: Apache-2.0
#include "tools/loops/found_loops.hpp"

#include <fstream>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "rt/so3.hpp"
#include "tools/evaluate/associate.hpp"
#include "tools/evaluate/tum_file.hpp"

namespace lxd {
namespace {

using Json = nlohmann::json;

constexpr double kFalseLoop_m = 0.5, kFalseLoop_rad = 0.05;
constexpr double kTruthGap_s = 0.2;

Pose measured(const Json& loop) {
  const auto T = loop.at("T_from_to").get<std::vector<double>>();
  return {Eigen::Quaterniond(T.at(6), T.at(3), T.at(4), T.at(5)).toRotationMatrix(), {T[0], T[1], T[2]}};
}

// Where the body truly was at each instant that a loop begins or ends at.
std::map<RigTime, Pose> true_poses(const Json& loops, const Trajectory& truth) {
  std::map<RigTime, Pose> poses;
  for (const Json& loop : loops)
    for (const char* const end : {"from_t", "to_t"}) poses[RigTime::from_seconds(loop.at(end).get<double>())];
  Trajectory asked;
  for (const auto& [stamp, none] : poses) asked.poses.push_back({stamp, none});
  poses.clear();
  for (const PosePair& pair : associate(asked, truth, Duration::from_seconds(kTruthGap_s)).pairs)
    poses[pair.stamp] = pair.truth;
  return poses;
}

std::vector<FoundLoop> judged(const Json& loops, const Trajectory& truth) {
  const auto poses = true_poses(loops, truth);
  std::vector<FoundLoop> out;
  for (const Json& loop : loops) {
    FoundLoop found{loop.at("from_t"), loop.at("to_t"), loop.at("by"), loop.at("accepted"), loop.at("sigma_m")};
    const auto from = poses.find(RigTime::from_seconds(found.from_s)),
               to = poses.find(RigTime::from_seconds(found.to_s));
    if (from == poses.end() || to == poses.end()) continue;
    const Pose T = from->second.inverse() * to->second, said = measured(loop);
    found.error_m = (said.p - T.p).norm();
    found.error_rad = Log(T.R.transpose() * said.R).norm();
    out.push_back(found);
  }
  return out;
}

}  // namespace

bool FoundLoop::is_false() const { return error_m > kFalseLoop_m || error_rad > kFalseLoop_rad; }

Result<std::vector<FoundLoop>> judge_found_loops(const std::filesystem::path& run,
                                                 const std::filesystem::path& truth_file) {
  const auto truth = load_tum(truth_file);
  if (!truth) return truth.error();
  try {
    std::ifstream file(run / "report.json");
    return judged(Json::parse(file).at("loops").at("found"), *truth);
  } catch (const Json::exception& e) {
    return Error{
        fmt::format("{}: found no loops.found, wanted a run's report: {}", (run / "report.json").string(), e.what())};
  }
}

}  // namespace lxd

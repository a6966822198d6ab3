// SPDX-License-Identifier: Apache-2.0
#include "tools/loops/finder_trial.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Cholesky>

#include "rt/so3.hpp"
#include "rt/stopwatch.hpp"

namespace lxd {
namespace {

constexpr double kFalse_m = 0.5, kFalse_rad = 0.05;
constexpr double kMillis = 1e3;

TrialLoop judge(const LoopMeasurement& loop, const Places& all) {
  const Pose& from = all.places[static_cast<std::size_t>(loop.from)].T_truth_body;
  const Pose& to = all.places[static_cast<std::size_t>(loop.to)].T_truth_body;
  const Pose truth = from.inverse() * to;
  Vector6d error;
  error.head<3>() = Log(truth.R.transpose() * loop.T_from_to.R);
  error.tail<3>() = loop.T_from_to.p - truth.p;
  return {loop, error.tail<3>().norm(), error.head<3>().norm(), error.dot(loop.covariance.ldlt().solve(error))};
}

bool is_false(const TrialLoop& loop) { return loop.error_m > kFalse_m || loop.error_rad > kFalse_rad; }

class Means {
 public:
  void add(double x) {
    sum_ += x;
    max_ = std::max(max_, x);
    ++count_;
  }
  [[nodiscard]] double mean() const { return count_ > 0 ? sum_ / count_ : 0.0; }
  [[nodiscard]] double max() const { return max_; }

 private:
  double sum_ = 0, max_ = 0;
  int count_ = 0;
};

// Stretches of the way in which a key frame has an older one near that the finder may close with.
std::set<long> revisited_stretches(const Places& all, const TrialConfig& config) {
  std::set<long> out;
  for (const Place& q : all.places)
    for (const Place& c : all.places)
      if (c.submesh + config.finder.submesh_gap <= q.submesh &&
          (q.T_truth_body.p - c.T_truth_body.p).norm() < config.same_m)
        out.insert(std::lround(std::floor(q.path_m / config.stretch_m)));
  return out;
}

std::vector<LoopKeyFrame> key_frames_of(const Places& all, std::int64_t submesh) {
  std::vector<LoopKeyFrame> out;
  for (const Place& place : all.places)
    if (place.submesh == submesh) out.push_back({place.id, place.T_world_body, place.path_m, true});
  return out;
}

void find_all(LoopFinder& finder, const Places& all, Means& find_ms, std::vector<TrialLoop>& out) {
  do {
    const Stopwatch watch;
    const auto loops = finder.find();
    find_ms.add(watch.elapsed().seconds() * kMillis);
    for (const LoopMeasurement& loop : loops) out.push_back(judge(loop, all));
  } while (finder.waiting() > 0);
}

}  // namespace

Result<FinderTrial> try_finder(const std::filesystem::path& run, const std::filesystem::path& truth,
                               const TrialConfig& config) {
  const auto all = load_places(run, truth, config.places);
  if (!all) return all.error();
  const auto archive = Archive::open(run / "map.db");
  if (!archive) return archive.error();
  FinderTrial out;
  LoopFinder finder(config.finder);
  Means add_ms, find_ms;
  const Status read = archive->for_each_submesh([&](const SubmeshView& view) {
    const auto key_frames = key_frames_of(*all, view.id);
    const Stopwatch watch;
    finder.add({view.id, view.T_map_submesh, view.vertices}, key_frames);
    add_ms.add(watch.elapsed().seconds() * kMillis);
    find_all(finder, *all, find_ms, out.loops);
    return success();
  });
  if (!read) return read.error();
  const auto revisits = revisited_stretches(*all, config);
  std::set<long> found;
  for (const TrialLoop& loop : out.loops) {
    out.false_loops += is_false(loop) ? 1 : 0;
    const double path_m = all->places[static_cast<std::size_t>(loop.loop.to)].path_m;
    if (!is_false(loop)) found.insert(std::lround(std::floor(path_m / config.stretch_m)));
  }
  out.revisits = revisits.size();
  out.found = static_cast<std::size_t>(std::count_if(revisits.begin(), revisits.end(), [&](long stretch) {
    return found.contains(stretch) || found.contains(stretch - 1) || found.contains(stretch + 1);
  }));
  out.add_ms_mean = add_ms.mean();
  out.add_ms_max = add_ms.max();
  out.find_ms_mean = find_ms.mean();
  out.find_ms_max = find_ms.max();
  out.bytes = finder.bytes();
  out.counters = finder.counters();
  return out;
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// Finds where the path meets itself: sub-meshes with their key frames in, verified relative poses out. Low priority,
// one thread; bounded memory, bounded work a call, newest key frames first. The same calls give the same loops.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "backend/loop_measurement.hpp"
#include "backend/loops/context_match.hpp"
#include "backend/loops/place_memory.hpp"
#include "backend/loops/verification.hpp"
#include "mapping/mesh.hpp"

namespace lxd {

// Whose world is level: z up, as the filter's is. Of an earlier session's map the world may be another one.
struct LoopKeyFrame {
  std::int64_t id = 0;
  Pose T_world_body;
  double path_m = 0;       // driven until then
  bool pose_known = true;  // false: lost; its pose rules no candidate out
};

struct LoopSubmesh {
  std::int64_t id = 0;
  Pose T_world_submesh;  // by the same estimate as its key frames' poses
  std::span<const MeshVertex> vertices;
};

struct LoopFinderConfig {
  ThinningConfig thinning;
  ContextConfig context;
  ContextMatchConfig match;
  VerificationConfig verification;
  PlaceMemoryConfig memory;
  double place_spacing_m = 1.0;        // of key frames that are remembered
  double loop_spacing_m = 5.0;         // way after a found loop before the next is sought
  std::uint32_t submesh_gap = 3;       // sub-meshes that the filter still registers against: no loop to close
  double drift_share = 0.05;           // of the way between two key frames, that the pose may be wrong by
  double drift_floor_m = 5;            // besides
  double nearby_m = 4;                 // a place this near by the poses is a candidate whatever it looks like
  double context_distance_max = 0.45;  // of candidates by looks
  std::size_t look_ups = 25;           // places that the index gives for one key frame
  std::size_t by_looks = 2;            // best of them that are verified
  std::size_t waiting_max = 512;       // key frames
  std::size_t key_frames_per_call = 8;
  std::size_t verifications_per_call = 4;
};

inline constexpr std::size_t kLoopVerdicts = static_cast<std::size_t>(LoopVerdict::open) + 1;

struct LoopCounters {
  std::uint64_t places = 0, forgotten = 0;
  std::uint64_t waiting_dropped = 0;                    // key frames never asked, since newer ones came faster
  std::uint64_t implausible = 0;                        // look-alikes that the poses rule out
  std::uint64_t surfaces_gone = 0;                      // candidates whose sub-mesh has given up its surfaces
  std::uint64_t proposed = 0;                           // candidates that were verified
  std::array<std::uint64_t, kLoopVerdicts> verdicts{};  // of them, by LoopVerdict
  [[nodiscard]] std::uint64_t accepted() const { return verdicts[0]; }
};

class LoopFinder {
 public:
  explicit LoopFinder(const LoopFinderConfig& config);

  // Where surfaces that were given up are fetched from; without it they are gone.
  void set_source(SubmeshSource source) { memory_.set_source(std::move(source)); }

  // A finished sub-mesh and the key frames that were taken while it was built, in order of time.
  void add(const LoopSubmesh& submesh, std::span<const LoopKeyFrame> key_frames);
  // The same of a map that is finished: is found, does not ask. Its path and frame are its own; `map` is its number.
  void add_earlier(const LoopSubmesh& submesh, std::span<const LoopKeyFrame> key_frames, int map = 0);
  // Where that map's frame lies in this path's world, as of this way: its places near by are candidates whatever they
  // look like, and those far off are none.
  void locate(int map, const Pose& T_world_map, double path_m) { located_[map] = {T_world_map, path_m}; }

  // What follows is a path in a world of its own. All places of the path so far are of finished maps then: `earlier`
  // says of a key frame of which one, and where in it.
  struct Earlier {
    int map;
    Eigen::Vector3d p_map_m;
  };
  void begin_again(const std::function<Earlier(std::int64_t id)>& earlier);

  // Works on what waits, at most as much as a call may. Call again while waiting() is not zero.
  std::vector<LoopMeasurement> find();

  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
  [[nodiscard]] const LoopCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t bytes() const { return memory_.bytes(); }

 private:
  struct Candidate {
    const LoopPlace* place;
    double yaw_rad;
  };
  void remember(const LoopSubmesh& submesh, std::span<const LoopKeyFrame> key_frames, std::optional<int> earlier);
  void wait(const LoopPlace& place);
  [[nodiscard]] bool may_close(const LoopPlace& query, const LoopPlace& candidate) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> in_world(const LoopPlace& place) const;
  [[nodiscard]] bool plausible(const LoopPlace& query, const LoopPlace& candidate) const;
  std::vector<Candidate> candidates_of(const LoopPlace& query);
  void add_nearby(const LoopPlace& query, std::vector<Candidate>& out) const;
  void add_alike(const LoopPlace& query, std::vector<Candidate>& out);
  std::optional<LoopMeasurement> close(const LoopPlace& query, std::size_t& verifications);
  std::optional<LoopMeasurement> verify(const LoopPlace& query, const Surroundings& here, const Candidate& candidate);
  [[nodiscard]] bool closed_near(const LoopPlace& query) const;
  [[nodiscard]] std::optional<Surroundings> surroundings(const LoopPlace& place) const;

  LoopFinderConfig config_;
  PlaceMemory memory_;
  ContextMatcher matcher_;
  std::deque<LoopPlace> waiting_;   // newest last
  std::deque<double> closed_at_m_;  // ways at which loops were found lately
  std::optional<double> last_place_m_;
  struct Located {
    Pose T_world_map;
    double path_m;
  };
  std::map<int, Located> located_;
  LoopCounters counters_;
};

}  // namespace lxd

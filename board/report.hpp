// SPDX-License-Identifier: Apache-2.0
// report.json: what a run measured of itself. Its keys are a contract with the scripts that read it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "backend/graph/noise_levels.hpp"
#include "backend/loop_measurement.hpp"
#include "board/event_log.hpp"
#include "rt/time.hpp"

namespace lxd {

// Milliseconds; zeros when nothing was measured.
struct LatencySummary {
  double mean = 0, p50 = 0, p99 = 0, max = 0;
};

// Every stage is in every report; those that a sensor set does not run stay zero.
inline constexpr std::array<std::string_view, 8> kStages{"predict", "deskew",        "downsample", "lidar_update",
                                                         "raycast", "visual_update", "meshing",    "rotation_guess"};

struct PoolUse {
  std::uint64_t capacity = 0;
  std::uint64_t high_water = 0;
};

struct Degradation {
  std::string from, to;  // sensor sets
  double t_s = 0;        // rig time
};

// Sweeps whose update was not what it should be.
struct UpdateCounts {
  std::uint64_t carried = 0;      // times of silence of the primary LiDAR, through which others carried the pose
  std::uint64_t over_budget = 0;  // sweeps that took longer than they may
  std::uint64_t untracked = 0;    // too few surfaces, or no finite solution: the pose is the prediction
  std::uint64_t degenerate = 0;   // the geometry did not hold every direction
  std::uint64_t not_finite = 0;   // solutions that were no finite numbers
  double nis = 0;  // normalised innovations squared, summed; nis_dimensions when the filter is consistent
  std::uint64_t nis_dimensions = 0;
};

// What the graph had to do, and what it did not believe.
struct BackEndCounts {
  std::uint64_t key_frames = 0;
  LatencySummary key_frame_ms;  // of the graph's work on each
  std::uint64_t loops_proposed = 0, loops_accepted = 0;
  std::uint64_t loops_accepted_by_sight = 0;  // of them
  std::uint64_t fixes = 0;                    // of GNSS, that were heard
  std::uint64_t fixes_used = 0;               // at most one a key frame
  std::optional<NoiseLevels> noise;           // as the fixes told it, in the path's last piece that had any
};

// A loop that was found and verified.
struct ClosedLoop {
  RigTime from, to;  // key frames
  LoopMeasurement measured;
  bool accepted = false;  // by the graph
};

// The search for loops by sight; only where a camera is in use.
struct SightReport {
  std::uint64_t key_frames = 0;                   // that had an image
  std::uint64_t images_gone = 0;                  // had made room before a key frame asked for them
  std::uint64_t unlooked = 0;                     // key frames that came too fast for the search
  std::uint64_t poor = 0;                         // key frames with too few features
  std::uint64_t asked = 0;                        // the others, but for those just behind a loop
  std::uint64_t candidates = 0;                   // that were verified
  std::map<std::string, std::uint64_t> verified;  // by verdict
  std::uint64_t accepted = 0;                     // by the graph
};

// Which map the run is in.
struct MapReport {
  std::string earlier;  // session's archive that it was to be found in; empty: none
  bool localise = false;
  std::optional<double> relocalised_t_s;  // rig time of the first pose that was found there; none: never
  std::uint64_t pieces = 1;               // of the path: one more than the filter began again
  std::uint64_t pieces_apart = 0;         // that nobody knows the place of
  std::uint64_t places = 0;               // loops with the earlier map and between pieces
};

// What a sensor's clock was found to be, against the LiDAR's.
struct DelayReport {
  double delay_s = 0, sigma_s = 0;
};

// How a camera was found to be turned against what the rig file says, about the reference's axes.
struct MountReport {
  std::array<double, 3> turned_deg{}, sigma_deg{};
};

// Colours of the map; only where a camera was to tell them.
struct ColourReport {
  std::uint64_t key_images = 0;          // that colours were told from
  std::uint64_t key_images_dropped = 0;  // had no room, or in a live run no time
  std::uint64_t vertices = 0, vertices_coloured = 0;
  double work_s = 0;  // on the wall, of the thread that tells them
};

// What only a live run has to tell.
struct LiveReport {
  std::uint64_t cycle_overruns = 0;            // sweeps whose registration took longer than the sensor's period
  std::uint64_t threads_missed = 0;            // times that the watchdog saw a thread not come back
  LatencySummary latency_ms;                   // from a sweep's end to its pose
  std::map<std::string, std::uint64_t> poses;  // told to a controller: sent, unheard; empty: nobody is told
  std::map<std::string, std::map<std::string, std::uint64_t>> devices;  // by name and cause
  std::vector<RigEvent> events;
};

struct Report {
  using Counts = std::map<std::string, std::uint64_t>;

  std::uint64_t sweeps = 0;
  double duration_s = 0;        // of the recording
  double real_time_factor = 0;  // duration over the wall-clock time of processing
  int threads = 1;
  LatencySummary sweep_ms;
  std::map<std::string, LatencySummary, std::less<>> stages_ms;
  Counts dropped;                          // by cause: sweeps that were never registered
  std::map<std::string, Counts> rejected;  // by parser, by cause
  std::vector<Degradation> degraded;
  std::vector<std::string> hints;  // what the user should look at
  UpdateCounts updates;
  bool interrupted = false;  // stopped before the recording's end
  // Of the real-time path; nothing where this program cannot count them (a sanitizer's build).
  std::optional<std::uint64_t> rt_allocations;
  std::uint64_t rt_page_faults = 0;
  double peak_rss_mib = 0;
  std::map<std::string, PoolUse> pools;
  BackEndCounts back_end;
  std::optional<SightReport> sight;
  std::vector<ClosedLoop> loops;
  MapReport map;
  std::optional<DelayReport> imu_delay;     // with an IMU
  std::optional<DelayReport> wheel_delay;   // with wheels
  std::optional<DelayReport> camera_delay;  // with a camera
  std::optional<MountReport> camera_mount;  // likewise
  std::optional<MountReport> imu_mount;     // with an IMU
  std::optional<ColourReport> colour;
  std::optional<LiveReport> live;
};

std::string report_json(const Report& report);

// A sentence when the updates surprised the filter by far more than it thought possible; empty: they did not.
std::string surprise_text(const UpdateCounts& updates);
void add_surprise(Report& report);  // to its hints

// What was rejected and dropped, in a sentence's words: "generic: empty_sweep 3; dropped: too_few_points 1".
std::string losses_text(const Report& report);

// Peak resident set of this program so far; 0 without /proc.
double peak_rss_mib();

}  // namespace lxd

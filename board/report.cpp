// SPDX-License-Identifier: Apache-2.0
#include "board/report.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace lxd {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const LatencySummary& ms) {
  return {{"mean", ms.mean}, {"p50", ms.p50}, {"p99", ms.p99}, {"max", ms.max}};
}

Json stages_json(const Report& report) {
  Json stages = Json::object();
  for (const std::string_view stage : kStages) {
    const auto found = report.stages_ms.find(stage);
    stages[std::string(stage)] = to_json(found == report.stages_ms.end() ? LatencySummary{} : found->second);
  }
  return stages;
}

Json degraded_json(const Report& report) {
  Json list = Json::array();
  for (const Degradation& d : report.degraded) list.push_back({{"from", d.from}, {"to", d.to}, {"t", d.t_s}});
  return list;
}

Json pools_json(const Report& report) {
  Json pools = Json::object();
  for (const auto& [name, use] : report.pools)
    pools[name] = {{"capacity", use.capacity}, {"high_water", use.high_water}};
  return pools;
}

Json updates_json(const UpdateCounts& updates) {
  Json json = {{"carried", updates.carried},       {"over_budget", updates.over_budget},
               {"untracked", updates.untracked},   {"degenerate", updates.degenerate},
               {"not_finite", updates.not_finite}, {"nis_per_dimension", nullptr}};
  if (updates.nis_dimensions > 0) json["nis_per_dimension"] = updates.nis / static_cast<double>(updates.nis_dimensions);
  return json;
}

void add_back_end(const BackEndCounts& counts, Json& json) {
  json["loops"] = {{"proposed", counts.loops_proposed}, {"accepted", counts.loops_accepted}};
  json["graph"] = {{"key_frames", counts.key_frames}, {"key_frame_ms", to_json(counts.key_frame_ms)}};
  json["gnss"] = {{"fixes", counts.fixes}, {"used", counts.fixes_used}};
  if (!counts.noise) return;
  json["gnss"]["drift_shown"] = counts.noise->drift_shown();
  json["gnss"]["drift_horizontal"] = counts.noise->drift_horizontal;
  json["gnss"]["drift_vertical"] = counts.noise->drift_vertical;
  json["gnss"]["correlation_s"] = counts.noise->correlation_s;
  json["gnss"]["jitter_s"] = counts.noise->jitter_s;
}

Json sight_json(const SightReport& sight) {
  return {{"key_frames", sight.key_frames},
          {"images_gone", sight.images_gone},
          {"unlooked", sight.unlooked},
          {"poor", sight.poor},
          {"asked", sight.asked},
          {"candidates", sight.candidates},
          {"verified", Json(sight.verified)},
          {"accepted", sight.accepted}};
}

Json loop_json(const ClosedLoop& loop) {
  const Pose& T = loop.measured.T_from_to;
  const Eigen::Quaterniond q = T.quaternion();
  return {{"from_t", loop.from.seconds()},
          {"to_t", loop.to.seconds()},
          {"by", loop.measured.by == LoopSense::sight ? "sight" : "surfaces"},
          {"accepted", loop.accepted},
          {"T_from_to", {T.p.x(), T.p.y(), T.p.z(), q.x(), q.y(), q.z(), q.w()}},
          {"sigma_m", std::sqrt(loop.measured.covariance.diagonal().tail<3>().maxCoeff())}};
}

Json map_json(const MapReport& map) {
  Json json = {{"pieces", map.pieces}, {"pieces_apart", map.pieces_apart}, {"places", map.places}};
  if (map.earlier.empty()) return json;
  json["earlier"] = map.earlier;
  json["localise"] = map.localise;
  json["relocalised"] = map.relocalised_t_s.has_value();
  json["relocalised_t"] = map.relocalised_t_s ? Json(*map.relocalised_t_s) : Json(nullptr);
  return json;
}

Json delay_json(const DelayReport& delay) { return {{"delay_s", delay.delay_s}, {"sigma_s", delay.sigma_s}}; }

Json mount_json(const MountReport& mount) { return {{"turned_deg", mount.turned_deg}, {"sigma_deg", mount.sigma_deg}}; }

Json rejected_json(const Report& report) {
  Json rejected = Json::object();
  for (const auto& [parser, counts] : report.rejected) rejected[parser] = Json(counts);
  return rejected;
}

Json colour_json(const ColourReport& colour) {
  return {{"key_images", colour.key_images},
          {"key_images_dropped", colour.key_images_dropped},
          {"vertices", colour.vertices},
          {"vertices_coloured", colour.vertices_coloured},
          {"work_s", colour.work_s}};
}

Json live_json(const LiveReport& live) {
  Json events = Json::array();
  for (const RigEvent& event : live.events)
    events.push_back({{"t", event.t.seconds()}, {"source", event.source}, {"what", event.what}});
  return {{"cycle_overruns", live.cycle_overruns},  {"threads_missed", live.threads_missed},
          {"latency_ms", to_json(live.latency_ms)}, {"poses", Json(live.poses)},
          {"devices", Json(live.devices)},          {"events", events}};
}

std::string counts_text(const std::string& whose, const Report::Counts& counts) {
  std::string text;
  for (const auto& [cause, count] : counts) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", cause, count);
  return fmt::format("{}: {}", whose, text);
}

}  // namespace

std::string surprise_text(const UpdateCounts& updates) {
  // Sound runs have 1 to 6, carriers that were lost from the start 30.
  constexpr double kSurprise = 15;
  const double nis = updates.nis_dimensions > 0 ? updates.nis / static_cast<double>(updates.nis_dimensions) : 0;
  if (nis <= kSurprise) return {};
  return fmt::format(
      "the updates surprised the filter {:.0f} times as much as they should (1): its path may be lost, or a sensor is "
      "not "
      "what the rig file says",
      nis);
}

void add_surprise(Report& report) {
  if (std::string text = surprise_text(report.updates); !text.empty()) report.hints.push_back(std::move(text));
}

std::string losses_text(const Report& report) {
  std::vector<std::string> parts;
  for (const auto& [parser, counts] : report.rejected) parts.push_back(counts_text(parser, counts));
  if (!report.dropped.empty()) parts.push_back(counts_text("dropped", report.dropped));
  return parts.empty() ? "nothing rejected, nothing dropped" : fmt::format("{}", fmt::join(parts, "; "));
}

std::string report_json(const Report& report) {
  Json json;
  json["sweeps"] = report.sweeps;
  json["duration_s"] = report.duration_s;
  json["real_time_factor"] = report.real_time_factor;
  json["threads"] = report.threads;
  json["sweep_ms"] = to_json(report.sweep_ms);
  json["stages_ms"] = stages_json(report);
  json["dropped"] = Json(report.dropped);
  json["rejected"] = rejected_json(report);
  json["degraded"] = degraded_json(report);
  json["hints"] = report.hints;
  json["updates"] = updates_json(report.updates);
  json["interrupted"] = report.interrupted;
  json["rt_allocations"] = report.rt_allocations ? Json(*report.rt_allocations) : Json(nullptr);
  json["rt_page_faults"] = report.rt_page_faults;
  json["peak_rss_mib"] = report.peak_rss_mib;
  json["pools"] = pools_json(report);
  add_back_end(report.back_end, json);
  if (report.sight) json["loops"]["by_sight"] = sight_json(*report.sight);
  json["loops"]["found"] = Json::array();
  for (const ClosedLoop& loop : report.loops) json["loops"]["found"].push_back(loop_json(loop));
  json["map"] = map_json(report.map);
  if (report.imu_delay) json["imu_delay"] = delay_json(*report.imu_delay);
  if (report.wheel_delay) json["wheel_delay"] = delay_json(*report.wheel_delay);
  if (report.camera_delay) json["camera_delay"] = delay_json(*report.camera_delay);
  if (report.imu_mount) json["imu_mount"] = mount_json(*report.imu_mount);
  if (report.camera_mount) json["camera_mount"] = mount_json(*report.camera_mount);
  if (report.colour) json["colour"] = colour_json(*report.colour);
  if (report.live) json["live"] = live_json(*report.live);
  return json.dump(2) + "\n";
}

// Not getrusage's: it goes on from that of the process that started this one.
double peak_rss_mib() {
  constexpr double kKibibytesPerMebibyte = 1024;
  constexpr std::string_view kPeak = "VmHWM:";
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(kPeak)) return std::strtod(line.c_str() + kPeak.size(), nullptr) / kKibibytesPerMebibyte;
  return 0;
}

}  // namespace lxd

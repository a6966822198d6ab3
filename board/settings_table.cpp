// SPDX-License-Identifier: Apache-2.0
#include "board/settings_table.hpp"

#include <array>

#include "mapping/waiting_points.hpp"

namespace lxd {

// Key and field from one word, so that they cannot differ.
#define LXD_SETTING(field) #field, [](Settings & s) -> SettingRow::Field { return &s.field; }

namespace {

// clang-format off
constexpr auto kRows = std::to_array<SettingRow>({
      {LXD_SETTING(threads), "", 1, 2, "1: reading and registering take turns; 2: reading runs ahead (same result)"},
      {LXD_SETTING(lost_after_s), "s", 0, 3600, "time without a pose that holds, after which the filter begins again and is sought in its own map; 0: never"},

      {LXD_SETTING(replay.kitti_vertical_angle_deg), "deg", -1, 1, "vertical angle added to the points of KITTI raw drives and of odometry sequences with a calib.txt"},
      {LXD_SETTING(replay.sweeps), "", 0, 1e9, "sweeps after which the replay ends; 0: all"},
      {LXD_SETTING(replay.loops), "", 1, 1e6, "times that the recording is played: the odometry begins anew, stamps go on"},

      {LXD_SETTING(estimator.acceleration_density), "m/s^2/sqrt(Hz)", 1e-4, 1e3, "white acceleration of the constant-velocity model"},
      {LXD_SETTING(estimator.angular_acceleration_density), "rad/s^2/sqrt(Hz)", 1e-4, 1e3, "white angular acceleration of the constant-velocity model"},
      {LXD_SETTING(estimator.gap_max_s), "s", 0.05, 60, "time between sweeps after which the velocity no longer carries the pose on"},
      {LXD_SETTING(estimator.rotation_guess), "", 0, 1, "guess the rotation between sweeps from range images"},
      {LXD_SETTING(estimator.range_sigma_m), "m", 1e-4, 1, "standard deviation of one range; the rig's lidar0.range_sigma_m comes before the default"},
      {LXD_SETTING(estimator.bearing_sigma_rad), "rad", 0, 0.1, "standard deviation of a beam's direction and spread"},
      {LXD_SETTING(estimator.range_min_m), "m", 0, 100, "nearer returns are the carrier itself"},
      {LXD_SETTING(estimator.range_max_m), "m", 1, 1000, "farther returns are left out"},
      {LXD_SETTING(estimator.registration_points), "", 100, 8'000, "points wanted for the update after spatial down-sampling"},
      {LXD_SETTING(estimator.budget_ms), "ms", 0, 1000, "wall time of one sweep, beyond which iterations and points are shed; 0: as long as it takes"},
      {LXD_SETTING(estimator.iterations_max), "", 1, 50, "iterations of one update at most"},
      {LXD_SETTING(estimator.normal_sigma_rad), "rad", 0, 0.5, "error of the surfaces' normals: sensitivity below its square is no geometry"},

      {LXD_SETTING(estimator.vision.pixel_sigma_px), "px", 0.05, 10, "standard deviation of a tracked pixel"},
      {LXD_SETTING(estimator.vision.anchor_sigma_m), "m", 0, 1, "standard deviation of an anchor's position against the map that the pose is told from"},
      {LXD_SETTING(estimator.vision.anchor_sigma_rad), "rad", 0, 0.1, "likewise of its attitude"},
      {LXD_SETTING(estimator.vision.range_max_m), "m", 1, 1000, "rays into the map end here"},
      {LXD_SETTING(estimator.vision.rays_per_image), "", 0, 256, "rays into the map for one image at most"},
      {LXD_SETTING(estimator.vision.parallax_min_rad), "rad", 0.001, 1, "between the rays of a triangulation, at least"},

      {LXD_SETTING(mapping.cell_size_m), "m", 0.1, 10, "side of a fine map cell (r_cell of the paper)"},
      {LXD_SETTING(mapping.coarse_factor), "", 2, 20, "side of a coarse map cell, in fine ones"},
      {LXD_SETTING(mapping.kernel_length_m), "m", 0.01, 100, "length of the exponential kernel"},
      {LXD_SETTING(mapping.surface_roughness_m), "m", 1e-4, 1, "prior standard deviation of the surface about its local plane"},
      {LXD_SETTING(mapping.planarity_max_ratio), "", 1, 1e4, "lambda_3 / lambda_2 above which a cell is a line (tau_ns)"},
      {LXD_SETTING(mapping.layer_thickness_max_m), "m", 1e-3, 1, "standard deviation of points about a new layer's plane, at most"},
      {LXD_SETTING(mapping.layer_gate_sigmas), "sigmas", 1, 10, "a point joins a layer within this distance"},
      {LXD_SETTING(mapping.layer_points_min), "", 3, kWaitingMax, "points that make a new layer"},
      {LXD_SETTING(mapping.independent_looks_max), "", 1, 1e4, "looks that count as independent when variances are fused"},
      {LXD_SETTING(mapping.converged_sigma_m), "m", 0, 1, "vertices better than this are refreshed every refresh_interval-th sweep only"},
      {LXD_SETTING(mapping.refresh_interval), "sweeps", 1, 1000, "see converged_sigma_m"},
      {LXD_SETTING(mapping.mesh_sigma_max_m), "m", 1e-3, 10, "vertices worse than this are not exported"},
      {LXD_SETTING(mapping.submesh_path_m), "m", 1, 1e4, "way driven after which a new sub-mesh begins"},

      {LXD_SETTING(colour.from_camera), "", 0, 1, "the map has the colours that a camera sees"},
      {LXD_SETTING(colour.range_max_m), "m", 1, 1000, "colours are not believed from farther away"},

      {LXD_SETTING(loops.by_surfaces), "", 0, 1, "loops are sought by the surfaces of sub-meshes"},
      {LXD_SETTING(loops.by_sight), "", 0, 1, "loops are sought by what a camera sees at key frames"},

      {LXD_SETTING(graph.key_frame_distance_m), "m", 0.1, 100, "way after which a key frame is cut"},
      {LXD_SETTING(graph.key_frame_turn_rad), "rad", 0.05, 3, "turn after which a key frame is cut"},
      {LXD_SETTING(graph.key_frame_time_s), "s", 0.1, 600, "time after which a key frame is cut"},
      {LXD_SETTING(graph.drift_m_per_sqrt_m), "m/sqrt(m)", 0, 1, "least drift of the odometry's position, as a random walk"},
      {LXD_SETTING(graph.drift_rad_per_sqrt_m), "rad/sqrt(m)", 0, 0.1, "likewise of its rotation"},
      {LXD_SETTING(graph.drift_rad_per_sqrt_rad), "rad/sqrt(rad)", 0, 0.1, "likewise for each radian of turning"},
      {LXD_SETTING(graph.tilt_sigma_rad), "rad", 1e-4, 1, "error of the vertical as the IMU feels it"},
      {LXD_SETTING(graph.loop_sigma_m), "m", 0, 10, "a loop closes no better than this"},
      {LXD_SETTING(graph.loop_sigma_rad), "rad", 0, 1, "likewise its rotation"},
      {LXD_SETTING(graph.loop_agreeing_min), "", 1, 100, "loops that must agree before any of them closes"},
      {LXD_SETTING(graph.gnss_sigma_min_m), "m", 1e-3, 100, "a fix is no better than this, whatever the receiver says"},
      {LXD_SETTING(graph.gnss_correlation_s), "s", 0.1, 3600, "time over which the errors of fixes are alike, until they tell"},
      {LXD_SETTING(graph.gnss_delay_s), "s", -1, 1, "age of a fix when it is received, expected; the graph estimates it"},
      {LXD_SETTING(graph.gnss_delay_sigma_s), "s", 1e-4, 1, "how far that may be off"},
      {LXD_SETTING(graph.correction_time_s), "s", 0.01, 60, "time over which T_map_world follows the graph"},
      {LXD_SETTING(graph.work_per_key_frame), "", 1, 1e5, "poses that may be solved for each key frame, on average"},
});
// clang-format on

}  // namespace

#undef LXD_SETTING

std::span<const SettingRow> setting_rows() { return kRows; }

}  // namespace lxd

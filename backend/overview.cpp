// SPDX-License-Identifier: Apache-2.0
// Composition of the overview: two panels of mesh, the path over them, a scale, a title with the sizes.
#include "backend/overview.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "backend/overview_canvas.hpp"
#include "backend/overview_mesh.hpp"

namespace lxd {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Eigen::Vector3d>;

constexpr int kWidth_px = 1800;
constexpr int kHeight_px = 900;
constexpr int kTitle_px = 84;   // of the height, above the panels
constexpr int kFooter_px = 56;  // below
constexpr int kSupersampling = 2;
constexpr double kElevation_rad = 38 * std::numbers::pi / 180;
constexpr double kTurn_rad = 32 * std::numbers::pi / 180;  // of the oblique view against the view from above
constexpr double kPathWidth_px = 2.6;
constexpr double kDepthShading_per_m = 0.9;

struct Scene {
  Points vertices;  // a sample
  Points path;
  Interval heights;
  bool coloured;  // as cameras saw it, not by height
};

Points finite_positions(std::span<const StampedPose> path) {
  Points positions;
  for (const StampedPose& pose : path)
    if (pose.T.p.allFinite()) positions.push_back(pose.T.p);
  return positions;
}

std::vector<double> heights_of(const Points& points) {
  std::vector<double> z;
  for (const Eigen::Vector3d& p : points) z.push_back(p.z());
  return z;
}

constexpr int kPanelWidth_px = kWidth_px / 2;
constexpr int kPanelHeight_px = kHeight_px - kTitle_px - kFooter_px;

// In the raster's own pixels.
Panel make_panel(const Scene& scene, const Eigen::Matrix3d& R_view_map) {
  const Vector2d size_px = kSupersampling * Vector2d(kPanelWidth_px, kPanelHeight_px);
  constexpr double kInset = 0.96;
  return {fit_view(R_view_map, scene.vertices, scene.path, 0.5 * size_px, kInset * size_px),
          Raster(static_cast<int>(size_px.x()), static_cast<int>(size_px.y()))};
}

Vector2d on_canvas(const Panel& panel, const Vector2d& corner_px, const Eigen::Vector3d& p_map) {
  return corner_px + panel.view.project(p_map).head<2>() / kSupersampling;
}

// Leaves out what moves less than a pixel: a long path has a hundred thousand poses.
std::vector<std::pair<Vector2d, double>> path_pixels(const Panel& panel, const Vector2d& corner_px,
                                                     const Points& path) {
  std::vector<std::pair<Vector2d, double>> pixels;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Vector2d at = on_canvas(panel, corner_px, path[i]);
    const double time = static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(path.size() - 1, 1));
    if (pixels.empty() || i + 1 == path.size() || (at - pixels.back().first).norm() >= 1) pixels.emplace_back(at, time);
  }
  return pixels;
}

void draw_mark(Canvas& canvas, const Vector2d& at, const Colour& colour) {
  constexpr double kRadius_px = 6;
  canvas.disc(at, kRadius_px + 2.5, kBackground);
  canvas.disc(at, kRadius_px, colour);
}

void draw_path(Canvas& canvas, const Panel& panel, const Vector2d& corner_px, const Points& path) {
  const auto pixels = path_pixels(panel, corner_px, path);
  if (pixels.empty()) return;
  for (std::size_t i = 1; i < pixels.size(); ++i)
    canvas.line(pixels[i - 1].first, pixels[i].first, kPathWidth_px + 3, kBackground);
  for (std::size_t i = 1; i < pixels.size(); ++i)
    canvas.line(pixels[i - 1].first, pixels[i].first, kPathWidth_px, time_colour(pixels[i].second));
  draw_mark(canvas, pixels.back().first, kEndMark);
  draw_mark(canvas, pixels.front().first, kStartMark);
}

// 1, 2 or 5 times a power of ten.
double round_length(double length_m) {
  const double power = std::pow(10, std::floor(std::log10(length_m)));
  const double digit = length_m / power;
  return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

constexpr double kFooterBaseline_px = kHeight_px - 22;
constexpr double kSmallText_px = 16;

void draw_scale(Canvas& canvas, double pixels_per_m, double left_px) {
  constexpr double kLongest_px = 200;
  const double length_m = round_length(kLongest_px / pixels_per_m);
  const double length_px = length_m * pixels_per_m;
  const Vector2d left(left_px, kFooterBaseline_px - 5), right(left_px + length_px, kFooterBaseline_px - 5);
  const Vector2d tick(0, 5);
  canvas.line(left, right, 2, kInk);
  canvas.line(left - tick, left + tick, 2, kInk);
  canvas.line(right - tick, right + tick, 2, kInk);
  canvas.text(right + Vector2d(12, 5), fmt::format("{:g} m", length_m), kSmallText_px, kInk, Canvas::Anchor::left);
}

void draw_height_key(Canvas& canvas, const Interval& heights, double right_px) {
  constexpr int kLength_px = 160;
  const std::string high = fmt::format("{:.1f} m", heights.high),
                    low = fmt::format("{:.1f}", std::round(10 * heights.low) / 10 + 0.0);
  canvas.text({right_px, kFooterBaseline_px}, high, kSmallText_px, kInk, Canvas::Anchor::right);
  const Vector2d begin(right_px - 72 - kLength_px, kFooterBaseline_px - 5);
  for (int x = 0; x < kLength_px; ++x)
    canvas.line(begin + Vector2d(x, 0), begin + Vector2d(x + 1, 0), 9, height_colour(x / (kLength_px - 1.0)));
  canvas.text(begin + Vector2d(-12, 5), "height  " + low, kSmallText_px, kInk, Canvas::Anchor::right);
}

void draw_path_key(Canvas& canvas, double left_px) {
  draw_mark(canvas, {left_px, kFooterBaseline_px - 5}, kStartMark);
  canvas.text({left_px + 14, kFooterBaseline_px}, "start", kSmallText_px, kInk, Canvas::Anchor::left);
  draw_mark(canvas, {left_px + 80, kFooterBaseline_px - 5}, kEndMark);
  canvas.text({left_px + 94, kFooterBaseline_px}, "end", kSmallText_px, kInk, Canvas::Anchor::left);
}

double length_m(const Points& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

std::string with_thousands(std::uint64_t number) { return fmt::format("{}", fmt::group_digits(number)); }

std::string sizes_line(const Scene& scene, const Archive& archive, const OverviewInfo& info) {
  const Points& points = scene.vertices.empty() ? scene.path : scene.vertices;
  const auto span = [&](const Eigen::Vector3d& axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : points) values.push_back(axis.dot(p));
    const Interval inner = inner_interval(std::move(values), scene.vertices.empty() ? 0 : 0.005);
    return inner.high - inner.low;
  };
  std::string line =
      fmt::format("path {:.1f} m   ·   {:.1f} × {:.1f} × {:.1f} m", length_m(scene.path),
                  span(Eigen::Vector3d::UnitX()), span(Eigen::Vector3d::UnitY()), span(Eigen::Vector3d::UnitZ()));
  if (info.sweeps > 0) line += fmt::format("   ·   {} sweeps", with_thousands(info.sweeps));
  return line + fmt::format("   ·   {} vertices, {} faces in {} sub-mesh{}", with_thousands(archive.totals().vertices),
                            with_thousands(archive.totals().faces), archive.totals().submeshes,
                            archive.totals().submeshes == 1 ? "" : "es");
}

void draw_panel(Canvas& canvas, Panel& panel, int left_px, const Points& path) {
  const Eigen::Vector2i corner_px(left_px, kTitle_px);
  panel.raster.shade_by_depth(kDepthShading_per_m);
  canvas.image(panel.raster, corner_px, kSupersampling);
  canvas.clip(corner_px.cast<double>(), {kPanelWidth_px, kPanelHeight_px});
  draw_path(canvas, panel, corner_px.cast<double>(), path);
  canvas.unclip();
}

void draw_frame(Canvas& canvas, const Scene& scene, double pixels_per_m, const std::string& title,
                const std::string& sizes) {
  constexpr double kMargin_px = 36;
  canvas.text({kMargin_px, 42}, title, 26, kInk, Canvas::Anchor::left, true);
  canvas.text({kMargin_px, 70}, sizes, 17, kFaintInk, Canvas::Anchor::left);
  canvas.line({kPanelWidth_px, kTitle_px + 24}, {kPanelWidth_px, kHeight_px - kFooter_px - 24}, 1, kFaintInk, 0.25);
  draw_scale(canvas, pixels_per_m / kSupersampling, kMargin_px);
  draw_path_key(canvas, kPanelWidth_px + kMargin_px);
  if (!scene.vertices.empty() && !scene.coloured) draw_height_key(canvas, scene.heights, kWidth_px - kMargin_px);
}

}  // namespace

Status write_overview(const std::filesystem::path& png, const Archive& archive, std::span<const StampedPose> path,
                      const OverviewInfo& info) {
  Result<Points> vertices = sample_vertices(archive);
  if (!vertices.ok()) return vertices.error();
  Scene scene{std::move(*vertices), finite_positions(path), {}, archive.totals().coloured()};
  scene.heights = inner_interval(heights_of(scene.vertices), 0.02);
  const double heading = main_heading(scene.vertices.empty() ? scene.path : scene.vertices);
  Canvas canvas(kWidth_px, kHeight_px);
  const std::array directions{look(heading, std::numbers::pi / 2), look(heading + kTurn_rad, kElevation_rad)};
  double pixels_per_m = 1;                               // of the view from above, to which the scale belongs
  for (std::size_t i = 0; i < directions.size(); ++i) {  // one raster at a time: each is millions of pixels
    Panel panel = make_panel(scene, directions[i]);
    if (const Status drawn = draw_mesh(archive, scene.heights, panel); !drawn.ok()) return drawn;
    if (i == 0) pixels_per_m = panel.view.pixels_per_m;
    draw_panel(canvas, panel, static_cast<int>(i) * kPanelWidth_px, scene.path);
  }
  draw_frame(canvas, scene, pixels_per_m, info.title, sizes_line(scene, archive, info));
  return canvas.write_png(png);
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "tools/simulator/camera/motion_blur.hpp"
#include "tools/simulator/camera/shading.hpp"

namespace lxd::sim {
namespace {

using Offset = std::array<float, 2>;  // from a pixel's centre, pixels

// Where all four see the centre's surface, there is no edge in the pixel.
constexpr std::array<Offset, 4> kCorners{{{-0.5F, -0.5F}, {0.5F, -0.5F}, {-0.5F, 0.5F}, {0.5F, 0.5F}}};

// A lattice in the pixel, no two points of which share a row or a column: an edge along either axis is placed to a part
// of kLattice. Lattices are coarse along some slopes, so that every pixel has one of its own: what one errs by, the
// next does not.
constexpr std::size_t kLattice = 32;
std::array<Offset, kLattice> lattice(std::uint32_t pixel) {
  constexpr std::array<std::uint32_t, 4> kSteps{7, 9, 23, 25};
  const std::uint32_t chance = (pixel * 0x9E3779B1U) >> 25U;  // Knuth's multiplicative hash
  const std::uint32_t step = kSteps[chance % 4], first = chance / 4;
  const auto offset = [](std::uint32_t row) { return (static_cast<float>(row) + 0.5F) / kLattice - 0.5F; };
  std::array<Offset, kLattice> offsets{};
  for (std::uint32_t i = 0; i < kLattice; ++i) offsets[i] = {offset(i), offset((step * i + first) % kLattice)};
  return offsets;
}

constexpr std::size_t kEdgesAtOnce = 1024;
constexpr float kCrease = 0.95F;    // cosine between normals that meet in an edge
constexpr float kOffPlane = 0.01F;  // of the range: the neighbour lies on another surface
constexpr int kMeter_px = 40;       // between the pixels that the exposure control looks at

}  // namespace

Renderer::Renderer(const Scene& scene, const CameraConfig& config, const RayTable& rays)
    : scene_(scene), config_(config), table_(rays), model_(intrinsics_of(config)) {}

void Renderer::render(const Trajectory& motion, double begin_s, double exposure_s, RadianceImage& image) {
  const auto T_world_camera = [&](double t_s) { return motion.at(t_s).T_world_body * config_.T_body_sensor; };
  const double middle_s = begin_s + exposure_s / 2;
  const Pose T_world_middle = T_world_camera(middle_s);
  render(T_world_middle, middle_s, image);
  if (!config_.motion_blur) return;
  const ExposureMotion moved{T_world_camera(begin_s).inverse() * T_world_middle,
                             T_world_camera(begin_s + exposure_s).inverse() * T_world_middle};
  blur(model_, table_, moved, image);
}

void Renderer::render(const Pose& T_world_camera, double t_s, RadianceImage& image) {
  image.resize(table_.width(), table_.height(), config_.colour ? 3 : 1);
  const View view{T_world_camera.R.cast<float>(), T_world_camera.p.cast<float>(), static_cast<float>(t_s)};
  cast_centres(view);
  shade_centres(image);
  find_edges(image);
  refine_edges(view, image);
}

double Renderer::metered(const Pose& T_world_camera, double t_s) {
  const View view{T_world_camera.R.cast<float>(), T_world_camera.p.cast<float>(), static_cast<float>(t_s)};
  rays_.clear();
  for (int v = 0; v < table_.height(); v += kMeter_px) {
    for (int u = 0; u < table_.width(); u += kMeter_px) rays_.push_back(ray_of(view, table_.at(u, v)));
  }
  hits_.resize(rays_.size());
  scene_.cast(rays_, hits_);
  double sum = 0;
  for (std::size_t i = 0; i < rays_.size(); ++i)
    sum += std::min(1.0F, luminance(radiance(scene_.world(), hits_[i], rays_[i].direction)));
  return sum / static_cast<double>(rays_.size());
}

Ray Renderer::ray_of(const View& view, const Eigen::Vector3f& direction_camera) const {
  Ray ray;
  ray.origin_m = view.p_world;
  ray.direction = view.R_world_camera * direction_camera;
  ray.t_s = view.t_s;
  ray.spread_rad = table_.spread_rad();
  return ray;
}

void Renderer::cast_centres(const View& view) {
  rays_.clear();
  for (int v = 0; v < table_.height(); ++v) {
    for (int u = 0; u < table_.width(); ++u) rays_.push_back(ray_of(view, table_.at(u, v)));
  }
  hits_.resize(rays_.size());
  scene_.cast(rays_, hits_);
}

void Renderer::store(const Eigen::Array3f& rgb, std::size_t pixel, RadianceImage& image) const {
  if (image.channels == 1) {
    image.radiance[pixel] = luminance(rgb);
  } else {
    std::copy_n(rgb.data(), 3, &image.radiance[3 * pixel]);
  }
}

void Renderer::shade_centres(RadianceImage& image) const {
  for (std::size_t pixel = 0; pixel < hits_.size(); ++pixel) {
    image.range_m[pixel] = hits_[pixel].range_m;
    store(radiance(scene_.world(), hits_[pixel], rays_[pixel].direction), pixel, image);
  }
}

// Whether two rays nearly side by side meet different surfaces.
bool Renderer::differ(const Ray& ray_a, const Hit& a, const Ray& ray_b, const Hit& b) {
  if (!a.found() || !b.found()) return a.found() != b.found();
  if (a.material != b.material || a.mover != b.mover || a.normal.dot(b.normal) < kCrease) return true;
  const Eigen::Vector3f apart = b.range_m * ray_b.direction - a.range_m * ray_a.direction;
  return std::abs(apart.dot(a.normal)) > kOffPlane * a.range_m;
}

bool Renderer::ends_between(std::size_t pixel, std::size_t neighbour) const {
  return differ(rays_[pixel], hits_[pixel], rays_[neighbour], hits_[neighbour]);
}

// Both sides of an end are edges: it lies in one of the two pixels.
void Renderer::find_edges(const RadianceImage& image) {
  edges_.clear();
  std::vector<bool> found(hits_.size(), false);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const std::size_t here = image.index(u, v);
      if (u + 1 < image.width && ends_between(here, here + 1)) found[here] = found[here + 1] = true;
      const std::size_t below = here + static_cast<std::size_t>(image.width);
      if (v + 1 < image.height && ends_between(here, below)) found[here] = found[below] = true;
    }
  }
  for (std::size_t pixel = 0; pixel < found.size(); ++pixel) {
    if (found[pixel]) edges_.push_back(static_cast<std::uint32_t>(pixel));
  }
}

template <typename OffsetsOf>
void Renderer::cast_within(const View& view, std::span<const std::uint32_t> pixels, OffsetsOf offsets_of) {
  const auto width = static_cast<std::uint32_t>(table_.width());
  fine_rays_.clear();
  for (const std::uint32_t pixel : pixels) {
    const int u = static_cast<int>(pixel % width), v = static_cast<int>(pixel / width);
    for (const auto& [du, dv] : offsets_of(pixel)) fine_rays_.push_back(ray_of(view, table_.beside(u, v, du, dv)));
  }
  fine_hits_.resize(fine_rays_.size());
  scene_.cast(fine_rays_, fine_hits_);
}

void Renderer::refine_edges(const View& view, RadianceImage& image) {
  std::span<const std::uint32_t> left(edges_);
  while (!left.empty()) {
    const auto now = left.first(std::min(kEdgesAtOnce, left.size()));
    left = left.subspan(now.size());
    cast_within(view, now, [](std::uint32_t) { return kCorners; });
    split_.clear();
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (splits(now[i], i)) split_.push_back(now[i]);
    }
    cast_within(view, split_, lattice);
    for (std::size_t i = 0; i < split_.size(); ++i) store(mean_of_lattice(i), split_[i], image);
  }
}

// After kCorners were cast for several pixels, the i-th of which is this one.
bool Renderer::splits(std::size_t pixel, std::size_t i) const {
  for (std::size_t k = kCorners.size() * i; k < kCorners.size() * (i + 1); ++k) {
    if (differ(rays_[pixel], hits_[pixel], fine_rays_[k], fine_hits_[k])) return true;
  }
  return false;
}

Eigen::Array3f Renderer::mean_of_lattice(std::size_t i) const {
  Eigen::Array3f sum = Eigen::Array3f::Zero();
  for (std::size_t k = kLattice * i; k < kLattice * (i + 1); ++k)
    sum += radiance(scene_.world(), fine_hits_[k], fine_rays_[k].direction);
  return sum / static_cast<float>(kLattice);
}

}  // namespace lxd::sim

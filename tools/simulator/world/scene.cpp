// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/scene.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <embree3/rtcore.h>

#include "tools/simulator/world/mover_track.hpp"
#include "tools/simulator/world/texture.hpp"

namespace lxd::sim {
namespace {

// No wider instructions than every x86-64-v3 machine has, and one thread to build: the same tree everywhere.
constexpr const char* kDevice = "max_isa=avx2,threads=1,set_affinity=0";
// Embree's range is float arithmetic on the whole triangle; the exact plane moves it by less than this, except where a
// ray grazes: there Embree's own range is the point that lies within the triangle.
constexpr double kRefine_m = 5e-4;
constexpr float kSane2_m2 = 1e18F;

void attach(RTCDevice device, RTCScene scene, const World& world) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* const vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                 sizeof(Eigen::Vector3f), world.vertices.size());
  std::copy(world.vertices.begin(), world.vertices.end(), static_cast<Eigen::Vector3f*>(vertices));
  using Face = std::array<std::uint32_t, 3>;
  void* const faces =
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Face), world.faces.size());
  std::copy(world.faces.begin(), world.faces.end(), static_cast<Face*>(faces));
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

// Embree asserts that its rays are; whoever asks with NaN sees nothing.
bool is_sane(const Ray& ray) {
  return ray.origin_m.squaredNorm() + ray.direction.squaredNorm() < kSane2_m2 && ray.range_max_m >= 0;
}

RTCRayHit to_embree(const Ray& ray) {
  RTCRayHit query{};
  query.ray.org_x = ray.origin_m.x();
  query.ray.org_y = ray.origin_m.y();
  query.ray.org_z = ray.origin_m.z();
  query.ray.dir_x = ray.direction.x();
  query.ray.dir_y = ray.direction.y();
  query.ray.dir_z = ray.direction.z();
  query.ray.tfar = ray.range_max_m;
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return query;
}

struct Plane {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  // unit
};

Plane plane_of(const World& world, std::uint32_t face) {
  const auto [a, b, c] = world.faces[face];
  const Eigen::Vector3d p = world.vertices[a].cast<double>();
  const Eigen::Vector3d u = world.vertices[b].cast<double>() - p;
  const Eigen::Vector3d v = world.vertices[c].cast<double>() - p;
  return {p, u.cross(v).normalized()};
}

// Its longer side, on a surface that is seen askew; no longer than kAskewMax times the shorter.
float footprint_m(const Ray& ray, const Hit& hit) {
  constexpr float kAskewMax = 5;
  return hit.range_m * ray.spread_rad / std::max(-ray.direction.dot(hit.normal), 1 / kAskewMax);
}

// The movers that a batch of rays can meet, each as one ball that holds it during the batch's time.
struct MoverBall {
  const MoverTrack* track;
  Eigen::Vector3f centre_m;
  float radius_m;
};

bool may_meet(const MoverBall& ball, const Ray& ray, float range_m) {
  const Eigen::Vector3f to = ball.centre_m - ray.origin_m;
  const float along = to.dot(ray.direction);
  const float distance2 = to.squaredNorm();
  if (distance2 <= ball.radius_m * ball.radius_m) return true;
  const float reach = range_m + ball.radius_m;
  return along > 0 && distance2 - along * along <= ball.radius_m * ball.radius_m && distance2 <= reach * reach;
}

}  // namespace

struct Scene::Impl {
  struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  };
  struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };

  std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice> device;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene> scene;
  std::vector<MoverTrack> tracks;

  [[nodiscard]] Hit cast(const World& world, const Ray& ray, std::span<const MoverBall> balls) const;
  [[nodiscard]] std::vector<MoverBall> balls(std::span<const Ray> rays) const;
};

std::vector<MoverBall> Scene::Impl::balls(std::span<const Ray> rays) const {
  std::vector<MoverBall> found;
  if (rays.empty() || tracks.empty()) return found;
  const auto [first, last] = std::ranges::minmax_element(rays, {}, &Ray::t_s);
  const float half_s = (last->t_s - first->t_s) / 2;
  for (const MoverTrack& track : tracks) {
    const float radius = track.radius_m() + track.mover().speed_mps * half_s;
    found.push_back({&track, track.at(first->t_s + half_s).centre_m, radius});
  }
  return found;
}

Hit Scene::Impl::cast(const World& world, const Ray& ray, std::span<const MoverBall> balls) const {
  if (!is_sane(ray)) return {};
  RTCRayHit query = to_embree(ray);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene.get(), &context, &query);
  Hit hit;
  Eigen::Vector3f textured_at = Eigen::Vector3f::Zero();
  Eigen::Vector3f textured_normal = Eigen::Vector3f::Zero();
  if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
    const Plane plane = plane_of(world, query.hit.primID);
    const Eigen::Vector3d direction = ray.direction.cast<double>();
    const double facing = plane.normal.dot(direction);
    const double exact = plane.normal.dot(plane.point - ray.origin_m.cast<double>()) / facing;
    const double range = std::abs(exact - query.ray.tfar) < kRefine_m ? exact : query.ray.tfar;
    hit.range_m = static_cast<float>(range);
    hit.face = query.hit.primID;
    hit.material = world.face_material[hit.face];
    textured_normal = plane.normal.cast<float>();
    hit.normal = facing > 0 ? Eigen::Vector3f(-textured_normal) : textured_normal;
    textured_at = (ray.origin_m.cast<double>() + range * direction).cast<float>();
  }
  for (const MoverBall& ball : balls) {
    if (!ray.movers || !may_meet(ball, ray, std::min(hit.range_m, ray.range_max_m))) continue;
    const auto box = ball.track->entered_by(ray.origin_m, ray.direction, ray.t_s);
    if (!box || box->range_m >= hit.range_m || box->range_m > ray.range_max_m) continue;
    hit.range_m = box->range_m;
    hit.normal = box->normal;
    hit.material = ball.track->mover().material;
    hit.mover = true;
    textured_at = box->local_m;
    textured_normal = box->local_normal;
  }
  if (hit.found())
    hit.albedo = textured_albedo(world.materials[hit.material], hit.material, textured_at, textured_normal,
                                 footprint_m(ray, hit));
  return hit;
}

Scene::Scene(const World& world) : world_(world), impl_(std::make_unique<Impl>()) {
  impl_->device.reset(rtcNewDevice(kDevice));
  impl_->scene.reset(rtcNewScene(impl_->device.get()));
  rtcSetSceneFlags(impl_->scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(impl_->scene.get(), RTC_BUILD_QUALITY_HIGH);
  attach(impl_->device.get(), impl_->scene.get(), world);
  rtcCommitScene(impl_->scene.get());
  for (const Mover& mover : world.movers) impl_->tracks.emplace_back(mover);
}

Scene::~Scene() = default;

Hit Scene::cast(const Ray& ray) const {
  if (!ray.movers) return impl_->cast(world_, ray, {});
  return impl_->cast(world_, ray, impl_->balls({&ray, 1}));
}

void Scene::cast(std::span<const Ray> rays, std::span<Hit> hits) const {
  const std::vector<MoverBall> balls = impl_->balls(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = impl_->cast(world_, rays[i], balls);
}

}  // namespace lxd::sim

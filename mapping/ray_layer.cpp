// SPDX-License-Identifier: Apache-2.0
#include "mapping/ray_layer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lxd {
namespace {

constexpr float kBeyondCell = 0.5f;  // spacings that a surface may stick out of its cell
constexpr float kBorder = 0.2f;      // spacings that it goes on beyond its square: neighbours differ in height at the
                                     // border, and no ray may slip through the step
constexpr float kStepSigmas = 3.0f;  // and a grazing ray that enters this little behind the surface has met it there,
constexpr float kStepMax = 0.1f;     // at most as many spacings
constexpr float kSlack = 1e-4f;      // spacings: a crossing on the line between two quads belongs to both
constexpr float kSensitivityMin2 =
    1e-6f;  // of the squared change of height a metre: grazing rays know little, not nothing

struct Interval {
  float begin, end;
  [[nodiscard]] bool empty() const { return !(begin <= end); }
};

void clip(float at, float direction, float low, float high, Interval& interval) {
  if (direction == 0) {
    if (at < low || at > high) interval = {1, 0};
    return;
  }
  const float a = (low - at) / direction, b = (high - at) / direction;
  interval.begin = std::max(interval.begin, std::min(a, b));
  interval.end = std::min(interval.end, std::max(a, b));
}

// The ray over one layer: u, v in spacings, height w and way in metres.
struct LayerRay {
  LayerRay(const Layer& layer, const CellRay& ray)
      : spacing_m(ray.cell_size_m / kQuadsPerEdge),
        u(ray.entry_m[axis_u(layer.axis)] / spacing_m),
        v(ray.entry_m[axis_v(layer.axis)] / spacing_m),
        w(ray.entry_m[layer.axis]),
        du(ray.direction[axis_u(layer.axis)] / spacing_m),
        dv(ray.direction[axis_v(layer.axis)] / spacing_m),
        dw(ray.direction[layer.axis]) {}

  // Where the ray may meet the layer.
  [[nodiscard]] Interval reach(const CellRay& ray) const {
    Interval interval{-std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};
    clip(u, du, -kBorder, kQuadsPerEdge + kBorder, interval);
    clip(v, dv, -kBorder, kQuadsPerEdge + kBorder, interval);
    clip(w, dw, -kBeyondCell * spacing_m, ray.cell_size_m + kBeyondCell * spacing_m, interval);
    return interval;
  }

  float spacing_m, u, v, w, du, dv, dw;
};

// h = h00 + a A + b B + a b C over one quad, a and b in 0..1.
struct Quad {
  Quad(const Layer& layer, int iu, int iv) {
    const auto* h = &layer.height_m[iv * kVerticesPerEdge + iu];
    h00 = h[0];
    A = h[1] - h[0];
    B = h[kVerticesPerEdge] - h[0];
    C = h[kVerticesPerEdge + 1] - h[1] - B;
  }
  float h00, A, B, C;
};

// Least root of c + b t + a t^2 in the interval; none: NaN. Stable for a near zero (Press et al., section 5.6).
float least_root(float a, float b, float c, const Interval& within) {
  const float discriminant = b * b - 4 * a * c;
  if (!(discriminant >= 0)) return std::numeric_limits<float>::quiet_NaN();
  const float q = -0.5f * (b + std::copysign(std::sqrt(discriminant), b));
  float best = std::numeric_limits<float>::quiet_NaN();
  for (const float t : {a != 0 ? q / a : best, q != 0 ? c / q : (c == 0 ? 0.0f : best)})
    if (t >= within.begin && t <= within.end && !(best <= t)) best = t;
  return best;
}

// Where w(t) = h(u(t), v(t)) on the quad, within the interval.
float crossing_in(const Quad& quad, const LayerRay& r, int iu, int iv, const Interval& interval) {
  const float t0 = interval.begin;
  const float a = r.u + t0 * r.du - static_cast<float>(iu), b = r.v + t0 * r.dv - static_cast<float>(iv);
  const float c0 = r.w + t0 * r.dw - (quad.h00 + a * quad.A + b * quad.B + a * b * quad.C);
  const float c1 = r.dw - (r.du * quad.A + r.dv * quad.B + (a * r.dv + b * r.du) * quad.C);
  const float slack = kSlack * r.spacing_m;
  return t0 + least_root(-r.du * r.dv * quad.C, c1, c0, {-slack, interval.end - t0 + slack});
}

// Does the ray enter the layer's square just behind the surface, on its way from it? It then crossed at the border.
bool crossed_at_border(const Layer& layer, const LayerRay& r, float t) {
  const SurfaceSample s =
      sample(layer, (r.u + t * r.du) * r.spacing_m, (r.v + t * r.dv) * r.spacing_m, 1.0f / r.spacing_m);
  const float above = r.w + t * r.dw - s.height_m;
  const float along = r.dw - r.spacing_m * (s.slope_u * r.du + s.slope_v * r.dv);
  return above * along > 0 && above * above < kStepSigmas * kStepSigmas * s.variance_m2 &&
         std::abs(above) < kStepMax * r.spacing_m;
}

LayerCrossing describe(const Layer& layer, const LayerRay& r, float t) {
  const SurfaceSample s =
      sample(layer, (r.u + t * r.du) * r.spacing_m, (r.v + t * r.dv) * r.spacing_m, 1.0f / r.spacing_m);
  const float along = r.dw - r.spacing_m * (s.slope_u * r.du + s.slope_v * r.dv);  // d(w - h) / dt
  const float cosine = 1.0f / std::sqrt(1.0f + s.slope_u * s.slope_u + s.slope_v * s.slope_v);
  const float sign = along > 0 ? -cosine : cosine;
  LayerCrossing out;
  out.along_m = t;
  out.variance_m2 = s.variance_m2 / std::max(along * along, kSensitivityMin2);
  out.normal[layer.axis] = sign;
  out.normal[axis_u(layer.axis)] = -sign * s.slope_u;
  out.normal[axis_v(layer.axis)] = -sign * s.slope_v;
  out.front = (along < 0) == (layer.side > 0);
  return out;
}

int quad_at(float x) { return std::clamp(static_cast<int>(std::floor(x)), 0, kQuadsPerEdge - 1); }

// Along one lattice direction: the quad, and where the ray leaves it.
struct QuadWalk {
  QuadWalk(float at, float slope, float begin) : position(at), rate(slope), quad(quad_at(at + begin * slope)) {}
  [[nodiscard]] float leaves_at() const {
    if (rate == 0 || quad == (rate > 0 ? kQuadsPerEdge - 1 : 0)) return std::numeric_limits<float>::infinity();
    return (static_cast<float>(quad + (rate > 0 ? 1 : 0)) - position) / rate;
  }
  void advance() { quad += rate > 0 ? 1 : -1; }
  float position, rate;
  int quad;
};

}  // namespace

bool first_crossing(const Layer& layer, const CellRay& ray, std::uint32_t quads, LayerCrossing& crossing) noexcept {
  const LayerRay r(layer, ray);
  Interval rest = r.reach(ray);
  if (rest.empty()) return false;
  QuadWalk u(r.u, r.du, rest.begin), v(r.v, r.dv, rest.begin);
  const auto deliver = [&](float t) {
    crossing = describe(layer, r, t);
    crossing.quad = v.quad * kQuadsPerEdge + u.quad;
    return true;
  };
  const auto wanted = [&] { return (quads >> (v.quad * kQuadsPerEdge + u.quad) & 1u) != 0; };
  if (wanted() && crossed_at_border(layer, r, rest.begin)) return deliver(rest.begin);
  while (true) {
    const float u_exit = u.leaves_at(), v_exit = v.leaves_at();
    const Interval here{rest.begin, std::clamp(std::min(u_exit, v_exit), rest.begin, rest.end)};
    const float t = crossing_in(Quad(layer, u.quad, v.quad), r, u.quad, v.quad, here);
    if (wanted() && !std::isnan(t)) return deliver(t);
    rest.begin = here.end;
    if (!(rest.begin < rest.end)) return false;
    (u_exit < v_exit ? u : v).advance();
  }
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
#include "backend/loops/plan_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

namespace lxd {
namespace {

constexpr float kStanding = 0.5F;  // |z| of normals that are a wall's
constexpr double kExtent_m = 48;   // of the plan, each way

bool stands(const Surfel& s) { return std::abs(s.normal.z()) < kStanding; }

// Which cells, or their neighbours, have a standing surface. A cell beyond the plan has none.
class Plan {
 public:
  Plan(std::span<const Surfel> surfels, double cell_m)
      : cell_m_(cell_m),
        half_(static_cast<int>(kExtent_m / cell_m)),
        side_(2 * half_ + 1),
        taken_(static_cast<std::size_t>(side_ * side_), 0) {
    for (const Surfel& s : surfels) {
      if (!stands(s)) continue;
      const int x = cell(s.position_m.x()), y = cell(s.position_m.y());
      mark(x, y, kFull);
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) mark(x + dx, y + dy, kBeside);
    }
  }

  [[nodiscard]] int cell(double x_m) const { return static_cast<int>(std::floor(x_m / cell_m_)) + half_; }
  [[nodiscard]] int score(int x, int y) const { return inside(x, y) ? taken_[index(x, y)] : 0; }
  static constexpr int kFull = 2;

 private:
  static constexpr int kBeside = 1;
  [[nodiscard]] bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < side_ && y < side_; }
  [[nodiscard]] std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * side_ + x); }
  void mark(int x, int y, int value) {
    if (!inside(x, y)) return;
    std::uint8_t& cell = taken_[index(x, y)];
    cell = std::max(cell, static_cast<std::uint8_t>(value));
  }

  double cell_m_;
  int half_, side_;
  std::vector<std::uint8_t> taken_;
};

struct Cells {
  std::vector<Eigen::Vector2i> cells;  // of the query, turned; each once
};

Cells turned_cells(std::span<const Surfel> query, double yaw_rad, const Plan& plan) {
  const Eigen::Rotation2Df turn(static_cast<float>(yaw_rad));
  Cells out;
  for (const Surfel& s : query) {
    if (!stands(s) || s.position_m.head<2>().norm() > static_cast<float>(kExtent_m)) continue;
    const Eigen::Vector2f p = turn * Eigen::Vector2f(s.position_m.head<2>());
    out.cells.emplace_back(plan.cell(p.x()), plan.cell(p.y()));
  }
  const auto before = [](const Eigen::Vector2i& a, const Eigen::Vector2i& b) {
    return a.y() != b.y() ? a.y() < b.y() : a.x() < b.x();
  };
  std::sort(out.cells.begin(), out.cells.end(), before);
  out.cells.erase(std::unique(out.cells.begin(), out.cells.end()), out.cells.end());
  return out;
}

double score_at(const Cells& query, const Plan& plan, int dx, int dy) {
  if (query.cells.empty()) return 0;
  int sum = 0;
  for (const Eigen::Vector2i& c : query.cells) sum += plan.score(c.x() + dx, c.y() + dy);
  return static_cast<double>(sum) / (static_cast<double>(Plan::kFull) * static_cast<double>(query.cells.size()));
}

}  // namespace

PlanFit search_plan(std::span<const Surfel> query, std::span<const Surfel> candidate, double yaw_guess_rad,
                    const PlanSearchConfig& config) {
  const Plan plan(candidate, config.cell_m);
  const int reach = static_cast<int>(config.window_m / config.cell_m);
  const int yaws = static_cast<int>(std::lround(config.yaw_window_rad / config.yaw_step_rad));
  std::vector<PlanFit> fits;
  for (int k = -yaws; k <= yaws; ++k) {
    const double yaw_rad = yaw_guess_rad + k * config.yaw_step_rad;
    const Cells cells = turned_cells(query, yaw_rad, plan);
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx)
        fits.push_back({yaw_rad, config.cell_m * Eigen::Vector2d(dx, dy), score_at(cells, plan, dx, dy), 0});
  }
  PlanFit best =
      *std::max_element(fits.begin(), fits.end(), [](const PlanFit& a, const PlanFit& b) { return a.score < b.score; });
  for (const PlanFit& fit : fits)
    if ((fit.p_m - best.p_m).norm() > config.rival_m) best.rival = std::max(best.rival, fit.score);
  return best;
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// The Extended Scan Context: what its channels say, and which places it takes for the same.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "backend/loops/context_match.hpp"
#include "backend/loops/plain_context.hpp"
#include "tests/support/loop_scene.hpp"

namespace lxd::backend_scan_context_test {
namespace {

const Eigen::Vector3d kPlace(0, 0, 1.5);

ScanContext context_of(const std::vector<MeshVertex>& vertices, const Eigen::Vector3d& place_m = kPlace) {
  return make_scan_context(thin_surfels(vertices, {}), place_m, {});
}

double distance(const ScanContext& a, const ScanContext& b) {
  ContextMatcher matcher{ContextMatchConfig{}};
  matcher.set_query(a);
  return matcher.match(b).distance;
}

TEST(Surfels, AreTheSameWhateverTheOrderOfTheVertices) {
  std::vector<MeshVertex> vertices = test::town(1).vertices;
  const auto one = thin_surfels(vertices, {});
  std::shuffle(vertices.begin(), vertices.end(), std::mt19937(7));
  const auto other = thin_surfels(vertices, {});
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_LT((one[i].position_m - other[i].position_m).norm(), 1e-5F) << i;
}

TEST(Surfels, LeaveOutWhatIsNotTrustedOrNoNumber) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  const std::vector<MeshVertex> vertices = {{{1, 1, 1}, up, 1e-4F},
                                            {{2, 1, 1}, up, 1.0F},
                                            {{nan, 1, 1}, up, 1e-4F},
                                            {{3, 1, 1}, up, nan},
                                            {{1e30F, 1, 1}, up, 1e-4F}};
  EXPECT_EQ(thin_surfels(vertices, {}).size(), 1U);
}

TEST(Surfels, KeepTheTwoFacesOfAThinWallApart) {
  const std::vector<MeshVertex> vertices = {{{1, 1, 1}, {1, 0, 0}, 1e-4F}, {{1.01F, 1, 1}, {-1, 0, 0}, 1e-4F}};
  EXPECT_EQ(thin_surfels(vertices, {}).size(), 2U);
}

TEST(ScanContext, RaysAreFreeUpToTheWallAndUnknownBehindIt) {
  // Given a wall of 4 m height ahead at 10 m, ground before it, nothing else
  test::SyntheticMesh mesh;
  mesh.add_patch({1, -6, 0}, {9, 0, 0}, {0, 12, 0});
  mesh.add_patch({10, -6, 0}, {0, 0, 4}, {0, 12, 0});
  const auto surfels = thin_surfels(mesh.vertices, {});
  const ScanContext context = make_scan_context(surfels, kPlace, {});
  // Then
  EXPECT_EQ(visibility_at(context, {6, 0.3, 0}, {}), Visibility::free);
  EXPECT_EQ(visibility_at(context, {10, 0.3, 0}, {}), Visibility::occupied);
  EXPECT_EQ(visibility_at(context, {15, 0.3, 0}, {}), Visibility::unknown);
  EXPECT_EQ(visibility_at(context, {-6, 0.3, 0}, {}), Visibility::unknown);
  EXPECT_EQ(visibility_at(context, {1000, 0.3, 0}, {}), Visibility::unknown);
}

TEST(ScanContext, DensityFallsWithTheVariance) {
  test::SyntheticMesh mesh;
  mesh.add_patch({10, -6, 0}, {0, 0, 4}, {0, 12, 0});
  const ScanContext sure = context_of(mesh.vertices);
  for (MeshVertex& v : mesh.vertices) v.variance_m2 *= 8;
  const ScanContext unsure = context_of(mesh.vertices);
  EXPECT_EQ(sure.height, unsure.height);
  EXPECT_GT(*std::max_element(sure.density.begin(), sure.density.end()),
            20 + *std::max_element(unsure.density.begin(), unsure.density.end()));
}

TEST(ScanContext, ACeilingIsNoHeight) {
  test::SyntheticMesh open, closed;
  open.add_box({5, 5, 0}, {2, 2, 1});
  closed.add_box({5, 5, 0}, {2, 2, 1});
  closed.add_patch({-9, -9, 3}, {0, 18, 0}, {18, 0, 0});
  EXPECT_EQ(context_of(open.vertices).height, context_of(closed.vertices).height);
}

TEST(ContextMatch, FindsTheTurnOfASeenPlace) {
  const std::vector<MeshVertex> here = test::town(1).vertices;
  const int sectors = 11;
  const double turn_rad = 2 * std::numbers::pi * sectors / kContextSectors;
  ContextMatcher matcher{ContextMatchConfig{}};
  matcher.set_query(context_of(here));
  // When the candidate's axes are such that the query's are turned by turn_rad in them
  const ContextMatch match = matcher.match(context_of(test::moved(here, test::level_pose(turn_rad, 0, 0))));
  EXPECT_LT(match.distance, 0.1);
  EXPECT_EQ(match.shift, sectors);
  EXPECT_NEAR(match.yaw_rad(), turn_rad, 1e-12);
}

TEST(ContextMatch, AMetreAsideIsMoreLikeThanAnotherPlace) {
  const ScanContext here = context_of(test::town(1).vertices);
  const double aside = distance(here, context_of(test::town(1).vertices, kPlace + Eigen::Vector3d(0.7, 0.7, 0)));
  for (std::uint32_t seed = 2; seed < 8; ++seed)
    EXPECT_LT(aside, 0.8 * distance(here, context_of(test::town(seed).vertices))) << seed;
}

TEST(ContextMatch, HalfAViewIsStillTheSamePlace) {
  const std::vector<MeshVertex> whole = test::town(1).vertices, half = test::front_of(whole);
  const double masked = distance(context_of(half), context_of(half, kPlace + Eigen::Vector3d(0.3, 0.2, 0)));
  for (std::uint32_t seed = 2; seed < 8; ++seed)
    EXPECT_LT(masked, distance(context_of(half), context_of(test::front_of(test::town(seed).vertices)))) << seed;
}

TEST(ContextMatch, TooLittleInCommonIsNoMatch) {
  // Given two half views that look away from each other
  const std::vector<MeshVertex> ahead = test::front_of(test::town(1).vertices);
  std::vector<MeshVertex> behind;
  for (const MeshVertex& v : test::town(1).vertices)
    if (v.position_m.x() < 0) behind.push_back(v);
  ContextMatcher matcher{ContextMatchConfig{}};
  matcher.set_query(context_of(ahead));
  const ContextMatch match = matcher.match(context_of(behind));
  // Then what matches at all is a turned one, never the unturned
  EXPECT_NE(match.shift, 0);
  EXPECT_GT(match.distance, 0.2);
}

TEST(ContextMatch, AnEmptyPlaceIsLikeNone) {
  const ScanContext here = context_of(test::town(1).vertices), nothing = context_of({});
  EXPECT_EQ(distance(here, nothing), 1);
  EXPECT_EQ(distance(nothing, here), 1);
  EXPECT_EQ(distance(nothing, nothing), 1);
}

TEST(PlainContext, MatchesTheSamePlaceTurned) {
  const std::vector<MeshVertex> here = test::town(1).vertices;
  const auto plain = [](const std::vector<MeshVertex>& v) {
    return make_plain_context(thin_surfels(v, {}), kPlace, 80, 2);
  };
  const double turn_rad = 2 * std::numbers::pi * 9 / PlainContext::kSectors;
  const PlainMatch match = match_plain(plain(here), plain(test::moved(here, test::level_pose(turn_rad, 0, 0))));
  EXPECT_EQ(match.shift, 9);
  EXPECT_LT(match.distance, 0.1);
  EXPECT_GT(match_plain(plain(here), plain(test::town(2).vertices)).distance, 2 * match.distance);
}

}  // namespace
}  // namespace lxd::backend_scan_context_test

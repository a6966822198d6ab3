// SPDX-License-Identifier: Apache-2.0
#include "board/gnss_intake.hpp"

#include "backend/graph/pose_blend.hpp"
#include "drivers/gnss/gnss_covariance.hpp"

namespace lxd {
namespace {

constexpr std::size_t kWaitingFixesMax = 64;  // fixes while no sweep comes; the newest win

// Why a fix is of no use whatever the path; nothing: it is of use.
const char* fault_of(const GnssFix& fix) {
  if (!fix.has_position()) return "no_position";
  if (*fix.latitude_deg == 0 && *fix.longitude_deg == 0) return "zero";
  if (!fix.altitude_msl_m) return "no_height";
  if (!covariance_of(fix)) return "unknown_quality";
  return nullptr;
}

}  // namespace

// Heights above the geoid do as well as those above the ellipsoid: they differ by an offset, and the offset is unknown
// anyway.
void GnssIntake::take(const GnssFix& fix, Duration shift) {
  if (const char* const fault = fault_of(fix)) {
    ++rejected_[fault];
    return;
  }
  const Geodetic place{*fix.latitude_deg, *fix.longitude_deg, fix.ellipsoid_height_m().value_or(*fix.altitude_msl_m)};
  if (!frame_) {
    const auto frame = EnuFrame::at(place);
    if (!frame) {
      ++rejected_["no_place"];
      return;
    }
    frame_.emplace(*frame);
  }
  waiting_.push_back({fix.received + shift, frame_->to_enu(place), covariance_of(fix)->enu_m2});
  if (waiting_.size() <= kWaitingFixesMax) return;
  waiting_.pop_front();
  ++rejected_["crowded"];
}

std::optional<GnssMeasurement> GnssIntake::advance(RigTime before, const Pose& T_world_before, RigTime now,
                                                   const Pose& T_world_now, const KeyFrame& key_frame) {
  std::optional<GnssMeasurement> measurement;
  for (; !waiting_.empty() && waiting_.front().stamp <= now; waiting_.pop_front()) {
    const Place& place = waiting_.front();
    if (place.stamp < before || key_frame.id == last_key_frame_) continue;
    const double span_s = (now - before).seconds();
    const Pose T_world_then = blend(T_world_before, T_world_now, (place.stamp - before).seconds() / span_s);
    const Pose T_key_frame_world = key_frame.T_world_body.inverse();
    measurement.emplace();
    measurement->key_frame = key_frame.id;
    measurement->stamp = place.stamp;
    measurement->antenna_body_m = T_key_frame_world * (T_world_then * antenna_m_);
    measurement->antenna_velocity_mps =
        T_key_frame_world.R * (T_world_now * antenna_m_ - T_world_before * antenna_m_) / span_s;
    measurement->enu_m = place.enu_m;
    measurement->covariance_m2 = place.covariance_m2;
    last_key_frame_ = key_frame.id;
  }
  return measurement;
}

void GnssIntake::begin_again() {
  waiting_.clear();
  last_key_frame_ = -1;
}

}  // namespace lxd

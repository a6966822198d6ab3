// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/place_set.hpp"

#include "backend/graph/loop_set.hpp"

namespace lxd {

bool PlaceSet::sound(const PlaceMeasurement& place) const {
  return place.T_map_body.p.allFinite() && place.T_map_body.R.allFinite() && place.covariance.allFinite() &&
         (place.covariance.diagonal().array() >= 0).all() && place.key_frame >= 0 && place.key_frame < chain_.size();
}

// From the map by way of b to the key frame of a.
bool PlaceSet::agree(const PlaceMeasurement& a, const PlaceMeasurement& b) const {
  if (a.map != b.map) return false;
  const RelativeMotion by_b = RelativeMotion{b.T_map_body, b.covariance} *
                              chain_.motion(static_cast<int>(b.key_frame), static_cast<int>(a.key_frame));
  return alike({a.T_map_body, a.covariance}, by_b);
}

bool PlaceSet::add(const PlaceMeasurement& place) {
  ++counts_.proposed;
  if (!sound(place)) {
    ++counts_.not_sound;
    return false;
  }
  if (agreement_.full()) {
    if (agreement_.accepted(0)) settled_.push_back(set_.front());
    set_.erase(set_.begin());
    agreement_.drop_oldest();
  }
  PlaceMeasurement candidate = place;
  candidate.covariance = with_loop_floor(place.covariance, config_);
  Agreement::Links agrees;
  for (std::size_t i = 0; i < set_.size(); ++i) agrees[i] = agree(set_[i], candidate);
  set_.push_back(candidate);
  return agreement_.add(agrees);
}

// Those that are settled were of the largest set when it was; should another map have won since, they are not.
std::vector<PlaceMeasurement> PlaceSet::accepted() const {
  std::vector<PlaceMeasurement> places;
  for (std::size_t i = 0; i < set_.size(); ++i)
    if (agreement_.accepted(i)) places.push_back(set_[i]);
  if (places.empty()) return places;
  std::vector<PlaceMeasurement> all;
  for (const PlaceMeasurement& place : settled_)
    if (agree(place, places.front())) all.push_back(place);
  all.insert(all.end(), places.begin(), places.end());
  return all;
}

PlaceCounts PlaceSet::counts() const {
  PlaceCounts counts = counts_;
  counts.accepted = accepted().size();
  counts.waiting = counts.proposed - counts.not_sound - counts.accepted;
  return counts;
}

}  // namespace lxd

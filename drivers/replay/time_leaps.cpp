// SPDX-License-Identifier: Apache-2.0
// See time_leaps.hpp.
#include "drivers/replay/time_leaps.hpp"

#include <algorithm>
#include <cstddef>

namespace lxd {
namespace {

// Stamps after one that are looked at: of up to seven wrong ones in a row each is found.
constexpr std::size_t kLookahead = 8;
// At the start, where a few late stamps in a row and a step of the clock backward are the same.
constexpr std::size_t kLookaheadAtStart = 2;

// The valid stamps after line `at`, at most `count`.
std::vector<RigTime> stamps_after(const StampLines& stamps, std::size_t at, std::size_t count) {
  std::vector<RigTime> later;
  for (std::size_t i = at + 1; i < stamps.size() && later.size() < count; ++i) {
    if (stamps[i]) later.push_back(*stamps[i]);
  }
  return later;
}

bool is_leap(std::optional<RigTime> last_sound, RigTime stamp, const std::vector<RigTime>& later) {
  std::optional<RigTime> returned;
  for (const RigTime time : later) {
    if (time >= stamp || (last_sound && time <= *last_sound)) continue;
    if (returned && time > *returned) return true;
    returned = returned ? std::min(*returned, time) : time;
  }
  return returned && last_sound && later.size() == 1;
}

}  // namespace

std::vector<bool> find_time_leaps(const StampLines& stamps) {
  std::vector<bool> leaps(stamps.size(), false);
  std::optional<RigTime> last_sound;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (!stamps[i] || (last_sound && *stamps[i] <= *last_sound)) continue;
    const std::size_t lookahead = last_sound ? kLookahead : kLookaheadAtStart;
    leaps[i] = is_leap(last_sound, *stamps[i], stamps_after(stamps, i, lookahead));
    if (!leaps[i]) last_sound = stamps[i];
  }
  return leaps;
}

RigTime first_sound_stamp(const StampLines& stamps) {
  const std::vector<bool> leaps = find_time_leaps(stamps);
  std::size_t line = 0;
  while (!stamps[line] || leaps[line]) ++line;
  return *stamps[line];
}

}  // namespace lxd

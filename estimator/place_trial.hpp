// SPDX-License-Identifier: Apache-2.0
// A place that was found after a silence, among others that look alike, has to hold before anything is mapped from it.
#pragma once

#include <cstdint>

namespace lxd {

// When to seek: with the first sweep after the silence, and, while that has not helped, after rests of 1, 2 and then 4
// sweeps, counted and not timed.
class SearchRest {
 public:
  static constexpr std::uint32_t kRestMax = 4;  // sweeps

  // Of a sweep for which a search is wanted: may it be made?
  bool may_seek() {
    if (left_ > 0) {
      --left_;
      return false;
    }
    left_ = next_;
    next_ = next_ < kRestMax ? 2 * next_ : kRestMax;
    return true;
  }
  // The body has been found.
  void found() { *this = {}; }

 private:
  std::uint32_t left_ = 0, next_ = 1;
};

// From the silence until so many sweeps in a row have held the pose where the body was found.
class PlaceTrial {
 public:
  static constexpr std::uint32_t kSweeps = 4;

  void begin() { left_ = kSweeps; }
  [[nodiscard]] bool open() const { return left_ > 0; }

  void held() { left_ -= left_ > 0 ? 1 : 0; }
  // True: after sweeps that had held.
  bool failed() {
    const bool held_before = left_ > 0 && left_ < kSweeps;
    if (open()) begin();
    return held_before;
  }

 private:
  std::uint32_t left_ = 0;
};

}  // namespace lxd

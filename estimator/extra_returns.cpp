// SPDX-License-Identifier: Apache-2.0
#include "estimator/extra_returns.hpp"

namespace lxd {

void ExtraReturns::add(RigTime zero, const LidarPoint& point) noexcept {
  const RigTime fired = zero + Duration::from_ns(point.offset_ns);
  if (count_ > 0 && fired - begin_ > kSpanMax) {
    lost_ += count_;
    count_ = 0;
  }
  if (count_ == 0) begin_ = fired;
  if (fired < begin_ || count_ == storage_.size()) {
    ++lost_;
    return;
  }
  storage_[count_] = point;
  storage_[count_++].offset_ns = static_cast<std::uint32_t>((fired - begin_).ns());
}

}  // namespace lxd

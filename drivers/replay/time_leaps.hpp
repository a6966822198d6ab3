// SPDX-License-Identifier: Apache-2.0
// Which stamps of a recording are wrong by being far too late. Let through, one of them would make every sound stamp
// after it look late in turn, until the recording's end.
#pragma once

#include <optional>
#include <vector>

#include "drivers/replay/times_file.hpp"

namespace lxd {

// By line: true for a stamp behind which the recording returns, that is two of the stamps soon after it (for the last
// but one: the last) are earlier, in order, and later than the last sound stamp before it. Gaps forward, steps of the
// clock backward, and a last stamp of which nothing comes after, are no leaps. The first
// stamp, which has no sound one before it, is one when it is later than the next two.
std::vector<bool> find_time_leaps(const StampLines& stamps);

// The first stamp that is there and is no leap. Precondition: one stamp is there.
RigTime first_sound_stamp(const StampLines& stamps);

}  // namespace lxd

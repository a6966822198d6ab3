// SPDX-License-Identifier: Apache-2.0
#include "board/mutes.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "board/nearest_names.hpp"

namespace lxd {
namespace {

constexpr std::array<std::string_view, 6> kSensors{"lidar0", "lidar1", "camera0", "imu", "wheel", "gnss"};
constexpr double kSecondsMax = 1e6;

std::optional<Duration> seconds(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!(value >= 0 && value <= kSecondsMax)) return std::nullopt;
  return Duration::from_seconds(value);
}

Error bad(std::string_view text, std::string_view what) {
  return Error{fmt::format("--mute: found '{}', {} (SENSOR@BEGIN_S[+DURATION_S])", text, what)};
}

}  // namespace

Result<Mute> parse_mute(std::string_view text) {
  const std::size_t at = text.find('@');
  const std::string_view sensor = text.substr(0, at);
  if (std::ranges::find(kSensors, sensor) == kSensors.end()) {
    const std::vector<std::string_view> names(kSensors.begin(), kSensors.end());
    return bad(text, fmt::format("wanted one of {}{}", fmt::join(names, " "), did_you_mean(sensor, names)));
  }
  if (at == std::string_view::npos) return bad(text, "wanted the time at which it begins");
  const std::string_view times = text.substr(at + 1);
  const std::size_t plus = times.find('+');
  const auto begin = seconds(times.substr(0, plus));
  if (!begin) return bad(text, "wanted seconds after '@'");
  if (plus == std::string_view::npos) return Mute{std::string(sensor), *begin, std::nullopt};
  const auto span = seconds(times.substr(plus + 1));
  if (!span) return bad(text, "wanted seconds after '+'");
  return Mute{std::string(sensor), *begin, *span};
}

Result<std::vector<Mute>> parse_mutes(std::span<const std::string> texts) {
  std::vector<Mute> mutes;
  for (const std::string& text : texts) {
    auto mute = parse_mute(text);
    if (!mute) return mute.error();
    mutes.push_back(std::move(*mute));
  }
  return mutes;
}

bool Mutes::silent(std::string_view sensor, RigTime t) const {
  return zero_ && std::ranges::any_of(mutes_, [&](const Mute& mute) {
           const Duration since = t - *zero_;
           return mute.sensor == sensor && since >= mute.begin && (!mute.span || since < mute.begin + *mute.span);
         });
}

}  // namespace lxd

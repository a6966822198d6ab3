// SPDX-License-Identifier: Apache-2.0
// The keys below `wheel:`, with the table of CAN messages that a rig file may describe itself.
#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "board/rig_sections.hpp"
#include "board/wheel_table.hpp"

namespace lxd {
namespace {

constexpr std::array<std::string_view, 5> kProtocols{"agilex", "toyota", "honda", "nissan", kWheelTableProtocol};
constexpr std::array<std::string_view, 2> kByteOrders{"intel", "motorola"};
constexpr std::array<std::string_view, 2> kSigns{"unsigned", "signed"};

constexpr ValueRange kRate{1, 1000, "Hz", ""};
constexpr ValueRange kSpeedSigma{1e-4, 10, "m/s", ""};
constexpr ValueRange kYawRateSigma{1e-6, 3, "rad/s", "is it in degrees a second?"};
constexpr ValueRange kTrack{0.05, 5, "m", "is it in millimetres?"};
constexpr ValueRange kWheelbase{0, 20, "m", "is it in millimetres?"};
constexpr ValueRange kLength{1, kCanMaxData, "bytes", "is it in bits?"};
constexpr ValueRange kBit{0, 63, "", ""};
constexpr ValueRange kBits{1, 32, "bits", ""};
constexpr ValueRange kScale{-1e6, 1e6, "", ""};
constexpr ValueRange kOffset{-1e6, 1e6, "", ""};
constexpr std::size_t kMessagesMax = 16, kSignalsMax = 16;

// A name of a list as its place in it.
template <typename Choice>
void read_choice(YamlSection& section, std::string_view key, Choice& choice, std::span<const std::string_view> names) {
  std::string name{names[static_cast<std::size_t>(choice)]};
  section.read(key, name, names);
  choice = static_cast<Choice>(std::ranges::find(names, name) - names.begin());
}

void read_byte(YamlSection& section, std::string_view key, std::uint8_t& value, const ValueRange& range) {
  std::uint32_t read = value;
  section.read(key, read, range);
  value = static_cast<std::uint8_t>(read);
}

// Each map of a list, with its path; the list must be there and not too long.
template <typename Read>
void read_list(YamlSection& section, std::string_view key, std::size_t most, Read&& read) {
  const auto node = section.find(key);
  if (!node || !node->IsSequence() || node->size() == 0 || node->size() > most) {
    section.complain(key, fmt::format("found {}, wanted a list of 1 to {}", node ? describe(*node) : "nothing", most));
    return;
  }
  for (std::size_t i = 0; i < node->size(); ++i) {
    YamlSection entry = section.below((*node)[i], fmt::format("{}[{}]", key, i));
    read(entry);
    entry.reject_unknown();
  }
}

void read_signal(YamlSection& section, WheelMessageRig& message) {
  CanSignal signal;
  section.require("role", "what the value is");
  read_choice(section, "role", signal.role, kCanRoleNames);
  section.require("start_bit", "the first bit, as a DBC file counts");
  read_byte(section, "start_bit", signal.start_bit, kBit);
  signal.bits = 1;
  section.require("bits", "how many bits the value has");
  read_byte(section, "bits", signal.bits, kBits);
  read_choice(section, "byte_order", signal.order, kByteOrders);
  read_choice(section, "sign", signal.is_signed, kSigns);
  section.require("scale", "the SI value of one step");
  section.read("scale", signal.scale, kScale);
  if (signal.scale == 0) section.complain("scale", "found 0, wanted the SI value of one step");
  section.read("offset", signal.offset, kOffset);
  if (section.has("fault_bit")) {
    signal.fault_bit = 0;
    read_byte(section, "fault_bit", signal.fault_bit, {0, 8.0 * message.length - 1, "", ""});
  }
  if (!signal.fits(message.length)) {
    section.complain("bits", fmt::format("found {} bits from bit {}, wanted all of them in a frame of {} bytes",
                                         signal.bits, signal.start_bit, message.length));
  }
  message.signals.push_back(signal);
}

// Decimal or, as DBC tools write it, hexadecimal.
void read_id(YamlSection& section, WheelMessageRig& message) {
  const auto node = section.find("id");
  const std::uint32_t most = message.extended ? kCanExtendedIdMax : kCanStandardIdMax;
  if (node && node->IsScalar() && YAML::convert<std::uint32_t>::decode(*node, message.id) && message.id <= most) return;
  section.complain("id", fmt::format("found {}, wanted a number in 0 .. {:#X}{}", node ? describe(*node) : "nothing",
                                     most, message.extended ? "" : " (longer ones need extended: true)"));
}

void read_message(YamlSection& section, WheelRig& wheel) {
  WheelMessageRig message;
  section.read("extended", message.extended);
  read_id(section, message);
  read_byte(section, "length", message.length, kLength);
  read_choice(section, "checksum", message.checksum, kCanChecksumNames);
  read_list(section, "signals", kSignalsMax, [&](YamlSection& signal) { read_signal(signal, message); });
  const bool known = std::ranges::any_of(wheel.messages, [&](const WheelMessageRig& other) {
    return other.id == message.id && other.extended == message.extended;
  });
  if (known) section.complain("id", fmt::format("found {:#05X} twice, wanted each id once", message.id));
  wheel.messages.push_back(std::move(message));
}

void check_roles_are_unique(YamlSection& section, const WheelRig& wheel) {
  std::array<std::size_t, kCanRoleNames.size()> times{};
  for (const WheelMessageRig& message : wheel.messages)
    for (const CanSignal& signal : message.signals) ++times[static_cast<std::size_t>(signal.role)];
  for (std::size_t role = static_cast<std::size_t>(CanRole::other) + 1; role < times.size(); ++role) {
    if (times[role] < 2) continue;
    section.complain("messages", fmt::format("found {} signals with the role {}, wanted at most one", times[role],
                                             kCanRoleNames[role]));
  }
}

bool has_role(const std::vector<CanMessage>& messages, CanRole role) {
  return std::ranges::any_of(messages, [&](const CanMessage& message) {
    return std::ranges::find(message.signals, role, &CanSignal::role) != message.signals.end();
  });
}

// The kinematics must have what they are made of.
void check_kinematics(YamlSection& section, const WheelRig& wheel) {
  const WheelSource source = wheel_source(wheel);
  const std::string_view name = kWheelKinematicsNames[static_cast<std::size_t>(source)];
  const std::vector<CanMessage> messages = wheel_messages(wheel);
  for (const CanRole role : roles_of(source)) {
    if (messages.empty() || has_role(messages, role)) continue;
    section.complain("kinematics", fmt::format("found {}, which needs {}; the messages of {} have none", name,
                                               kCanRoleNames[static_cast<std::size_t>(role)], wheel.protocol));
  }
  if (source == WheelSource::steering && wheel.wheelbase_m <= 0) {
    section.complain("wheelbase_m", fmt::format("found {}, wanted the way between the axles: {} needs it",
                                                section.has("wheelbase_m") ? "0" : "nothing", name));
  }
}

}  // namespace

void read_keys(YamlSection& section, WheelRig& wheel) {
  section.read("rate_hz", wheel.rate_hz, kRate);
  section.read("speed_sigma_mps", wheel.speed_sigma_mps, kSpeedSigma);
  section.read("yaw_rate_sigma_radps", wheel.yaw_rate_sigma_radps, kYawRateSigma);
  section.read("delay_s", wheel.delay_s, kDelay);
  section.read("delay_sigma_s", wheel.delay_sigma_s, kDelaySigma);
  section.read("protocol", wheel.protocol, kProtocols);
  section.read("kinematics", wheel.kinematics, kWheelKinematicsNames);
  section.read("track_m", wheel.track_m, kTrack);
  section.read("wheelbase_m", wheel.wheelbase_m, kWheelbase);
  read_wire(section, wheel.wire);
  if (wheel.protocol == kWheelTableProtocol) {
    read_list(section, "messages", kMessagesMax, [&](YamlSection& message) { read_message(message, wheel); });
    check_roles_are_unique(section, wheel);
  } else if (section.has("messages")) {
    (void)section.find("messages");
    section.complain("messages", fmt::format("found a table, wanted protocol: {} with it; {} has a table of its own",
                                             kWheelTableProtocol, wheel.protocol));
  }
  check_kinematics(section, wheel);
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// See can_log.hpp.
#include "drivers/replay/can_log.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "drivers/replay/times_file.hpp"

namespace lxd {
namespace {

constexpr std::uint32_t kErrorFlag = 0x20000000;  // linux/can.h
constexpr std::size_t kStandardDigits = 3, kExtendedDigits = 8;
constexpr std::int64_t kNanosPerMicro = 1000;

// Cuts a prefix that ends before the separator; nothing when there is none.
std::optional<std::string_view> cut(std::string_view& rest, char separator) {
  const std::size_t end = rest.find(separator);
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view piece = rest.substr(0, end);
  rest.remove_prefix(end + 1);
  return piece;
}

std::optional<std::uint32_t> hex(std::string_view digits) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

// "(seconds.micros) "
bool parse_time(std::string_view& rest, RigTime& received) {
  if (!rest.starts_with('(')) return false;
  rest.remove_prefix(1);
  const auto text = cut(rest, ')');
  if (!text || text->empty() || text->find_first_not_of("0123456789.") != std::string_view::npos) return false;
  const auto time = parse_seconds(*text);
  if (!time || !rest.starts_with(' ')) return false;
  rest.remove_prefix(1);
  received = *time;
  return true;
}

bool is_interface_name(std::string_view text) {
  const auto is_graphic = [](char c) { return c > ' ' && c < 0x7F; };
  return !text.empty() && text.size() <= kCanInterfaceMax && std::all_of(text.begin(), text.end(), is_graphic);
}

bool parse_id(std::string_view text, CanFrame& frame) {
  if (text.size() != kStandardDigits && text.size() != kExtendedDigits) return false;
  const auto id = hex(text);
  if (!id) return false;
  const bool long_form = text.size() == kExtendedDigits;
  frame.kind = long_form && (*id & kErrorFlag) != 0 ? CanKind::error : CanKind::data;
  frame.extended = long_form && frame.kind == CanKind::data;
  frame.id = frame.kind == CanKind::error ? *id & ~kErrorFlag : *id;
  return frame.id <= (long_form ? kCanExtendedIdMax : kCanStandardIdMax);
}

bool parse_remote(std::string_view text, CanFrame& frame) {
  frame.kind = CanKind::remote;
  text.remove_prefix(1);
  if (text.empty()) return true;
  if (text.size() != 1 || text[0] < '0' || text[0] > '8') return false;
  frame.length = static_cast<std::uint8_t>(text[0] - '0');
  return true;
}

bool parse_data(std::string_view text, CanFrame& frame) {
  if (text.starts_with('R') && frame.kind == CanKind::data) return parse_remote(text, frame);
  if (text.size() % 2 != 0 || text.size() > 2 * kCanMaxData) return false;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const auto byte = hex(text.substr(i, 2));
    if (!byte) return false;
    frame.data[i / 2] = static_cast<std::uint8_t>(*byte);
  }
  frame.length = static_cast<std::uint8_t>(text.size() / 2);
  return true;
}

std::string_view without_line_end(std::string_view line) {
  const std::size_t last = line.find_last_not_of(" \t\r\n");
  line = line.substr(0, last == std::string_view::npos ? 0 : last + 1);
  // Newer candumps add the direction with -x.
  if (line.ends_with(" R") || line.ends_with(" T")) line.remove_suffix(2);
  return line;
}

std::string data_text(const CanFrame& frame) {
  if (frame.kind == CanKind::remote) return frame.length == 0 ? "R" : fmt::format("R{}", frame.length);
  std::string text;
  for (std::size_t i = 0; i < frame.length; ++i) text += fmt::format("{:02X}", frame.data[i]);
  return text;
}

}  // namespace

CanLogLine parse_can_log_line(std::string_view line, CanLogRecord& record) {
  std::string_view rest = without_line_end(line);
  if (rest.empty()) return CanLogLine::blank;
  record = {};
  if (!parse_time(rest, record.frame.received)) return CanLogLine::garbage;
  const auto interface = cut(rest, ' ');
  if (!interface || !is_interface_name(*interface)) return CanLogLine::garbage;
  record.set_interface(*interface);
  const auto id = cut(rest, '#');
  if (!id || !parse_id(*id, record.frame)) return CanLogLine::garbage;
  if (rest.starts_with('#')) return CanLogLine::can_fd;
  return parse_data(rest, record.frame) ? CanLogLine::frame : CanLogLine::garbage;
}

std::string can_log_line(const CanLogRecord& record) {
  const CanFrame& frame = record.frame;
  const bool error = frame.kind == CanKind::error;
  const std::size_t digits = error || frame.extended ? kExtendedDigits : kStandardDigits;
  return fmt::format("({:010}.{:06}) {} {:0{}X}#{}\n", frame.received.ns() / kNanosPerSecond,
                     frame.received.ns() % kNanosPerSecond / kNanosPerMicro, record.interface_name(),
                     error ? frame.id | kErrorFlag : frame.id, digits, data_text(frame));
}

Result<CanLogReader> CanLogReader::open(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::error_code ignored;  // a folder opens like a file, and reads as an empty one
  if (!file || std::filesystem::is_directory(path, ignored))
    return Error{fmt::format("{}: cannot be read, wanted a log of candump -L", path.string())};
  return CanLogReader(std::move(file));
}

bool CanLogReader::next(CanLogRecord& record) {
  while (std::getline(file_, line_)) {
    ++line_number_;
    if (take(parse_can_log_line(line_, record), record)) return true;
  }
  return false;
}

bool CanLogReader::take(CanLogLine kind, const CanLogRecord& record) {
  if (kind == CanLogLine::can_fd) ++can_fd_;
  if (kind == CanLogLine::garbage) {
    ++garbage_;
    if (garbage_lines_.size() < kGarbageLinesKept) garbage_lines_.push_back(line_number_);
  }
  if (kind != CanLogLine::frame) return false;
  if (frames_ > 0 && record.frame.received < last_) ++time_backwards_;
  last_ = record.frame.received;
  ++frames_;
  return true;
}

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// A wire's pieces, damaged one at a time, each with what its parser must count for it: datagrams of an Ouster and of a
// Livox, frames of a VectorNav, sentences of NMEA.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "drivers/crc.hpp"
#include "drivers/gnss/nmea_framer.hpp"
#include "drivers/imu/vectornav_format.hpp"
#include "drivers/livox/packet_parser.hpp"
#include "tests/support/wire_player.hpp"
#include "tools/simulator/lidar/livox_encoder.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::test {

using Pieces = std::vector<PlayedBytes>;
using sim::Random;

inline PlayedBytes like(const PlayedBytes& piece, std::vector<std::uint8_t> bytes) {
  return {piece.t, piece.wire, piece.port, std::move(bytes)};
}

inline std::size_t below(Random& random, std::size_t end) { return random.bits() % end; }

inline PlayedBytes telling(PlayedBytes piece, const std::string& counter, std::uint64_t times = 1) {
  piece.told.emplace_back(fmt::format("{}.{}", piece.wire, counter), times);
  return piece;
}

// Datagrams, of either sensor.

inline PlayedBytes cut_datagram(PlayedBytes piece, Random& random) {
  piece.bytes.resize(1 + below(random, piece.bytes.size() - 1));
  return telling(std::move(piece), "bad_size");
}

// One bit, beyond the header and before the last `spared` bytes.
inline PlayedBytes corrupt_datagram(PlayedBytes piece, Random& random, std::size_t header, std::size_t spared) {
  const std::size_t at = header + below(random, piece.bytes.size() - header - spared);
  piece.bytes[at] = static_cast<std::uint8_t>(piece.bytes[at] ^ (1U << below(random, 8)));
  return telling(std::move(piece), "bad_crc");
}

inline PlayedBytes foreign_datagram(const PlayedBytes& piece) {
  PlayedBytes copy = telling(like(piece, piece.bytes), "foreign");
  copy.foreign = true;
  return copy;
}

inline PlayedBytes livox_without_points(const PlayedBytes& piece) {
  const std::uint8_t* const header = piece.bytes.data();
  const sim::LivoxHeader same{kLivoxHeader.timestamp_ns.get(header), 0, 0, 0, LivoxClock::kUptime};
  return telling(like(piece, sim::encode_livox_points(kLivoxRecords.front(), same, {})), "bad_count");
}

inline PlayedBytes livox_beyond_datagram(const PlayedBytes& piece, Random& random) {
  PlayedBytes copy = telling(like(piece, piece.bytes), "bad_size");
  kLivoxHeader.length.set(copy.bytes.data(), copy.bytes.size() + 1 + below(random, 1000));
  return copy;
}

// One datagram for `part` of them, with every so-and-so-many-eth point of theirs, as a sensor would send it that is so
// much slower: what a full Mid-360 sends is too much for a machine that does other things too.
inline PlayedBytes thinned_livox(std::span<const PlayedBytes> together, std::uint16_t number) {
  PlayedBytes one = like(together.back(), together.front().bytes);
  std::uint8_t* const header = one.bytes.data();
  const std::size_t points = kLivoxHeader.record_count.get(header), bytes = kLivoxRecords.front().bytes;
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t from = i * together.size();
    std::copy_n(
        together[from / points].bytes.begin() + static_cast<std::ptrdiff_t>(kLivoxHeaderBytes + from % points * bytes),
        bytes, one.bytes.begin() + static_cast<std::ptrdiff_t>(kLivoxHeaderBytes + i * bytes));
  }
  kLivoxHeader.time_interval.set(header, kLivoxHeader.time_interval.get(header) * together.size());
  kLivoxHeader.packet_counter.set(header, number);
  kLivoxHeader.frame_counter.set(header, 0);
  kLivoxHeader.crc.set(header, crc32(std::span<const std::uint8_t>(one.bytes).subspan(kLivoxCheckedFrom)));
  return one;
}

// Frames of a VectorNav.

// All bytes of the line again, a frame a piece, at the time of its last byte.
inline Pieces in_frames(const Pieces& chunks) {
  Pieces frames;
  std::vector<std::uint8_t> bytes;
  for (const PlayedBytes& chunk : chunks) {
    bytes.insert(bytes.end(), chunk.bytes.begin(), chunk.bytes.end());
    VectorNavLayout layout;
    while (read_vectornav_header(bytes, layout) == VectorNavHeader::kSound && bytes.size() >= layout.frame_bytes()) {
      const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(layout.frame_bytes());
      frames.push_back(like(chunk, {bytes.begin(), end}));
      bytes.erase(bytes.begin(), end);
    }
  }
  return frames;
}

// Whether what is left of a damaged frame looks nowhere like the begin of another.
inline bool has_one_sync(const std::vector<std::uint8_t>& bytes) {
  return std::ranges::count(bytes, kVectorNavSync) == 1;
}

inline PlayedBytes noise_on_line(const PlayedBytes& piece, Random& random) {
  std::vector<std::uint8_t> noise(1 + below(random, 40));
  for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(below(random, kVectorNavSync));
  const std::size_t bytes = noise.size();
  return telling(like(piece, std::move(noise)), "skipped_byte", bytes);
}

inline PlayedBytes refused_frame(PlayedBytes piece) {
  const std::size_t bytes = piece.bytes.size();
  return telling(telling(std::move(piece), "bad_crc"), "skipped_byte", bytes);
}

// Without some bytes in its middle. None: it would look like the begin of another.
inline std::optional<PlayedBytes> shortened_frame(PlayedBytes piece, Random& random) {
  constexpr std::size_t kHeader = 4;
  const std::size_t from = kHeader + below(random, piece.bytes.size() - kHeader);
  const std::size_t count = 1 + below(random, piece.bytes.size() - from);
  const auto first = piece.bytes.begin() + static_cast<std::ptrdiff_t>(from);
  piece.bytes.erase(first, first + static_cast<std::ptrdiff_t>(count));
  return has_one_sync(piece.bytes) ? std::optional(refused_frame(std::move(piece))) : std::nullopt;
}

inline std::optional<PlayedBytes> corrupt_frame(PlayedBytes piece, Random& random) {
  constexpr std::size_t kHeader = 4;
  const std::size_t at = kHeader + below(random, piece.bytes.size() - kHeader);
  piece.bytes[at] = static_cast<std::uint8_t>(piece.bytes[at] ^ (1U << below(random, 8)));
  return has_one_sync(piece.bytes) ? std::optional(refused_frame(std::move(piece))) : std::nullopt;
}

// Sentences of NMEA, with their line end.

inline PlayedBytes line_of(const PlayedBytes& piece, const std::string& text) {
  return like(piece, {text.begin(), text.end()});
}

inline PlayedBytes nmea_garbage(const PlayedBytes& piece, Random& random) {
  std::string noise(1 + below(random, 60), '\0');
  for (char& byte : noise) byte = static_cast<char>(0x80U + below(random, 0x80));
  return telling(line_of(piece, noise), "skipped_byte", noise.size());
}

// A digit that is another one. None: the sentence has none where it may be changed.
inline std::optional<PlayedBytes> nmea_wrong_digit(PlayedBytes piece) {
  const auto star = std::ranges::find(piece.bytes, '*');
  const auto digit = std::find_if(piece.bytes.begin(), star, [](std::uint8_t c) { return c >= '0' && c <= '9'; });
  if (digit == star) return std::nullopt;
  *digit ^= 1U;
  return telling(std::move(piece), "bad_checksum");
}

// Its end is lost, and the next sentence follows.
inline PlayedBytes nmea_cut(PlayedBytes piece, Random& random) {
  piece.bytes.resize(1 + below(random, piece.bytes.size() - 3));
  return telling(std::move(piece), "broken_line");
}

inline PlayedBytes nmea_without_checksum(const PlayedBytes& piece) {
  return telling(line_of(piece, "$GNGGA,no,checksum\r\n"), "no_checksum");
}

inline PlayedBytes nmea_too_long(const PlayedBytes& piece, Random& random) {
  const std::size_t over = 1 + below(random, 100);
  const std::string text = fmt::format("${:x>{}}\r\n", "", kNmeaLineMax - 1 + over);
  return telling(telling(line_of(piece, text), "too_long"), "skipped_byte", over - 1);
}

inline PlayedBytes nmea_bad_field(const PlayedBytes& piece) {
  const std::string body = "GNGGA,12x000.000,,,,,0,00,,,,,,,";
  return telling(line_of(piece, fmt::format("${}*{:02X}\r\n", body, nmea_checksum(body))), "bad_field");
}

}  // namespace lxd::test

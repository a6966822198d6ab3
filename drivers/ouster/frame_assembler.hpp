// SPDX-License-Identifier: Apache-2.0
// Columns of many packets become one frame (a turn of the sensor). A frame ends where the frame id changes, or at
// flush(). Two frames of storage, made at construction; nothing is allocated afterwards.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/ouster/packet_parser.hpp"

namespace lxd {

// Pixels are stored column after column: index = column * rows + row. Columns that never came are not `present`.
struct OusterFrame {
  std::uint32_t frame_id = 0;
  std::size_t columns_present = 0;
  std::vector<std::uint8_t> present;        // per column
  std::vector<std::uint64_t> timestamp_ns;  // per column, sensor time
  std::vector<std::uint32_t> range_mm;      // first return; 0: none
  std::vector<std::uint16_t> reflectivity;
  std::vector<std::uint32_t> range2_mm;  // second return, weaker than the first; empty: the profile has none
  std::vector<std::uint16_t> reflectivity2;
};

class OusterFrameAssembler {
 public:
  OusterFrameAssembler(const OusterPacketFormat& format, std::uint16_t columns_per_frame);

  // The frame that this packet ended, null mostly. It stays valid until the next frame ends.
  const OusterFrame* add(const OusterPacket& packet);
  // The frame under construction, null when there is none.
  const OusterFrame* flush();

  [[nodiscard]] std::uint64_t stale_packets() const { return stale_packets_; }
  [[nodiscard]] std::uint64_t repeated_columns() const { return repeated_columns_; }
  // Frames of which not one packet came, by the gaps in the frame numbers.
  [[nodiscard]] std::uint64_t missing_frames() const { return missing_frames_; }
  // Packets that frames lack of which others came: those whose place in the frame was filled before, so that a sensor
  // with a window misses nothing. Of the frame under way none yet.
  [[nodiscard]] std::uint64_t missing_packets() const { return missing_packets_; }

 private:
  [[nodiscard]] std::int64_t frames_ahead(std::uint32_t frame_id) const;
  void begin_frame(std::uint32_t frame_id);
  void note_place(const OusterPacket& packet);
  void count_missing();
  void take_column(const OusterColumn& column);
  template <typename Value>
  void take_field(const OusterColumn& column, const BitField& field, Value* out) const;
  OusterFrame& current() { return frames_[current_]; }

  OusterPacketFormat format_;
  std::array<OusterFrame, 2> frames_;
  std::size_t current_ = 0;
  bool started_ = false;
  std::uint64_t stale_packets_ = 0;
  std::uint64_t repeated_columns_ = 0;
  std::uint64_t missing_frames_ = 0;
  // A packet's place is its first column's over the columns of a packet. In which frame each was filled last, counted
  // from one; zero: never.
  std::vector<std::uint64_t> filled_in_;
  std::uint64_t frame_number_ = 0;
  std::uint64_t missing_packets_ = 0;
};

}  // namespace lxd

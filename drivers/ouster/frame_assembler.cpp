// SPDX-License-Identifier: Apache-2.0
// See frame_assembler.hpp.
#include "drivers/ouster/frame_assembler.hpp"

#include <algorithm>

#include "drivers/ouster/block_field.hpp"

namespace lxd {
namespace {

// A packet this many frames late was overtaken on its way; one that is later still comes from a sensor that restarted
// and counts from zero again, which begins a frame.
constexpr std::int64_t kLateFrames = 8;
constexpr std::int64_t kLongestGapFrames = 600;  // a minute at 10 Hz; a wider gap is another numbering

}  // namespace

OusterFrameAssembler::OusterFrameAssembler(const OusterPacketFormat& format, std::uint16_t columns_per_frame)
    : format_(format), filled_in_(columns_per_frame / format.columns_per_packet + 1) {
  const std::size_t pixels = std::size_t{columns_per_frame} * format.pixels_per_column;
  for (OusterFrame& frame : frames_) {
    frame.present.resize(columns_per_frame);
    frame.timestamp_ns.resize(columns_per_frame);
    frame.range_mm.resize(pixels);
    frame.reflectivity.resize(pixels);
    const std::size_t second_pixels = format.profile->fields.range2_mm.present() ? pixels : 0;
    frame.range2_mm.resize(second_pixels);
    frame.reflectivity2.resize(second_pixels);
  }
}

const OusterFrame* OusterFrameAssembler::add(const OusterPacket& packet) {
  const OusterFrame* ended = nullptr;
  if (!started_) {
    begin_frame(packet.frame_id);
  } else if (const std::int64_t ahead = frames_ahead(packet.frame_id); ahead != 0) {
    if (ahead < 0 && ahead >= -kLateFrames) {
      ++stale_packets_;
      return nullptr;
    }
    if (ahead > 1 && ahead <= kLongestGapFrames) missing_frames_ += static_cast<std::uint64_t>(ahead - 1);
    ended = flush();
    count_missing();
    begin_frame(packet.frame_id);
  }
  note_place(packet);
  for (const OusterColumn& column : packet.columns()) take_column(column);
  return ended;
}

const OusterFrame* OusterFrameAssembler::flush() {
  if (!started_) return nullptr;
  started_ = false;
  return &current();
}

// The difference of two counters that wrap, folded to half their range.
std::int64_t OusterFrameAssembler::frames_ahead(std::uint32_t frame_id) const {
  const std::int64_t range = std::int64_t{1} << format_.framing().frame_id_bits;
  const std::int64_t difference = std::int64_t{frame_id} - std::int64_t{frames_[current_].frame_id};
  if (difference >= range / 2) return difference - range;
  if (difference < -range / 2) return difference + range;
  return difference;
}

void OusterFrameAssembler::begin_frame(std::uint32_t frame_id) {
  current_ = 1 - current_;
  started_ = true;
  ++frame_number_;
  current().frame_id = frame_id;
  current().columns_present = 0;
  std::fill(current().present.begin(), current().present.end(), std::uint8_t{0});
}

// One beyond the frame is the sensor's mistake, and none of its columns is sound.
void OusterFrameAssembler::note_place(const OusterPacket& packet) {
  const std::size_t place = packet.first_measurement_id / format_.columns_per_packet;
  if (place < filled_in_.size()) filled_in_[place] = frame_number_;
}

// In the frame that has just ended.
void OusterFrameAssembler::count_missing() {
  missing_packets_ +=
      static_cast<std::uint64_t>(std::count_if(filled_in_.begin(), filled_in_.end(), [this](std::uint64_t frame) {
        return frame != 0 && frame < frame_number_;
      }));
}

void OusterFrameAssembler::take_column(const OusterColumn& column) {
  OusterFrame& frame = current();
  if (frame.present[column.measurement_id] != 0) {
    ++repeated_columns_;
    return;
  }
  frame.present[column.measurement_id] = 1;
  frame.timestamp_ns[column.measurement_id] = column.timestamp_ns;
  ++frame.columns_present;
  const OusterChannelFields& fields = format_.profile->fields;
  const std::size_t pixel = std::size_t{column.measurement_id} * format_.pixels_per_column;
  take_field(column, fields.range_mm, &frame.range_mm[pixel]);
  take_field(column, fields.reflectivity, &frame.reflectivity[pixel]);
  if (!fields.range2_mm.present()) return;
  take_field(column, fields.range2_mm, &frame.range2_mm[pixel]);
  take_field(column, fields.reflectivity2, &frame.reflectivity2[pixel]);
}

// One field of all the column's pixels.
template <typename Value>
void OusterFrameAssembler::take_field(const OusterColumn& column, const BitField& field, Value* out) const {
  const std::size_t bytes = format_.profile->channel_bytes;
  BlockField(field, bytes).get(column.channels, bytes, format_.pixels_per_column, out);
}

}  // namespace lxd

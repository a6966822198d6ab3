// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/ouster_encoder.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/crc.hpp"

namespace lxd::sim {
namespace {

constexpr double kPerCent = 100;
constexpr double kPhotonsAtOneMeter = 1e5;  // of a white surface met head on; indoors signals are then 100 to 10,000
constexpr double kSunlight = 1500;          // near-infrared background of a white surface
constexpr std::uint64_t kColumnValid = 1, kLegacyColumnValid = 0xFFFFFFFF;

std::uint64_t limited(double value, const BitField& field) {
  const auto most = static_cast<double>(field.mask() << field.scale_bits);
  return static_cast<std::uint64_t>(std::lround(std::clamp(value, 0.0, most)));
}

void encode_pixel(const OusterChannelFields& fields, const Return& pixel, double wire_range_m, std::uint8_t* block) {
  if (!pixel.found()) return;
  fields.range_mm.set(block, ouster_wire_range_mm(fields, wire_range_m));
  fields.reflectivity.set(block, ouster_wire_reflectivity(pixel));
  const double range_m = std::max<double>(pixel.range_m, 1);
  if (fields.signal.present()) {
    fields.signal.set(block, limited(kPhotonsAtOneMeter * pixel.brightness / (range_m * range_m), fields.signal));
  }
  fields.near_ir.set(block, limited(kSunlight * pixel.albedo, fields.near_ir));
}

}  // namespace

std::uint64_t ouster_wire_range_mm(const OusterChannelFields& fields, double range_m) {
  constexpr double kMillimetersPerMeter = 1e3;
  const auto unit = static_cast<double>(1ULL << fields.range_mm.scale_bits);
  const auto most = static_cast<double>(fields.range_mm.mask());
  const double units = std::round(range_m * kMillimetersPerMeter / unit);
  return static_cast<std::uint64_t>(std::clamp(units, 1.0, most) * unit);
}

std::uint64_t ouster_wire_reflectivity(const Return& pixel) {
  return static_cast<std::uint64_t>(std::lround(std::clamp<double>(pixel.brightness, 0, 1) * kPerCent));
}

std::vector<std::uint8_t> encode_ouster_packet(const OusterPacketFormat& format, const OusterPacketHeader& header,
                                               std::span<const std::int64_t> stamps_ns, const OusterTurn& turn,
                                               const OusterScanner& scanner) {
  const OusterFraming& framing = format.framing();
  const bool valid = turn.fault != ShotFault::kEmpty;
  std::vector<std::uint8_t> packet(format.packet_bytes());
  framing.packet_type.set(packet.data(), kOusterLidarPacket);
  framing.packet_frame_id.set(packet.data(), header.frame_id);
  framing.init_id.set(packet.data(), header.init_id);
  framing.serial.set(packet.data(), header.serial);
  for (std::size_t c = 0; c < format.columns_per_packet; ++c) {
    std::uint8_t* const column = packet.data() + format.column_offset(c);
    const std::size_t id = header.first_column + c;
    framing.timestamp_ns.set(column, static_cast<std::uint64_t>(stamps_ns[c]));
    framing.measurement_id.set(column, id);
    framing.column_frame_id.set(column, header.frame_id);
    framing.header_status.set(column, valid ? kColumnValid : 0);
    framing.footer_status.set(column + format.column_bytes() - framing.column_footer_bytes,
                              valid ? kLegacyColumnValid : 0);
    std::uint8_t* block = column + framing.column_header_bytes;
    for (std::size_t row = 0; row < format.pixels_per_column; ++row, block += format.profile->channel_bytes) {
      const Return& pixel = turn.pixels[id * format.pixels_per_column + row];
      encode_pixel(format.profile->fields, pixel, scanner.wire_range_m(pixel), block);
    }
  }
  if (framing.crc.present()) {
    const auto checked = std::span(packet).first(packet.size() - sizeof(std::uint64_t));
    framing.crc.set(packet.data() + format.footer_offset(), crc64(checked));
  }
  return packet;
}

}  // namespace lxd::sim

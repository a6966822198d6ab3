// SPDX-License-Identifier: Apache-2.0
// What a rig recording says was on each wire and when, for those who put it onto wires again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "drivers/replay/can_log.hpp"
#include "drivers/replay/datagram_capture.hpp"
#include "drivers/replay/serial_log.hpp"

namespace lxd::hil {

struct Piece {
  RigTime t;
  std::vector<std::uint8_t> bytes;
};

inline std::vector<Piece> datagrams_of(const std::filesystem::path& pcap) {
  auto file = PcapFile::open(pcap);
  if (!file) throw std::runtime_error(file.error().message);
  DatagramCapture capture(std::move(*file));
  Rejections ignored;
  std::vector<Piece> all;
  while (const auto datagram = capture.next(ignored))
    all.push_back({datagram->received, {datagram->udp.payload.begin(), datagram->udp.payload.end()}});
  return all;
}

inline std::vector<Piece> serial_of(const std::filesystem::path& path) {
  auto log = SerialLog::open(path);
  if (!log) throw std::runtime_error(log.error().message);
  std::vector<Piece> all;
  SerialChunk chunk;
  Rejections ignored;
  while (log->next(chunk, ignored)) all.push_back({chunk.received, {chunk.bytes.begin(), chunk.bytes.end()}});
  return all;
}

inline std::vector<CanFrame> frames_of(const std::filesystem::path& path) {
  auto log = CanLogReader::open(path);
  if (!log) throw std::runtime_error(log.error().message);
  std::vector<CanFrame> all;
  CanLogRecord record;
  while (log->next(record)) all.push_back(record.frame);
  return all;
}

}  // namespace lxd::hil

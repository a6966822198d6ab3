// SPDX-License-Identifier: Apache-2.0
#include "board/chunk_file.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "board/camera_file.hpp"
#include "board/signal_files.hpp"
#include "drivers/device/can_wire.hpp"
#include "drivers/replay/can_log.hpp"
#include "drivers/replay/gpio_log.hpp"
#include "drivers/replay/imu_source.hpp"
#include "drivers/replay/nmea_log_writer.hpp"
#include "drivers/replay/pcap_writer.hpp"
#include "drivers/replay/pps_log.hpp"
#include "drivers/replay/serial_log_writer.hpp"
#include "drivers/replay/wheel_source.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;
using Created = Result<std::unique_ptr<ChunkFile>>;

UdpEnd end_of(std::uint32_t address, std::uint16_t port) {
  UdpEnd end;
  end.address = {static_cast<std::uint8_t>(address >> 24U), static_cast<std::uint8_t>(address >> 16U),
                 static_cast<std::uint8_t>(address >> 8U), static_cast<std::uint8_t>(address)};
  end.port = port;
  return end;
}

class DatagramFile final : public ChunkFile {
 public:
  explicit DatagramFile(PcapWriter writer) : writer_(std::move(writer)) {}
  Status append(const Chunk& chunk) override {
    const ChunkOrigin& o = chunk.origin;
    const UdpRoute route{end_of(o.source_address, o.source_port), end_of(o.destination_address, o.destination_port)};
    return writer_.write(route, chunk.bytes, chunk.received);
  }
  Status close() override { return writer_.close(); }

 protected:
  [[nodiscard]] GrowingFile& file() override { return writer_.file(); }

 private:
  PcapWriter writer_;
};

class FrameFile final : public ChunkFile {
 public:
  FrameFile(GrowingFile file, const std::string& interface) : file_(std::move(file)) {
    record_.set_interface(interface);
  }
  Status append(const Chunk& chunk) override {
    const auto frame = can_frame_of(chunk.bytes, chunk.received);
    if (!frame) return success();  // the device hands over none such
    record_.frame = *frame;
    const std::string line = can_log_line(record_);
    return file_.append({{reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}});
  }
  Status close() override { return file_.close(); }

 protected:
  [[nodiscard]] GrowingFile& file() override { return file_; }

 private:
  GrowingFile file_;
  CanLogRecord record_;
};

// SerialLogWriter or NmeaLogWriter.
template <typename Writer>
class LineBytesFile final : public ChunkFile {
 public:
  explicit LineBytesFile(Writer writer) : writer_(std::move(writer)) {}
  Status append(const Chunk& chunk) override { return writer_.append(chunk.received, chunk.bytes); }
  Status close() override { return writer_.close(); }

 protected:
  [[nodiscard]] GrowingFile& file() override { return writer_.file(); }

 private:
  Writer writer_;
};

template <typename Writer>
Created create_line(const fs::path& path) {
  auto writer = Writer::create(path);
  return writer ? Created(std::make_unique<LineBytesFile<Writer>>(std::move(*writer))) : Created(writer.error());
}

Created create_frames(const fs::path& path, const std::string& interface) {
  auto file = GrowingFile::create(path);
  return file ? Created(std::make_unique<FrameFile>(std::move(*file), interface)) : Created(file.error());
}

Created create_datagrams(const fs::path& path) {
  auto writer = PcapWriter::create(path, PcapStamps::as_given);
  return writer ? Created(std::make_unique<DatagramFile>(std::move(*writer))) : Created(writer.error());
}

}  // namespace

Created create_chunk_file(LiveChannel channel, const Rig& rig, const fs::path& recording) {
  switch (channel) {
    case LiveChannel::imu:
      return create_line<SerialLogWriter>(recording / kImuSerialFile);
    case LiveChannel::gnss:
      return create_line<NmeaLogWriter>(recording / "gnss.nmea");
    case LiveChannel::wheel:
      return create_frames(recording / kCanLogFile, rig.wheel->wire.interface);
    case LiveChannel::camera0:
      return create_camera_file(*rig.camera0, recording / name_of(channel));
    case LiveChannel::pps:
      return create_pulse_file(*rig.pps, recording / kPpsLogFile);
    case LiveChannel::triggers:
      return create_trigger_file(*rig.triggers, recording / kGpioLogFile);
    default:
      return create_datagrams(recording / fmt::format("{}.pcap", name_of(channel)));
  }
}

}  // namespace lxd

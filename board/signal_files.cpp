// SPDX-License-Identifier: Apache-2.0
#include "board/signal_files.hpp"

#include <fmt/format.h>

#include "drivers/replay/gpio_log.hpp"
#include "drivers/replay/growing_file.hpp"
#include "drivers/replay/pps_log.hpp"
#include "drivers/sync/pulse_wire.hpp"

namespace lxd {
namespace {

using Created = Result<std::unique_ptr<ChunkFile>>;

// A line a chunk, below a header.
class LinesFile : public ChunkFile {
 public:
  explicit LinesFile(GrowingFile file) : file_(std::move(file)) {}
  Status close() override { return file_.close(); }

 protected:
  Status append_line(const std::string& line) {
    return file_.append({{reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}});
  }
  [[nodiscard]] GrowingFile& file() override { return file_; }

 private:
  GrowingFile file_;
};

class PulseFile final : public LinesFile {
 public:
  PulseFile(GrowingFile file, const PulseRig& rig) : LinesFile(std::move(file)), reader_(begins_at(rig)) {}
  Status append(const Chunk& chunk) override {
    const auto pulse = reader_.read(chunk);
    return pulse ? append_line(fmt::format("{},{}\n", pulse->edge.ns(), pulse->sequence)) : success();
  }

 private:
  PulseReader reader_;
};

// Both edges. One line: its count is that of all.
class TriggerFile final : public LinesFile {
 public:
  TriggerFile(GrowingFile file, const TriggersRig& rig)
      : LinesFile(std::move(file)), offset_(rig.camera0.line.value_or(0)) {}
  Status append(const Chunk& chunk) override {
    ++sequence_;
    return append_line(fmt::format("{},{},{},{},{},{}\n", chunk.received.ns(), offset_, kCameraLine,
                                   is_edge(chunk, GpioEdge::rising) ? "rising" : "falling", sequence_, sequence_));
  }

 private:
  std::uint32_t offset_, sequence_ = 0;
};

template <typename File, typename Rig>
Created create(const std::filesystem::path& path, const Rig& rig, const char* header) {
  auto file = GrowingFile::create(path);
  if (!file) return file.error();
  const std::string line = fmt::format("{}\n", header);
  const Status begun = file->append({{reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}});
  return begun ? Created(std::make_unique<File>(std::move(*file), rig)) : Created(begun.error());
}

}  // namespace

Created create_pulse_file(const PulseRig& rig, const std::filesystem::path& path) {
  return create<PulseFile>(path, rig, kPpsLogHeader);
}

Created create_trigger_file(const TriggersRig& rig, const std::filesystem::path& path) {
  return create<TriggerFile>(path, rig, kGpioLogHeader);
}

GpioEdge begins_at(const PulseRig& rig) { return rig.edge == "clear" ? GpioEdge::falling : GpioEdge::rising; }
GpioEdge triggers_at(const TriggersRig& rig) { return rig.edge == "falling" ? GpioEdge::falling : GpioEdge::rising; }

}  // namespace lxd

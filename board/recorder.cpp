// SPDX-License-Identifier: Apache-2.0
#include "board/recorder.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "board/camera_file.hpp"
#include "board/rig_file.hpp"
#include "board/rig_text.hpp"
#include "board/run_folder.hpp"
#include "board/run_output.hpp"
#include "drivers/replay/unfinished_recording.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

constexpr Duration kHousePeriod = Duration::from_ns(100'000'000);   // of flushing to the system, and of progress
constexpr Duration kSyncPeriod = Duration::from_ns(5'000'000'000);  // of flushing to the disk
constexpr std::chrono::milliseconds kNothingWaits{5};
constexpr int kLastTurns = 64;  // to empty the kernel's buffers at the end

// A recording is never replaced: nobody can drive the same way again.
Status make_empty_folder(const fs::path& out) {
  std::error_code error;
  fs::create_directories(out, error);
  if (error) return Error{fmt::format("{}: cannot be made: {}", out.string(), error.message())};
  const bool empty = fs::is_empty(out, error);
  if (!error && empty) return success();
  return Error{fmt::format("{}: found a folder that holds something, wanted a new or empty one", out.string())};
}

// The metadata go into the folder under the name that a replay looks for.
Rig recorded_rig(const LiveRig& live) {
  Rig rig = live.rig;
  for (const LiveLidar& lidar : live.lidars) {
    LidarWire& wire = lidar.channel == LiveChannel::lidar0 ? rig.lidar0.wire : rig.lidar1->wire;
    wire.port = lidar.wire.port;
    wire.imu_port = lidar.wire.imu_port;
    if (lidar.metadata) wire.metadata = fmt::format("{}.json", name_of(lidar.channel));
  }
  return rig;
}

}  // namespace

class Recorder::Sink final : public ChunkSink {
 public:
  Sink(const std::vector<std::unique_ptr<RecordingStream>>& streams, SensorWatch& watch) : watch_(watch) {
    for (const auto& stream : streams) by_channel_[index_of(stream->channel())] = stream.get();
  }
  void take(const Chunk& chunk) override {
    by_channel_[chunk.channel]->put(chunk);
    watch_.heard(channel_at(chunk.channel), chunk.received);
  }

 private:
  std::array<RecordingStream*, kLiveChannels> by_channel_{};
  SensorWatch& watch_;
};

Result<std::unique_ptr<Recorder>> Recorder::open(const RecordRequest& request) {
  const RigFile file = load_rig(request.rig.string());
  if (!file.ok()) return Error{text_of(file.problems)};
  auto live = make_live(file.rig, request.rig.parent_path());
  if (!live) return live.error();
  auto clock = std::make_unique<HostClock>();
  auto devices = open_devices(*live, LidarPorts::points_and_imu, *clock, request.kernel);
  if (!devices) return devices.error();
  std::unique_ptr<Recorder> recorder(new Recorder(request, std::move(*live), std::move(*devices), std::move(clock)));
  Status begun = recorder->begin_folder();
  if (begun) begun = recorder->create_streams();
  if (!begun) return begun.error();
  return recorder;
}

Recorder::Recorder(const RecordRequest& request, LiveRig live, LiveDevices devices, std::unique_ptr<HostClock> clock)
    : request_(request),
      live_(std::move(live)),
      clock_(std::move(clock)),
      remarks_(live_.remarks),
      io_(std::move(devices.devices), *clock_, events_),
      watch_(live_, events_) {
  std::ranges::move(devices.remarks, std::back_inserter(remarks_));
  if (devices.camera) camera_io_.emplace(IoLoop::of(std::move(devices.camera)), *clock_, events_);
}

Status Recorder::begin_folder() {
  Status made = make_empty_folder(request_.out);
  if (made) made = write_text(request_.out / kUnfinishedMark, kUnfinishedText);
  if (made) made = write_text(request_.out / run_files::kRig, rig_text(recorded_rig(live_)));
  for (const LiveLidar& lidar : live_.lidars) {
    if (!made || !lidar.metadata) continue;
    made = write_text(request_.out / fmt::format("{}.json", name_of(lidar.channel)), lidar.metadata_text);
  }
  return made;
}

Status Recorder::create_streams() {
  const auto create = [&](LiveChannel channel) -> Status {
    auto file = create_chunk_file(channel, live_.rig, request_.out);
    if (!file) return file.error();
    const std::size_t longest = channel == LiveChannel::camera0 ? frame_bytes_max(*live_.rig.camera0) : 0;
    streams_.push_back(std::make_unique<RecordingStream>(channel, std::move(*file), longest));
    return success();
  };
  Status created = success();
  for (const LiveLidar& lidar : live_.lidars) keep_first(created, create(lidar.channel));
  if (live_.sensors.imu && !live_.uses_lidar_imu()) keep_first(created, create(LiveChannel::imu));
  if (live_.sensors.wheel) keep_first(created, create(LiveChannel::wheel));
  if (live_.sensors.gnss) keep_first(created, create(LiveChannel::gnss));
  if (live_.sensors.camera) keep_first(created, create(LiveChannel::camera0));
  if (live_.pulse) keep_first(created, create(LiveChannel::pps));
  if (live_.triggers) keep_first(created, create(LiveChannel::triggers));
  return created;
}

Status Recorder::run(const RecordObserver& observe, const std::atomic<bool>& stop) {
  begin_ = next_house_ = clock_->now();
  next_sync_ = begin_ + kSyncPeriod;
  std::vector<std::thread> readers;
  readers.emplace_back([this] { read_until_stopped(io_, kLastTurns); });
  if (camera_io_) readers.emplace_back([this] { read_until_stopped(*camera_io_, 1); });
  write_until(observe, stop);
  stopping_ = true;
  for (std::thread& reader : readers) reader.join();
  while (write_waiting()) {
  }
  Status finished = finish();
  observe(progress());
  return finished;
}

// A camera takes tenths of a second to open: it has a thread of its own.
void Recorder::read_until_stopped(IoLoop& io, int last_turns) {
  Sink sink(streams_, watch_);
  while (!stopping_) io.turn(sink);
  io.drain(sink, last_turns);
}

std::map<std::string, std::map<std::string, std::uint64_t>> Recorder::device_counts() const {
  auto counts = io_.counts();
  if (camera_io_) counts.merge(camera_io_->counts());
  return counts;
}

void Recorder::write_until(const RecordObserver& observe, const std::atomic<bool>& stop) {
  while (!over(clock_->now(), stop)) {
    if (!write_waiting()) std::this_thread::sleep_for(kNothingWaits);
    keep_house(observe);
  }
}

bool Recorder::over(RigTime now, const std::atomic<bool>& stop) const {
  if (stop || (request_.duration && now - begin_ >= *request_.duration)) return true;
  return std::ranges::all_of(streams_, [](const auto& stream) { return stream->ended(); });
}

// A bounded part of what waits in each ring, so that none waits for another.
bool Recorder::write_waiting() {
  constexpr int kAtOnce = 256;
  bool any = false;
  for (const auto& stream : streams_)
    for (int i = 0; i < kAtOnce && stream->write(); ++i) any = true;
  return any;
}

void Recorder::keep_house(const RecordObserver& observe) {
  const RigTime now = clock_->now();
  if (now < next_house_) return;
  next_house_ = now + kHousePeriod;
  const bool sync = now >= next_sync_;
  if (sync) next_sync_ = now + kSyncPeriod;
  for (const auto& stream : streams_) {
    if (stream->ended()) continue;
    sync ? stream->sync() : stream->flush();
    if (stream->ended()) events_.add(now, std::string(name_of(stream->channel())), stream->failure());
  }
  watch_.look(now);
  observe(progress());
}

RecordProgress Recorder::progress() {
  RecordProgress progress;
  progress.elapsed_s = (clock_->now() - begin_).seconds();
  for (const auto& stream : streams_) {
    const StreamCounts counts = stream->counts();
    progress.chunks += counts.chunks;
    progress.dropped += counts.no_room + counts.refused + counts.not_written;
    progress.written_bytes += stream->written_bytes();
  }
  progress.silent = watch_.silent();
  progress.events = events_.after(events_told_);
  events_told_ += progress.events.size();
  return progress;
}

// The mark stays where a file ended before the recording did.
Status Recorder::finish() {
  Status first = success();
  for (const auto& stream : streams_) {
    stream->close();
    if (stream->ended()) keep_first(first, Error{stream->failure()});
  }
  keep_first(first, write_text(request_.out / kRecordingFile, summary_json()));
  std::error_code error;
  if (first) fs::remove(request_.out / kUnfinishedMark, error);
  if (error) keep_first(first, Error{fmt::format("{}: {}", kUnfinishedMark, error.message())});
  return first;
}

std::string Recorder::summary_json() const {
  constexpr int kIndent = 2;
  nlohmann::ordered_json json{{"begin_s", begin_.seconds()}, {"duration_s", (clock_->now() - begin_).seconds()}};
  for (const auto& stream : streams_) {
    const StreamCounts counts = stream->counts();
    json["sensors"][std::string(name_of(stream->channel()))] = {
        {"chunks", counts.chunks},           {"bytes", counts.bytes},
        {"no_room", counts.no_room},         {"refused", counts.refused},
        {"not_written", counts.not_written}, {"written_bytes", stream->written_bytes()}};
  }
  json["devices"] = device_counts();
  for (const RigEvent& event : events_.after(0))
    json["events"].push_back({{"t", event.t.seconds()}, {"source", event.source}, {"what", event.what}});
  json["events_left_out"] = events_.left_out();
  json["host_clock_set_by_s"] = clock_->host_ahead().seconds();
  return json.dump(kIndent) + "\n";
}

}  // namespace lxd

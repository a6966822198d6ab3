// SPDX-License-Identifier: Apache-2.0
// Records a live rig: bytes as they came, each with its time, into the folder that a replay reads. Memory is bounded; a
// sensor that goes away, a disk that is slow or full cost what could not be written, and nothing else.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "board/event_log.hpp"
#include "board/io_loop.hpp"
#include "board/live_rig.hpp"
#include "board/recording_stream.hpp"
#include "board/sensor_watch.hpp"

namespace lxd {

inline constexpr const char* kRecordingFile = "recording.json";  // what came, what was lost, what happened

struct RecordRequest {
  std::filesystem::path rig, out;
  std::optional<Duration> duration;  // none: until told to stop
  LiveKernel kernel{};
};

struct RecordProgress {
  double elapsed_s = 0;
  std::uint64_t chunks = 0, dropped = 0;
  std::uint64_t written_bytes = 0;  // that killing the program does not lose
  std::string silent;               // sensors that are not heard
  std::vector<RigEvent> events;     // since the last time
};
using RecordObserver = std::function<void(const RecordProgress&)>;

class Recorder {
 public:
  // Errors are the caller's to mend: the rig file, a port, a folder that holds something.
  static Result<std::unique_ptr<Recorder>> open(const RecordRequest& request);

  // Until `stop` becomes true, the duration is over or no file can be written any more. Error: what could not be
  // written; all else is there. Once.
  Status run(const RecordObserver& observe, const std::atomic<bool>& stop);

  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }
  [[nodiscard]] const std::vector<std::unique_ptr<RecordingStream>>& streams() const { return streams_; }
  [[nodiscard]] std::map<std::string, std::map<std::string, std::uint64_t>> device_counts() const;

 private:
  class Sink;
  Recorder(const RecordRequest& request, LiveRig live, LiveDevices devices, std::unique_ptr<HostClock> clock);

  Status begin_folder();
  Status create_streams();
  void read_until_stopped(IoLoop& io, int last_turns);
  void write_until(const RecordObserver& observe, const std::atomic<bool>& stop);
  bool write_waiting();
  void keep_house(const RecordObserver& observe);
  [[nodiscard]] bool over(RigTime now, const std::atomic<bool>& stop) const;
  [[nodiscard]] RecordProgress progress();
  Status finish();
  [[nodiscard]] std::string summary_json() const;

  RecordRequest request_;
  LiveRig live_;
  std::unique_ptr<HostClock> clock_;
  std::vector<std::string> remarks_;
  EventLog events_;
  IoLoop io_;
  std::optional<IoLoop> camera_io_;
  SensorWatch watch_;
  std::vector<std::unique_ptr<RecordingStream>> streams_;
  std::atomic<bool> stopping_{false};
  RigTime begin_, next_house_, next_sync_;
  std::size_t events_told_ = 0;
};

}  // namespace lxd

// SPDX-License-Identifier: Apache-2.0
// One topic's messages into a sensor's part of a generic folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "drivers/replay/rejections.hpp"
#include "drivers/ros1/header.hpp"
#include "rt/result.hpp"
#include "rt/time.hpp"
#include "tools/import/topic_choice.hpp"

namespace lxd {

// What became of a topic's messages.
struct TopicCounts {
  std::uint64_t messages = 0;  // that came
  std::uint64_t written = 0;
  Rejections rejected;          // messages that were not written, and points of those that were, by cause
  std::uint64_t unstamped = 0;  // written by the bag's time, since their header has none
  std::map<std::string, std::uint64_t> remarks;  // what else a user should know, and of how many messages
};

class MessageWriter {
 public:
  // Makes the sensor's file or folder. Errors name it.
  static Result<std::unique_ptr<MessageWriter>> create(const TopicChoice& choice, const std::filesystem::path& folder);
  MessageWriter() = default;
  MessageWriter(const MessageWriter&) = delete;
  MessageWriter& operator=(const MessageWriter&) = delete;
  virtual ~MessageWriter() = default;

  // A message as the bag has it, and when the bag received it. Error: the disk is full, ...; a message that is refused
  // is counted, and is none.
  Status take(Ros1Reader::Bytes message, RigTime received);
  // All is written.
  virtual Status close() = 0;

  [[nodiscard]] const TopicCounts& counts() const { return counts_; }

 protected:
  // Writes the message and counts it as written, or says why it cannot be: the fault is counted by take().
  virtual Result<Ros1Fault> write(Ros1Reader::Bytes message, RigTime received) = 0;
  // The header's stamp, else, and counted, the bag's time.
  RigTime time_of(const Ros1Header& header, RigTime received);

  TopicCounts counts_;
};

}  // namespace lxd

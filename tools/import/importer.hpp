// SPDX-License-Identifier: Apache-2.0
// Bags and a rig file into a generic folder that a replay runs.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "rt/result.hpp"
#include "tools/import/bag_reader.hpp"
#include "tools/import/message_writer.hpp"
#include "tools/import/topic_choice.hpp"
#include "tools/recording/recording_folder.hpp"

namespace lxd {

struct ImportRequest {
  std::vector<std::filesystem::path> bags;
  std::filesystem::path rig, out;
  std::vector<std::string> asked;  // "lidar0=/points"
};

struct ImportedTopic {
  TopicChoice choice;
  TopicCounts counts;
};

struct ImportSummary {
  std::vector<ImportedTopic> topics;
  std::vector<std::string> remarks;
  double duration_s = 0;  // of the bags
};

using ImportObserver = std::function<void(double part)>;

// What is to be read, and the folder under way; nothing is left of it if it is not imported.
struct ImportPlan {
  ImportRequest request;
  BagReader bags;
  TopicChoices choices;
  RecordingFolder folder;
};

// Errors: the rig file's problems, bags and topics as BagReader::open and choose_topics tell, a folder that holds
// something else.
Result<ImportPlan> plan_import(const ImportRequest& request);

// The folder appears when it is whole, or not at all. Errors: a bag that is damaged farther on, a full disk, a topic of
// which no message could be written, with the causes.
Result<ImportSummary> import_bags(ImportPlan plan, const ImportObserver& observe, const std::atomic<bool>& stop);

}  // namespace lxd

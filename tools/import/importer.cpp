// SPDX-License-Identifier: Apache-2.0
#include "tools/import/importer.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "board/rig_file.hpp"
#include "board/run_folder.hpp"

namespace lxd {
namespace {

namespace fs = std::filesystem;

constexpr const char* kImportFile = "import.json";
constexpr std::array<std::string_view, 7> kImportEntries{"lidar0",    "lidar1",    "imu.csv", "camera0",
                                                         "gnss.nmea", "truth.tum", "rig.yaml"};
constexpr RecordingKind kImportedBag{"an import", kImportFile, kImportEntries};

Result<Rig> load_sound_rig(const fs::path& file) {
  RigFile loaded = load_rig(file.string());
  if (!loaded.ok()) return Error{text_of(loaded.problems)};
  return std::move(loaded.rig);
}

// A generic folder has imu.csv, and no packets with an IMU in them.
Status check_imu(const Rig& rig, const TopicChoices& choices, const fs::path& file) {
  for (const TopicChoice& choice : choices.topics) {
    if (choice.sensor != "imu" || !rig.imu->of_lidar()) continue;
    return Error{fmt::format("{}: imu.protocol: found \"{}\", wanted none: the bag's topic {} becomes imu.csv",
                             file.string(), kLidarImuProtocol, choice.topic)};
  }
  return success();
}

nlohmann::ordered_json json_of(const ImportRequest& request, const ImportSummary& summary) {
  nlohmann::ordered_json json{{"bags", nlohmann::ordered_json::array()}, {"topics", nlohmann::ordered_json::object()}};
  for (const fs::path& bag : request.bags) json["bags"].push_back(bag.filename().string());
  for (const auto& [choice, counts] : summary.topics)
    json["topics"][choice.sensor] = {
        {"topic", choice.topic},       {"messages", counts.messages},       {"written", counts.written},
        {"rejected", counts.rejected}, {"without_stamp", counts.unstamped}, {"remarks", counts.remarks}};
  json["remarks"] = summary.remarks;
  return json;
}

Error nothing_written(const TopicChoice& choice, const TopicCounts& counts) {
  std::vector<std::string> causes;
  for (const auto& [cause, times] : counts.rejected) causes.push_back(fmt::format("{} {}", cause, times));
  for (const auto& [remark, times] : counts.remarks) causes.push_back(remark);
  return Error{fmt::format("{}: none of the {} messages of {} could be read: {}{}", choice.sensor, counts.messages,
                           choice.topic, fmt::join(causes, ", "),
                           choice.sensor == "lidar0" ? "" : fmt::format("; --topic {}= leaves it out", choice.sensor))};
}

// The writers of the chosen topics, by topic.
class Writers {
 public:
  static Result<Writers> create(const TopicChoices& choices, const fs::path& folder) {
    Writers writers;
    for (const TopicChoice& choice : choices.topics) {
      auto writer = MessageWriter::create(choice, folder);
      if (!writer) return writer.error();
      writers.by_topic_[choice.topic] = {choice, std::move(*writer)};
    }
    return writers;
  }

  Status take(const BagMessage& message) {
    return by_topic_.at(message.topic).writer->take(message.bytes, message.received);
  }

  Result<std::vector<ImportedTopic>> close() {
    std::vector<ImportedTopic> topics;
    for (auto& [topic, entry] : by_topic_) {
      const TopicCounts& counts = entry.writer->counts();
      if (counts.written == 0) return nothing_written(entry.choice, counts);
      if (Status closed = entry.writer->close(); !closed) return closed.error();
      topics.push_back({entry.choice, counts});
    }
    return topics;
  }

 private:
  struct Entry {
    TopicChoice choice;
    std::unique_ptr<MessageWriter> writer;
  };
  std::map<std::string, Entry> by_topic_;
};

std::vector<std::string> names_of(const TopicChoices& choices) {
  std::vector<std::string> names;
  for (const TopicChoice& choice : choices.topics) names.push_back(choice.topic);
  return names;
}

std::uint64_t count_messages(const BagReader& bags, const std::vector<std::string>& names) {
  std::uint64_t count = 0;
  for (const BagTopic& topic : bags.topics())
    if (std::ranges::find(names, topic.name) != names.end()) count += topic.messages;
  return count;
}

Result<std::vector<ImportedTopic>> write_topics(BagReader& bags, const TopicChoices& choices, const fs::path& folder,
                                                const ImportObserver& observe, const std::atomic<bool>& stop) {
  auto writers = Writers::create(choices, folder);
  if (!writers) return writers.error();
  const std::vector<std::string> names = names_of(choices);
  const auto total = static_cast<double>(count_messages(bags, names));
  std::uint64_t done = 0;
  const Status read = bags.read(names, [&](const BagMessage& message) -> Status {
    if (stop) return Error{"stopped: no recording is left"};
    observe(static_cast<double>(++done) / total);
    return writers->take(message);
  });
  if (!read) return read.error();
  return writers->close();
}

}  // namespace

Result<ImportPlan> plan_import(const ImportRequest& request) {
  auto rig = load_sound_rig(request.rig);
  if (!rig) return rig.error();
  auto bags = BagReader::open(request.bags);
  if (!bags) return bags.error();
  auto choices = choose_topics(bags->topics(), *rig, request.asked);
  if (!choices) return choices.error();
  if (Status sound = check_imu(*rig, *choices, request.rig); !sound) return sound.error();
  auto folder = RecordingFolder::create(request.out, 0, kImportedBag);
  if (!folder) return folder.error();
  return ImportPlan{request, std::move(*bags), std::move(*choices), std::move(*folder)};
}

Result<ImportSummary> import_bags(ImportPlan plan, const ImportObserver& observe, const std::atomic<bool>& stop) {
  const fs::path& folder = plan.folder.path();
  auto topics = write_topics(plan.bags, plan.choices, folder, observe, stop);
  if (!topics) return topics.error();
  const double duration_s = (plan.bags.end() - plan.bags.begin()).seconds();
  const ImportSummary summary{std::move(*topics), std::move(plan.choices.remarks), duration_s};
  std::error_code error;
  fs::copy_file(plan.request.rig, folder / run_files::kRig, error);
  if (error) return Error{fmt::format("{}: cannot be copied: {}", plan.request.rig.string(), error.message())};
  Status done = write_text(folder / kImportFile, json_of(plan.request, summary).dump(2) + "\n");
  if (done) done = plan.folder.commit();
  if (!done) return done.error();
  return summary;
}

}  // namespace lxd

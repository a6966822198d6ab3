// SPDX-License-Identifier: Apache-2.0
// `lxd-slam import`: bags of ROS 1 into a generic folder.
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/cli/commands.hpp"
#include "tools/cli/complain.hpp"
#include "tools/cli/exit_status.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/progress.hpp"
#include "tools/import/importer.hpp"

namespace lxd {
namespace {

struct ImportArguments {
  std::vector<std::string> bags, topics;
  std::string rig, out;
  bool list = false;
  bool quiet = false;
};

int list_topics(const std::vector<std::filesystem::path>& bags) {
  const auto reader = BagReader::open(bags);
  if (!reader) return complain("import", reader.error(), exit_status::kBadUsage);
  fmt::print("{:.3f} s, from {:.3f} s on\n", (reader->end() - reader->begin()).seconds(), reader->begin().seconds());
  for (const BagTopic& topic : reader->topics())
    fmt::print("{:>9}  {:<32} {}\n", topic.messages, topic.type, topic.name);
  return exit_status::kDone;
}

void print_topic(const ImportedTopic& topic) {
  const auto& [choice, counts] = topic;
  fmt::print("{}: {} of {} messages of {}\n", choice.sensor, counts.written, counts.messages, choice.topic);
  for (const auto& [cause, times] : counts.rejected) fmt::print("  {}: {}\n", cause, times);
  if (counts.unstamped > 0)
    fmt::print("  warning: {} have no stamp in their header, and are written at the bag's time\n", counts.unstamped);
  for (const auto& [remark, times] : counts.remarks) fmt::print("  warning: {} ({} messages)\n", remark, times);
}

void print_summary(const ImportSummary& summary, const std::string& out) {
  for (const ImportedTopic& topic : summary.topics) print_topic(topic);
  for (const std::string& remark : summary.remarks) fmt::print("note: {}\n", remark);
  fmt::print("{0}: {1:.1f} s\nnext: lxd-slam replay {0} --out run\n", out, summary.duration_s);
}

int run_import(const ImportArguments& arguments) {
  const std::vector<std::filesystem::path> bags(arguments.bags.begin(), arguments.bags.end());
  if (arguments.list) return list_topics(bags);
  if (arguments.rig.empty() || arguments.out.empty())
    return complain("import", Error{"wanted --rig RIG and --out FOLDER, or --list"}, exit_status::kBadUsage);
  auto plan = plan_import({bags, arguments.rig, arguments.out, arguments.topics});
  if (!plan) return complain("import", plan.error(), exit_status::kBadUsage);
  ProgressDisplay display(stderr);
  const bool loud = !arguments.quiet;
  const auto done = import_bags(
      std::move(*plan),
      [&](double part) {
        if (loud) display.show(fmt::format("import  {:.0f} %", 100 * part));
      },
      watch_for_interrupt());
  if (loud) display.finish();
  if (!done) return complain("import", done.error(), exit_status::kFailed);
  if (loud) print_summary(*done, arguments.out);
  return exit_status::kDone;
}

}  // namespace

void add_import_command(CLI::App& app, int& exit_status) {
  const auto arguments = std::make_shared<ImportArguments>();
  CLI::App* const command = app.add_subcommand("import", "Turn bags of ROS 1 into a folder that replay runs");
  command->add_option("bags", arguments->bags, "Bags of one recording")->type_name("BAG")->required();
  command->add_option("--rig", arguments->rig, "The rig file: its sensors are what is imported")->type_name("RIG");
  command->add_option("--out", arguments->out, "Folder of the recording; an earlier import in it is replaced")
      ->type_name("FOLDER");
  command
      ->add_option("--topic", arguments->topics,
                   "Which topic a sensor is, where several fit, e.g. lidar0=/os1_cloud_node/points; truth=/pose also "
                   "writes truth.tum; camera0= leaves it out; any number of times")
      ->type_name("SENSOR=TOPIC")
      ->expected(1)
      ->take_all();
  command->add_flag("--list", arguments->list, "What the bags hold, and nothing else");
  command->add_flag("--quiet", arguments->quiet, "No progress, no summary");
  command->callback([=, &exit_status] { exit_status = run_import(*arguments); });
}

}  // namespace lxd

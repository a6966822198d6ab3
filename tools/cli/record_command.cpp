// SPDX-License-Identifier: Apache-2.0
// `lxd-slam record`: a live rig's bytes into a recording.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "board/recorder.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/complain.hpp"
#include "tools/cli/exit_status.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/say.hpp"

namespace lxd {
namespace {

constexpr double kBytesPerMebibyte = 1024.0 * 1024.0;

struct RecordArguments {
  std::string rig, out;
  double duration_s = 0;
  bool quiet = false;
};

std::string line_of(const RecordProgress& progress) {
  std::string line =
      fmt::format("{:.1f} s  {} packets  written {:.1f} MiB  dropped {}", progress.elapsed_s, progress.chunks,
                  static_cast<double>(progress.written_bytes) / kBytesPerMebibyte, progress.dropped);
  if (!progress.silent.empty()) line += "  silent: " + progress.silent;
  return line;
}

void print_summary(const Recorder& recorder, const std::string& out) {
  for (const auto& stream : recorder.streams()) {
    const StreamCounts counts = stream->counts();
    fmt::print("{}: {}: {} packets, {:.1f} MiB written", out, name_of(stream->channel()), counts.chunks,
               static_cast<double>(stream->written_bytes()) / kBytesPerMebibyte);
    if (counts.no_room + counts.refused + counts.not_written > 0)
      fmt::print("; not in the file: {} for which there was no room, {} damaged, {} that could not be written",
                 counts.no_room, counts.refused, counts.not_written);
    fmt::print("\n");
  }
}

int run_record(const RecordArguments& arguments) {
  RecordRequest request{arguments.rig, arguments.out, {}};
  if (arguments.duration_s > 0) request.duration = Duration::from_seconds(arguments.duration_s);
  const std::atomic<bool>& stop = watch_for_interrupt();
  const auto recorder = Recorder::open(request);
  if (!recorder) return complain("record", recorder.error(), exit_status::kBadUsage);
  for (const std::string& remark : (*recorder)->remarks()) say("note: {}\n", remark);
  ProgressDisplay display(stderr);
  const Status done = (*recorder)->run(
      [&](const RecordProgress& progress) {
        for (const RigEvent& event : progress.events) say("note: {}: {}\n", event.source, event.what);
        if (!arguments.quiet) display.show(line_of(progress));
      },
      stop);
  if (!arguments.quiet) display.finish();
  if (!arguments.quiet) print_summary(**recorder, arguments.out);
  return done ? exit_status::kDone : complain("record", done.error(), exit_status::kFailed);
}

}  // namespace

void add_record_command(CLI::App& app, int& exit_status) {
  const auto arguments = std::make_shared<RecordArguments>();
  CLI::App* const command = app.add_subcommand("record", "Record a live rig, as its bytes come");
  command->add_option("--rig", arguments->rig, "The rig file, with ports and devices")
      ->type_name("RIG.yaml")
      ->required();
  command->add_option("--out", arguments->out, "Folder of the recording; new or empty")
      ->type_name("RECORDING")
      ->required();
  command->add_option("--duration", arguments->duration_s, "Seconds; otherwise until Ctrl-C")
      ->type_name("S")
      ->check(CLI::PositiveNumber);
  command->add_flag("--quiet", arguments->quiet, "Only what goes wrong");
  command->callback([=, &exit_status] { exit_status = run_record(*arguments); });
}

}  // namespace lxd

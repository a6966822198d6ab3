// SPDX-License-Identifier: Apache-2.0
// See unfinished_recording.hpp.
#include "drivers/replay/unfinished_recording.hpp"

#include <utility>

#include <fmt/format.h>

namespace lxd {
namespace {

class UnfinishedSource final : public SweepSource {
 public:
  UnfinishedSource(std::unique_ptr<SweepSource> source, std::string note)
      : source_(std::move(source)), notes_(source_->notes()) {
    notes_.insert(notes_.begin(), std::move(note));
    count();
  }

  Result<bool> next(Sweep& sweep) override {
    Result<bool> found = source_->next(sweep);
    count();
    return found;
  }

  [[nodiscard]] std::optional<std::uint64_t> size() const override { return source_->size(); }
  [[nodiscard]] std::string kind() const override { return source_->kind(); }
  [[nodiscard]] LidarTraits traits() const override { return source_->traits(); }
  [[nodiscard]] const std::map<std::string, std::uint64_t>& rejected() const override { return rejected_; }
  [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }

 private:
  void count() {
    rejected_ = source_->rejected();
    rejected_["unfinished_recording"] = 1;
  }

  std::unique_ptr<SweepSource> source_;
  std::vector<std::string> notes_;
  std::map<std::string, std::uint64_t> rejected_;
};

}  // namespace

bool is_unfinished(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::exists(folder / kUnfinishedMark, ignored);
}

std::unique_ptr<SweepSource> mark_unfinished(std::unique_ptr<SweepSource> source, const std::filesystem::path& folder) {
  std::string note = fmt::format(
      "{}: the recording was not finished: its writer is still at work or was cut off ({} is in the folder); "
      "what is missing at its end is not known",
      folder.string(), kUnfinishedMark);
  return std::make_unique<UnfinishedSource>(std::move(source), std::move(note));
}

}  // namespace lxd

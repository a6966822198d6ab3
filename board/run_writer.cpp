// SPDX-License-Identifier: Apache-2.0
#include "board/run_writer.hpp"

#include <utility>

namespace lxd {

RunWriter::RunWriter(const Configuration& configuration, const Star& star, BackEndPace pace)
    : pace_(pace), keeper_(configuration, star, pace), tracking_(configuration.sensors) {}

Status RunWriter::remember(const EarlierMapRequest& request, const std::filesystem::path& out) {
  auto earlier = open_earlier_map(request, out);
  if (!earlier) return earlier.error();
  earlier_ = std::move(*earlier);
  return earlier_ ? keeper_.remember(*earlier_) : success();
}

Status RunWriter::create(const std::filesystem::path& out, const Configuration& configuration, const Star& star,
                         MeshExtraction& extraction) {
  auto output = RunOutput::create(out, configuration, star, extraction, earlier_, pace_);
  if (!output) return output.error();
  output_.emplace(std::move(*output));
  return success();
}

Status RunWriter::take(const SweepOutcome& outcome, const FilterView& view) {
  tracking_.note(outcome, report_);
  keeper_.take(outcome, view);
  return output_->publish(outcome, view.sub_mesh_begin);
}

Status RunWriter::store_window(const SurfaceMap& map) {
  Status first = success();
  for (std::uint32_t i = 0; i < map.window_size(); ++i) keep_first(first, store(map.window(i)));
  return first;
}

Status RunWriter::store_last_window(const SurfaceMap& map) {
  output_->at_leisure();
  return store_window(map);
}

void RunWriter::begin_again() {
  output_->begin_again();
  keeper_.begin_again();
  tracking_.begin_again();
}

Status RunWriter::finish_map() {
  keeper_.finish();
  return output_->finish_map(keeper_.corrections());
}

Status RunWriter::write_report() {
  keeper_.write(report_);
  output_->write(report_);
  add_surprise(report_);
  return output_->write_report(report_);
}

}  // namespace lxd

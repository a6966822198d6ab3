// SPDX-License-Identifier: Apache-2.0
#include "board/graph_worker.hpp"

#include "board/default/threads.hpp"
#include "rt/stopwatch.hpp"

namespace lxd {

GraphWorker::GraphWorker(const GraphConfig& config, bool own_thread) : graph_(config) {
  if (own_thread) thread_.emplace(threads::kBackEnd);
}

void GraphWorker::post(const News& news) {
  if (!thread_) return work_on(news);
  thread_->post([this, news] { work_on(news); });
}

// What was measured at a key frame comes after it: it is complete when the next one comes.
void GraphWorker::work_on(const News& news) {
  if (std::holds_alternative<KeyFrame>(news) && graph_.size() > 0) solve();
  std::visit([this](const auto& what) { add(what); }, news);
}

void GraphWorker::solve() {
  const Stopwatch stopwatch;
  graph_.update();
  latency_.add(stopwatch.elapsed());
  const Whereabouts now{graph_.T_map_world(), !graph_.places().empty()};
  const std::lock_guard lock(mutex_);
  whereabouts_ = now;
}

const PoseGraph& GraphWorker::finish() {
  if (finished_) return graph_;
  if (thread_) thread_->wait_until_left(0);
  thread_.reset();
  graph_.finish();
  finished_ = true;
  return graph_;
}

GraphWorker::Whereabouts GraphWorker::whereabouts() const {
  const std::lock_guard lock(mutex_);
  return whereabouts_;
}

}  // namespace lxd

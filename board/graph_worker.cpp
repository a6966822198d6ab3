// SPDX-License-Identifier: Apache-2.0
#include "board/graph_worker.hpp"

#include <sys/resource.h>

#include "rt/stopwatch.hpp"

namespace lxd {
namespace {

constexpr int kNiceness = 10;  // of 19: whatever has a deadline goes first

}  // namespace

GraphWorker::GraphWorker(const GraphConfig& config, bool own_thread) : graph_(config) {
  if (own_thread) thread_ = std::thread([this] { run(); });
}

GraphWorker::~GraphWorker() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    queue_.clear();
    ending_ = true;
  }
  came_.notify_one();
  thread_.join();
}

void GraphWorker::post(const News& news) {
  if (!thread_.joinable()) return work_on(news);
  {
    const std::lock_guard lock(mutex_);
    queue_.push_back(news);
  }
  came_.notify_one();
}

void GraphWorker::run() {
  setpriority(PRIO_PROCESS, 0, kNiceness);  // Linux: of this thread alone. Refused, it stays as it was
  std::unique_lock lock(mutex_);
  while (true) {
    came_.wait(lock, [this] { return ending_ || !queue_.empty(); });
    if (queue_.empty()) return;
    const News news = queue_.front();
    queue_.pop_front();
    lock.unlock();
    work_on(news);
    lock.lock();
  }
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
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    came_.notify_one();
    thread_.join();
  }
  graph_.finish();
  finished_ = true;
  return graph_;
}

GraphWorker::Whereabouts GraphWorker::whereabouts() const {
  const std::lock_guard lock(mutex_);
  return whereabouts_;
}

}  // namespace lxd

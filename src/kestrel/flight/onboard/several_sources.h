// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/flight/session/live_source.h"

namespace kestrel {

// Several cameras as one source. Each has a thread of its own, so that one that hangs does not keep
// the others waiting. Frames have the index of their camera.
class SeveralSources : public LiveSource {
 public:
  struct Camera {
    std::string name;  // for messages
    std::unique_ptr<LiveSource> source;
  };

  explicit SeveralSources(std::vector<Camera> cameras);
  ~SeveralSources() override;
  SeveralSources(const SeveralSources&) = delete;
  SeveralSources& operator=(const SeveralSources&) = delete;

  // EndOfStream when all have ended.
  std::optional<Event> Next(Duration timeout) override;
  // Those of all cameras, with their names.
  std::string error() const override;
  // The sums of all cameras'.
  CaptureCounters counters() const override;

 private:
  void Read(std::size_t camera);

  std::vector<Camera> cameras_;
  std::vector<std::atomic<bool>> have_ended_;
  BoundedQueue<Event> events_;
  std::atomic<bool> is_over_{false};
  std::vector<std::thread> threads_;
};

}  // namespace kestrel

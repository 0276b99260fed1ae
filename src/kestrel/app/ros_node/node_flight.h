// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "kestrel/app/ros_node/node_task.h"
#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/base/thread_setup.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/onboard/latency_statistics.h"
#include "kestrel/flight/session/live_events.h"

namespace kestrel {

// Runs the node's task in a thread of its own, from the first image to a reset.
class NodeFlight {
 public:
  // Parameters and errors as in MakeNodeTask.
  NodeFlight(const CameraCalibration& calibration, const std::optional<HuntedObjects>& objects,
             const NodeOptions& options, const NodeFrames& frames, NodeConnection* connection);
  ~NodeFlight();

  // Neither function waits. 'arrival': time of the arrival, by Now(); the latency counts from it.
  void Push(Frame frame, Time arrival);
  void Push(const PoseSample& pose) { events_.Push(pose); }

  const CameraIntrinsics& intrinsics() const { return intrinsics_; }

  // Calls 'action' with the task between two frames.
  template <class Action>
  auto WithTask(const Action& action) {
    const std::lock_guard lock(task_mutex_);
    return action(task_.get());
  }

  struct Counters {
    LiveEvents::Counters events;
    std::uint64_t found = 0;       // images with a detection
    LatencySummary latency;        // from an image's arrival to the publication of its detections
    LatencySummary beyond_detect;  // the same without the time of Detect
    LatencySummary detect;
  };
  Counters counters() const;

 private:
  struct Arrival {
    Time stamp;
    Time arrival;
  };

  void Run();
  void Process(const Frame& frame);
  void CountLatency(Time stamp, Duration detect_time);

  ThreadOptions thread_options_;
  NodeConnection* connection_;
  CameraIntrinsics intrinsics_;
  std::mutex task_mutex_;
  std::unique_ptr<NodeTask> task_;
  LiveEvents events_;
  BoundedQueue<Arrival> arrivals_;
  std::atomic<std::uint64_t> found_ = 0;
  LatencyHistogram latency_, beyond_detect_, detect_;
  std::thread thread_;
};

}  // namespace kestrel

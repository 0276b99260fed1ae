// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/ros_node/node_flight.h"

#include <string>
#include <utility>
#include <variant>

#include "kestrel/core/base/thread_setup.h"

namespace kestrel {
namespace {

constexpr std::size_t kWaitingArrivals = 16;  // more than the frames that can wait

// Without poses a frame has nothing to wait for.
LiveEventsOptions EventsOf(const NodeOptions& options) {
  LiveEventsOptions events = options.kestrel.fly.flight.events;
  if (options.poses == "none") events.pose_wait_s = 0;
  return events;
}

}  // namespace

NodeFlight::NodeFlight(const CameraCalibration& calibration,
                       const std::optional<HuntedObjects>& objects, const NodeOptions& options,
                       const NodeFrames& frames, NodeConnection* connection)
    : thread_options_(options.kestrel.fly.flight.vision_thread),
      connection_(connection),
      intrinsics_(calibration.intrinsics),
      task_(MakeNodeTask(calibration, objects, options, frames, connection)),
      events_(EventsOf(options), task_->pose_lead()),
      arrivals_(kWaitingArrivals),
      thread_([this] { Run(); }) {}

NodeFlight::~NodeFlight() {
  events_.Close();
  thread_.join();
}

void NodeFlight::Push(Frame frame, Time arrival) {
  arrivals_.Push({frame.time, arrival});
  events_.Push(std::move(frame));
}

NodeFlight::Counters NodeFlight::counters() const {
  return {events_.counters(), found_, latency_.Summary(), beyond_detect_.Summary(),
          detect_.Summary()};
}

void NodeFlight::Run() {
  const std::string refused = SetUpThisThread("vision", thread_options_);
  if (!refused.empty()) connection_->Warn(refused);
  for (;;) {
    const Event event = events_.Next();
    if (std::holds_alternative<EndOfStream>(event)) return;
    const std::lock_guard lock(task_mutex_);
    if (const auto* pose = std::get_if<PoseSample>(&event)) task_->AddPose(*pose);
    if (const auto* frame = std::get_if<Frame>(&event)) Process(*frame);
  }
}

void NodeFlight::Process(const Frame& frame) {
  const NodeTask::Found found = task_->PublishDetections(frame);
  found_ += found.something;
  CountLatency(frame.time, found.detect_time);
  task_->PublishRest(frame);
}

void NodeFlight::CountLatency(Time stamp, Duration detect_time) {
  const Time now = Now();
  while (const auto arrival = arrivals_.TryPop()) {
    if (arrival->stamp != stamp) continue;  // arrival of a dropped frame
    latency_.Add(now - arrival->arrival);
    beyond_detect_.Add(now - arrival->arrival - detect_time);
    detect_.Add(detect_time);
    return;
  }
}

}  // namespace kestrel

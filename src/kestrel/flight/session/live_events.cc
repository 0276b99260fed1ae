// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/live_events.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kestrel/core/base/options.h"
#include "kestrel/core/base/violations.h"

namespace kestrel {
namespace {

constexpr std::size_t kWaitingPoses = 256;  // several seconds of poses of any autopilot
constexpr double kDelayMemory_s = 5;        // a large delay of a pose counts for so long
constexpr double kLongestDelay_s = 0.3;     // a pose that is later is of no use

Duration PoseWaitOf(const LiveEventsOptions& options) {
  RequireValid(options);
  return DurationFromSeconds(options.pose_wait_s);
}

}  // namespace

std::vector<std::string> LiveEventsOptions::Validate() const {
  std::vector<std::string> violations;
  RequireIn(pose_wait_s, 0, 1, "pose_wait_s", &violations);
  return violations;
}

LiveEvents::LiveEvents(const LiveEventsOptions& options, Duration lead)
    : pose_wait_(PoseWaitOf(options)), lead_(lead), poses_(kWaitingPoses) {}

void LiveEvents::Push(Frame frame) {
  std::optional<WaitingFrame> arrived(WaitingFrame{std::move(frame), Time()});
  {
    const std::lock_guard lock(mutex_);
    arrived->deadline = DeadlineOf(arrived->frame, Now());
    // The frame that waits for its pose stays. If every newer frame replaced it, and poses took
    // longer than the time between frames, no frame would ever get through.
    std::swap(waiting_ ? newest_ : waiting_, arrived);
    if (arrived) ++counters_.dropped_frames;
  }
  changed_.notify_one();
}

Time LiveEvents::DeadlineOf(const Frame& frame, Time now) const {
  if (pose_wait_ == Duration::zero()) return now;
  const Time pose_due = frame.time + lead_ + DurationFromSeconds(pose_delay_s_);
  return std::max(now, pose_due) + pose_wait_;
}

void LiveEvents::LearnDelay(const PoseSample& pose, Time now) {
  const double seconds = std::max(ToSeconds(now - delay_learnt_), 0.0);
  const double delay_s = std::clamp(ToSeconds(now - pose.time), 0.0, kLongestDelay_s);
  pose_delay_s_ = std::max(delay_s, pose_delay_s_ * std::exp(-seconds / kDelayMemory_s));
  delay_learnt_ = now;
}

void LiveEvents::Push(const PoseSample& pose) {
  {
    const std::lock_guard lock(mutex_);
    LearnDelay(pose, Now());
    if (pose_count_ == poses_.size()) {
      first_pose_ = (first_pose_ + 1) % poses_.size();
      --pose_count_;
      ++counters_.dropped_poses;
    }
    poses_[(first_pose_ + pose_count_++) % poses_.size()] = pose;
  }
  changed_.notify_one();
}

void LiveEvents::Close() {
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
  }
  changed_.notify_all();
}

bool LiveEvents::HasPoseAfter(const Frame& frame) const {
  return newest_pose_ && *newest_pose_ >= frame.time + lead_;
}

bool LiveEvents::IsReady(const std::optional<WaitingFrame>& frame, Time now) const {
  return frame && (now >= frame->deadline || HasPoseAfter(frame->frame));
}

Event LiveEvents::TakePose() {
  const PoseSample pose = poses_[first_pose_];
  first_pose_ = (first_pose_ + 1) % poses_.size();
  --pose_count_;
  newest_pose_ = pose.time;
  return pose;
}

Event LiveEvents::TakeFrame() {
  ++counters_.frames;
  if (!HasPoseAfter(waiting_->frame)) ++counters_.unposed_frames;
  Event event = std::move(waiting_->frame);
  waiting_ = std::exchange(newest_, std::nullopt);
  return event;
}

Event LiveEvents::Next() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (is_closed_) return EndOfStream{};
    if (pose_count_ > 0) return TakePose();
    if (!waiting_) {
      changed_.wait(lock);
      continue;
    }
    const Time now = Now();
    if (IsReady(newest_, now)) {
      waiting_ = std::exchange(newest_, std::nullopt);
      ++counters_.dropped_frames;
    }
    if (IsReady(waiting_, now)) return TakeFrame();
    changed_.wait_for(lock, waiting_->deadline - now);
  }
}

LiveEvents::Counters LiveEvents::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/live_events.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

constexpr std::size_t kWaitingSamples = 256;  // several seconds of poses of any autopilot
constexpr std::size_t kWaitingFrames =
    10;                                  // for each camera: 30 per second, poses as late as below
constexpr double kDelayMemory_s = 5;     // a large delay of a pose counts for so long
constexpr double kLongestDelay_s = 0.3;  // a pose that is later is of no use

Duration PoseWaitOf(const LiveEventsOptions& options) {
  RequireValid(options);
  return DurationFromSeconds(options.pose_wait_s);
}

}  // namespace

LiveEvents::LiveEvents(const LiveEventsOptions& options, Duration lead, std::size_t cameras)
    : pose_wait_(PoseWaitOf(options)),
      lead_(lead),
      samples_(kWaitingSamples),
      most_frames_(cameras * kWaitingFrames) {
  frames_.reserve(most_frames_);
}

void LiveEvents::Push(Frame frame) {
  WaitingFrame arrived{.frame = std::move(frame), .deadline = {}};
  {
    const std::lock_guard lock(mutex_);
    arrived.deadline = DeadlineOf(arrived.frame, Now());
    TakePoseInto(&arrived);
    // Those that have waited longer stay. If newer ones replaced them, and poses took longer than
    // so many frames, none would ever get through.
    if (frames_.size() < most_frames_) {
      frames_.push_back(std::move(arrived));
    } else {
      std::swap(frames_.back(), arrived);
      ++counters_.dropped_frames;
    }
  }
  changed_.notify_one();
}

Time LiveEvents::DeadlineOf(const Frame& frame, Time now) const {
  if (pose_wait_ == Duration::zero() || !awaits_poses_) return now;
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
    Queue(pose);
    newest_pose_ = pose.time;
    for (WaitingFrame& waiting : frames_) TakePoseInto(&waiting);
  }
  changed_.notify_one();
}

void LiveEvents::Push(const GimbalSample& report) {
  {
    const std::lock_guard lock(mutex_);
    Queue(report);
  }
  changed_.notify_one();
}

void LiveEvents::Push(const ZoomSample& report) {
  {
    const std::lock_guard lock(mutex_);
    Queue(report);
  }
  changed_.notify_one();
}

void LiveEvents::Queue(const Event& sample) {
  if (sample_count_ == samples_.size()) {
    first_sample_ = (first_sample_ + 1) % samples_.size();
    --sample_count_;
    ++counters_.dropped_poses;
  }
  samples_[(first_sample_ + sample_count_++) % samples_.size()] = sample;
}

void LiveEvents::AwaitPoses(bool are_awaited) {
  {
    const std::lock_guard lock(mutex_);
    awaits_poses_ = are_awaited;
    if (!are_awaited) {
      for (WaitingFrame& waiting : frames_) waiting.deadline = {};
    }
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

void LiveEvents::TakePoseInto(WaitingFrame* waiting) const {
  if (waiting->has_pose || !newest_pose_ || *newest_pose_ < waiting->frame.time + lead_) return;
  waiting->has_pose = true;
  waiting->is_missed = is_reader_busy_;
}

bool LiveEvents::IsReady(const WaitingFrame& waiting, Time now) {
  return waiting.has_pose || waiting.deadline <= now;
}

// True when the next frame of the same camera can go.
bool LiveEvents::IsReplaced(const WaitingFrame& waiting, Time now) const {
  const auto next = std::find_if(frames_.begin(), frames_.end(), [&](const WaitingFrame& other) {
    return &other > &waiting && other.frame.camera == waiting.frame.camera;
  });
  return next != frames_.end() && IsReady(*next, now);
}

// Drops frames that the reader has missed, up to the newest that can go. Those whose poses came
// together while it waited stay.
void LiveEvents::DropMissed(Time now) {
  while (!frames_.empty() && (frames_[0].is_missed || !frames_[0].has_pose) &&
         IsReplaced(frames_[0], now)) {
    frames_.erase(frames_.begin());
    ++counters_.dropped_frames;
  }
}

Event LiveEvents::TakeSample() {
  Event sample = samples_[first_sample_];
  first_sample_ = (first_sample_ + 1) % samples_.size();
  --sample_count_;
  return sample;
}

Event LiveEvents::TakeFrame() {
  ++counters_.frames;
  if (awaits_poses_ && !frames_.front().has_pose) ++counters_.unposed_frames;
  Event event = std::move(frames_.front().frame);
  frames_.erase(frames_.begin());
  is_reader_busy_ = true;
  return event;
}

Event LiveEvents::Next() {
  std::unique_lock lock(mutex_);
  is_reader_busy_ = false;
  for (;;) {
    if (is_closed_) return EndOfStream{};
    if (sample_count_ > 0) return TakeSample();
    if (frames_.empty()) {
      changed_.wait(lock);
      continue;
    }
    const Time now = Now();
    DropMissed(now);
    if (IsReady(frames_.front(), now)) return TakeFrame();
    changed_.wait_for(lock, frames_.front().deadline - now);
  }
}

LiveEvents::Counters LiveEvents::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace kestrel

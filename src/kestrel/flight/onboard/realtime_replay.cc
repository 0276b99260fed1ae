// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/realtime_replay.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// Poses from before the first frame that are played, as a history has them when a flight begins.
constexpr Duration kPosesAhead = std::chrono::milliseconds(200);

}  // namespace

RealtimeReplay::RealtimeReplay(Open open, Duration clock_offset, bool is_looped,
                               std::vector<Duration> further_offsets)
    : open_(std::move(open)),
      clock_offset_(clock_offset),
      further_offsets_(std::move(further_offsets)),
      is_looped_(is_looped) {
  Begin();
  if (!frame_) throw InputError("the recording has no frames");
}

Time RealtimeReplay::OnFirstClock(const Frame& frame) const {
  if (frame.camera == 0) return frame.time;
  return frame.time + further_offsets_[frame.camera - 1] - clock_offset_;
}

void RealtimeReplay::Begin() {
  source_ = open_();
  poses_ = source_->poses();
  gimbal_ = source_->gimbal();
  next_gimbal_ = 0;
  zoom_ = source_->zoom();
  next_zoom_ = 0;
  if (!ReadFrame()) return;
  const auto is_early = [this](const PoseSample& pose) {
    return pose.time - clock_offset_ < OnFirstClock(*frame_) - kPosesAhead;
  };
  const auto first = std::find_if_not(poses_.begin(), poses_.end(), is_early);
  next_pose_ = static_cast<std::size_t>(first - poses_.begin());
}

bool RealtimeReplay::ReadFrame() {
  Frame frame;
  frame_.reset();
  const std::size_t left_out = source_->left_out();
  if (source_->Next(&frame)) frame_ = std::move(frame);
  const std::lock_guard lock(mutex_);
  counters_.refused += source_->left_out() - left_out;
  counters_.missed = counters_.refused;
  return frame_.has_value();
}

std::optional<Event> RealtimeReplay::Next(Duration timeout) {
  constexpr Duration kMaxLate = std::chrono::milliseconds(250);
  if (!has_ended_ && IsRoundOver()) EndOnFault([this] { BeginAgainOrEnd(); });
  if (has_ended_) return EndOfStream{};
  const Time now = Now();
  if (!std::exchange(is_started_, true)) shift_ = now + kPosesAhead - OnFirstClock(*frame_);
  const Time due = IsPoseNext() ? DueOf(poses_[next_pose_]) : DueOf(*frame_);
  const Time first = std::min(due, now);
  if (IsReportNext(gimbal_, next_gimbal_, first)) return TakeReport(gimbal_, &next_gimbal_);
  if (IsReportNext(zoom_, next_zoom_, first)) return TakeReport(zoom_, &next_zoom_);
  if (due > now + timeout) {
    std::this_thread::sleep_for(timeout);
    return std::nullopt;
  }
  if (due > now) std::this_thread::sleep_for(due - now);
  if (now - due > kMaxLate) shift_ += now - due;
  if (IsPoseNext()) return TakePose();
  return TakeFrame();
}

// The last frame of a round is followed by the pose after it, for which it waits, if the recording
// has one soon.
bool RealtimeReplay::IsPoseNext() const {
  if (next_pose_ == poses_.size()) return false;
  const Time due = DueOf(poses_[next_pose_]);
  if (frame_) return due <= DueOf(*frame_);
  const bool has_pose_after = last_pose_ && *last_pose_ >= *last_frame_ + clock_offset_;
  return !has_pose_after && due <= *last_frame_ + DurationFromSeconds(1 / source_->rate_hz());
}

template <class Report>
bool RealtimeReplay::IsReportNext(const std::vector<Report>& reports, std::size_t next,
                                  Time due) const {
  return next < reports.size() && DueOf(reports[next]) <= due;
}

template <class Report>
Event RealtimeReplay::TakeReport(const std::vector<Report>& reports, std::size_t* next) const {
  Report report = reports[(*next)++];
  report.time += shift_;
  return report;
}

// In a further round the first poses may be earlier than the last one of the round before.
std::optional<Event> RealtimeReplay::TakePose() {
  PoseSample pose = poses_[next_pose_++];
  pose.time += shift_;
  if (last_pose_ && pose.time <= *last_pose_) return std::nullopt;
  last_pose_ = pose.time;
  return pose;
}

Event RealtimeReplay::TakeFrame() {
  Frame frame = *std::exchange(frame_, std::nullopt);
  last_frame_ = DueOf(frame);
  frame.time += shift_;
  {
    const std::lock_guard lock(mutex_);
    ++counters_.captured;
  }
  EndOnFault([this] { ReadFrame(); });
  return frame;
}

template <class Step>
void RealtimeReplay::EndOnFault(const Step& step) {
  try {
    step();
  } catch (const InputError& fault) {
    has_ended_ = true;
    const std::lock_guard lock(mutex_);
    error_ = fault.what();
  }
}

void RealtimeReplay::BeginAgainOrEnd() {
  has_ended_ = !is_looped_;
  if (has_ended_) return;
  const Duration period = DurationFromSeconds(1 / source_->rate_hz());
  Begin();
  shift_ = *last_frame_ + period - OnFirstClock(*frame_);
}

std::string RealtimeReplay::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

CaptureCounters RealtimeReplay::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace kestrel

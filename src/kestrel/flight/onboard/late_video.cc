// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/late_video.h"

#include <chrono>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr Duration kUpdatePeriod = std::chrono::seconds(1);
constexpr Duration kLongestStep = std::chrono::milliseconds(300);  // between two images
constexpr Duration kSettling = std::chrono::seconds(2);            // of the times of a new stream
constexpr Duration kNewestImages = std::chrono::seconds(8);        // show a change of the delay
constexpr double kClearly = 4;  // standard deviations by which a change is no noise
constexpr double kNoticeable_s = 0.04;
constexpr int kUpdatesToChange = 4;  // in a row: a stream that has not broken keeps its delay
constexpr double kMilli = 1e3;
constexpr std::size_t kAttitudes = 1000;  // that come between two images

// Few turns may show another offset by chance: only a sure one counts against 'known'.
bool Contradicts(const ClockEstimate& estimate, const ClockEstimate& known) {
  constexpr double kSure_s = 0.008;
  const double difference_s = std::abs(estimate.offset_s - known.offset_s);
  return estimate.sigma_s < kSure_s && difference_s > kNoticeable_s &&
         difference_s > kClearly * std::hypot(estimate.sigma_s, known.sigma_s);
}

}  // namespace

LateVideo::LateVideo(std::unique_ptr<LiveSource> video, const CameraCalibration& calibration,
                     bool corrects)
    : video_(std::move(video)),
      given_offset_(calibration.clock_offset),
      corrects_(corrects),
      image_turn_(calibration.intrinsics),
      delay_(calibration) {
  if (corrects_) words_ = "the delay of the video is not known yet: turn or tilt the UAV";
}

std::optional<Event> LateVideo::Next(Duration timeout) {
  std::optional<Event> event = video_->Next(timeout);
  Frame* frame = event ? std::get_if<Frame>(&*event) : nullptr;
  if (frame == nullptr) return event;
  WatchForBreak();
  TakeAttitudes();
  Measure(*frame);
  if (corrects_) frame->time += correction_;
  if (frame->time <= last_time_) {
    const std::lock_guard lock(mutex_);
    ++left_out_;
    return std::nullopt;
  }
  last_time_ = frame->time;
  return event;
}

CaptureCounters LateVideo::counters() const {
  CaptureCounters counters = video_->counters();
  const std::lock_guard lock(mutex_);
  counters.captured -= left_out_;
  counters.missed += left_out_;
  return counters;
}

void LateVideo::Add(const PoseSample& pose) {
  const std::lock_guard lock(mutex_);
  if (poses_.size() < kAttitudes) poses_.push_back(pose);
}

void LateVideo::Add(const GimbalSample& report) {
  const std::lock_guard lock(mutex_);
  if (reports_.size() < kAttitudes) reports_.push_back(report);
}

std::string LateVideo::InWords() const {
  const std::lock_guard lock(mutex_);
  return words_;
}

std::optional<ClockEstimate> LateVideo::offset() const {
  const std::lock_guard lock(mutex_);
  return offset_;
}

void LateVideo::TakeAttitudes() {
  const std::lock_guard lock(mutex_);
  for (const PoseSample& pose : poses_) delay_.Add(pose);
  for (const GimbalSample& report : reports_) delay_.Add(report);
  poses_.clear();
  reports_.clear();
}

void LateVideo::Measure(const Frame& frame) {
  if (!before_ || frame.time - *before_ > kLongestStep) image_turn_.Restart();
  const auto turn = image_turn_.Add(frame.image);
  if (!settled_) settled_ = frame.time + kSettling;
  if (turn && *before_ > *settled_) delay_.Add(*before_, frame.time, *turn);
  before_ = frame.time;
  const Time now = Now();
  if (now < update_due_) return;
  update_due_ = now + kUpdatePeriod;
  Update(frame.time);
}

void LateVideo::WatchForBreak() {
  const std::uint64_t breaks = video_->counters().reopened;
  if (std::exchange(breaks_, breaks) == breaks) return;
  delay_.ForgetBefore(Time::max());
  before_.reset();
  settled_.reset();
  may_have_changed_ = true;
  if (const auto known = offset()) {
    Set(known, "the video has come back: its delay is measured again, turn or tilt the UAV");
  }
}

void LateVideo::Update(Time now) {
  const auto known = offset();
  const auto newest = delay_.Estimate(now - kNewestImages);
  const bool contradicts = known && newest && Contradicts(*newest, *known);
  contradictions_ = contradicts ? contradictions_ + 1 : 0;
  const bool has_changed = contradictions_ >= kUpdatesToChange;
  if (has_changed) delay_.ForgetBefore(now - kNewestImages);
  const auto estimate = delay_.Estimate();
  if (!estimate) return;
  const bool is_news = !known || may_have_changed_ || has_changed;
  const bool is_another = known && Contradicts(*estimate, *known);
  if (!is_news && (is_another || estimate->sigma_s >= known->sigma_s)) return;
  may_have_changed_ = false;
  contradictions_ = 0;
  correction_ = DurationFromSeconds(estimate->offset_s) - given_offset_.value_or(Duration::zero());
  Set(estimate, is_news ? WordsOf(*estimate) : InWords());
}

void LateVideo::Set(const std::optional<ClockEstimate>& estimate, const std::string& words) {
  known_delay_ = DurationFromSeconds(estimate ? std::max(-estimate->offset_s, 0.0) : 0.0);
  const std::lock_guard lock(mutex_);
  offset_ = estimate;
  words_ = words;
}

std::string LateVideo::WordsOf(const ClockEstimate& estimate) const {
  const std::string measured = fmt::format("the video is {:.0f} ms late, +- {:.0f} ms",
                                           -kMilli * estimate.offset_s, kMilli * estimate.sigma_s);
  if (corrects_ || !given_offset_) return measured;
  const ClockEstimate given{ToSeconds(*given_offset_), 0};
  if (!Contradicts(estimate, given)) return measured;
  return fmt::format(
      "{}, not {:.0f} ms as by the time offset in the camera's file: correct that, or set "
      "fly.camera.measures_delay=true",
      measured, -kMilli * given.offset_s);
}

}  // namespace kestrel

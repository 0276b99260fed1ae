// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/calibration/mount/video_delay.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/vision/pipeline/image_turn.h"

namespace kestrel {

// A camera whose images come late by a time that nobody reports: it is measured in flight by how
// the images turn, see VideoDelay, and the frames get the times at which they were taken. When the
// stream comes back after a break the delay may be another one and is measured again; the old one
// is used until then.
class LateVideo : public LiveSource {
 public:
  // 'calibration': has a mount. 'corrects': the times of the frames are corrected, so that the
  // clock offset of the calibration, or 0, is theirs; else the delay is only compared with that.
  LateVideo(std::unique_ptr<LiveSource> video, const CameraCalibration& calibration, bool corrects);

  // A corrected time is never earlier than the one before: such a frame is left out.
  std::optional<Event> Next(Duration timeout) override;
  std::string error() const override { return video_->error(); }
  CaptureCounters counters() const override;

  // Take a pose and a report of the gimbal, on the clock of Now(). Called by any thread.
  void Add(const PoseSample& pose);
  void Add(const GimbalSample& report);

  // Returns in a line for the user what is known about the delay; it changes in flight. Called by
  // any thread.
  std::string InWords() const;
  // The clock offset of the images as they come; nothing as long as it is not known. By any thread.
  std::optional<ClockEstimate> offset() const;
  // Returns by how much the images come late; 0 as long as it is not known. By any thread.
  Duration known_delay() const { return known_delay_; }

 private:
  void TakeAttitudes();
  void Measure(const Frame& frame);
  void WatchForBreak();
  void Update(Time now);
  void Set(const std::optional<ClockEstimate>& estimate, const std::string& words);
  std::string WordsOf(const ClockEstimate& estimate) const;

  std::unique_ptr<LiveSource> video_;
  std::optional<Duration> given_offset_;
  bool corrects_;

  // Used by the thread that calls Next.
  ImageTurn image_turn_;
  VideoDelay delay_;
  std::optional<Time> before_;   // stamp of the last image
  std::optional<Time> settled_;  // the stamps of the images from here on are good
  Time update_due_;
  std::uint64_t breaks_ = 0;
  bool may_have_changed_ = false;  // since the estimate
  int contradictions_ = 0;         // updates in a row whose newest images show another delay
  Duration correction_{};
  Time last_time_ = Time::min();

  std::atomic<Duration> known_delay_{Duration::zero()};

  mutable std::mutex mutex_;  // guards what follows
  std::vector<PoseSample> poses_;
  std::vector<GimbalSample> reports_;
  std::optional<ClockEstimate> offset_;
  std::string words_;
  std::uint64_t left_out_ = 0;
};

}  // namespace kestrel

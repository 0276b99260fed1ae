// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/flight/session/live_source.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// Replays a recording at the pace at which it was flown: frames and poses come when they are due,
// with their times moved to the clock of Now(). If it cannot be read fast enough, it is played
// slower, in jerks.
class RealtimeReplay : public LiveSource {
 public:
  using Open = std::function<std::unique_ptr<FrameSource>()>;

  // 'open' opens the recording at its beginning, once for each round. 'clock_offset': of its
  // calibration, t_nav = t_image + clock_offset: a pose comes with the frames of its instant.
  // 'is_looped': it begins again at once after the last frame, so that positions jump; otherwise it
  // ends. 'further_offsets': of the cameras after the first one. Throws InputError when 'open'
  // does, or when the recording has no frame.
  RealtimeReplay(Open open, Duration clock_offset, bool is_looped,
                 std::vector<Duration> further_offsets = {});

  std::optional<Event> Next(Duration timeout) override;
  std::string error() const override;
  CaptureCounters counters() const override;

 private:
  void Begin();
  bool ReadFrame();
  // Its time on the clock of the first camera's images.
  Time OnFirstClock(const Frame& frame) const;
  Time DueOf(const Frame& frame) const { return OnFirstClock(frame) + shift_; }
  Time DueOf(const PoseSample& pose) const { return pose.time - clock_offset_ + shift_; }
  Time DueOf(const GimbalSample& report) const { return report.time - clock_offset_ + shift_; }
  Time DueOf(const ZoomSample& report) const { return report.time - clock_offset_ + shift_; }
  bool IsPoseNext() const;
  template <class Report>
  bool IsReportNext(const std::vector<Report>& reports, std::size_t next, Time due) const;
  bool IsRoundOver() const { return !frame_ && !IsPoseNext(); }
  std::optional<Event> TakePose();
  template <class Report>
  Event TakeReport(const std::vector<Report>& reports, std::size_t* next) const;
  Event TakeFrame();
  void BeginAgainOrEnd();
  template <class Step>
  void EndOnFault(const Step& step);

  Open open_;
  Duration clock_offset_;
  std::vector<Duration> further_offsets_;
  bool is_looped_;
  std::unique_ptr<FrameSource> source_;
  std::vector<PoseSample> poses_;
  std::size_t next_pose_ = 0;
  std::vector<GimbalSample> gimbal_;
  std::size_t next_gimbal_ = 0;
  std::vector<ZoomSample> zoom_;
  std::size_t next_zoom_ = 0;
  std::optional<Frame> frame_;      // the next one; nothing after the last
  std::optional<Time> last_frame_;  // times last given out, of a frame and of a pose
  std::optional<Time> last_pose_;
  Duration shift_{};  // Now() minus the recording's time
  bool is_started_ = false;
  bool has_ended_ = false;

  mutable std::mutex mutex_;  // guards what follows
  CaptureCounters counters_;
  std::string error_;
};

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/io/recording/event_source.h"

namespace kestrel {

struct LiveEventsOptions {
  double pose_wait_s = 0.03;

  static void Visit(auto& self, auto&& visit) {
    visit("pose_wait_s", self.pose_wait_s, Range{0, 1},
          "longest wait of a frame for the pose after its time, beyond the poses' usual delay");
  }
};

// The stream of a flight: several threads put in frames and poses, one thread processes them.
// Frames wait for the pose after them, in order; over a slow link many are on their way at once.
// While the thread is busy, only the newest of those that have their pose is kept for it, of each
// camera. The threads that put in never wait, and nothing is allocated once the image memory is.
class LiveEvents : public EventSource {
 public:
  // 'lead': a frame needs poses until its time + 'lead', see RecordingEvents. Throws InputError
  // when the options are not valid.
  LiveEvents(const LiveEventsOptions& options, Duration lead, std::size_t cameras = 1);

  void Push(Frame frame);
  void Push(const PoseSample& pose);
  void Push(const GimbalSample& report);  // no frame waits for it
  void Push(const ZoomSample& report);    // nor for this one
  // False: no poses come that a frame could wait for, and none waits.
  void AwaitPoses(bool are_awaited);
  // Ends the stream: Next returns EndOfStream and waits no more.
  void Close();

  // Waits for an event and returns it: a pose or a report at once; a frame when the pose after it
  // has been given out, or when the wait for it has ended.
  Event Next() override;

  using Counters = LiveEventCounters;
  Counters counters() const;

 private:
  struct WaitingFrame {
    Frame frame;
    Time deadline;  // time at which the frame goes without a pose
    bool has_pose = false;
    bool is_missed = false;  // it got its pose while the reader was busy with another frame
  };
  Time DeadlineOf(const Frame& frame, Time now) const;
  void LearnDelay(const PoseSample& pose, Time now);
  void TakePoseInto(WaitingFrame* waiting) const;
  static bool IsReady(const WaitingFrame& waiting, Time now);
  bool IsReplaced(const WaitingFrame& waiting, Time now) const;
  void DropMissed(Time now);
  void Queue(const Event& sample);
  Event TakeSample();
  Event TakeFrame();

  Duration pose_wait_;
  Duration lead_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Event> samples_;  // poses and reports; a ring
  std::size_t first_sample_ = 0;
  std::size_t sample_count_ = 0;
  std::optional<Time> newest_pose_;  // that was put in
  double pose_delay_s_ = 0;          // the largest of the last seconds
  Time delay_learnt_;
  bool awaits_poses_ = true;
  std::size_t most_frames_;           // that may wait
  std::vector<WaitingFrame> frames_;  // those of a camera in order of time
  bool is_reader_busy_ = true;        // with a frame, or it has not come yet
  Counters counters_;
  bool is_closed_ = false;
};

}  // namespace kestrel

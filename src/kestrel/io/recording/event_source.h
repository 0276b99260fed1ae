// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/core/poses/zoom_history.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// The stream has ended.
struct EndOfStream {};

// Input of a pipeline: a frame, a pose of the navigation (with its rates, if they are known), or a
// report of the camera's gimbal or zoom.
using Event = std::variant<EndOfStream, Frame, PoseSample, GimbalSample, ZoomSample>;

// Frames, poses and reports as one stream, the same for a recording as for a camera beside an
// autopilot. Each kind is in order of time. A frame comes after the poses and
// reports that it needs, except for those that are late: these come after it.
class EventSource {
 public:
  virtual ~EventSource() = default;

  // Returns the next event; with a live source it waits for one. After the end it always returns
  // EndOfStream. Throws InputError when the source fails.
  virtual Event Next() = 0;
};

// Gives each frame of a source after the poses that it needs: all poses up to the first one that is
// not before the frame's time + 'lead' (the clock offset, and the time after its own that a frame
// needs). The source's reports of a gimbal and a zoom come half a second ahead: their clocks have
// offsets, too.
// 'source' must outlive this.
class RecordingEvents : public EventSource {
 public:
  RecordingEvents(FrameSource* source, std::vector<PoseSample> poses, Duration lead);

  Event Next() override;

 private:
  bool NeedsPose() const;
  template <class Report>
  bool NeedsReport(const std::vector<Report>& reports, std::size_t next) const;

  FrameSource* source_;
  std::vector<PoseSample> poses_;
  Duration lead_;
  std::size_t next_pose_ = 0;
  std::vector<GimbalSample> gimbal_;
  std::size_t next_gimbal_ = 0;
  std::vector<ZoomSample> zoom_;
  std::size_t next_zoom_ = 0;
  std::optional<Frame> frame_;  // the next frame
};

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// There are no further events.
struct EndOfStream {};

// What a pipeline is given: a frame, a pose of the navigation (with its rates, if it tells them).
using Event = std::variant<EndOfStream, Frame, PoseSample>;

// Frames and poses as one stream. A recording, and a camera beside an autopilot, are the same to
// whoever reads it. Poses are in order of time, frames are too; a frame comes after the poses that
// it needs, unless these are late: then they come after it.
class EventSource {
 public:
  virtual ~EventSource() = default;

  // The next event; of a live source, when there is one. After the end always EndOfStream. Throws
  // InputError when the source is at fault.
  virtual Event Next() = 0;
};

// The frames of a source, each after the poses that it needs: all of the navigation until the first
// that is not before the frame's time + 'lead' (the clock offset, and what a frame needs after its
// own time). 'source' must outlive this.
class RecordingEvents : public EventSource {
 public:
  RecordingEvents(FrameSource* source, std::vector<PoseSample> poses, Duration lead);

  Event Next() override;

 private:
  bool NeedsPose() const;

  FrameSource* source_;
  std::vector<PoseSample> poses_;
  Duration lead_;
  std::size_t next_pose_ = 0;
  std::optional<Frame> frame_;  // the next one
};

}  // namespace kestrel

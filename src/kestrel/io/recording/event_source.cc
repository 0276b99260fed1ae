// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/event_source.h"

#include <utility>

namespace kestrel {

RecordingEvents::RecordingEvents(FrameSource* source, std::vector<PoseSample> poses, Duration lead)
    : source_(source), poses_(std::move(poses)), lead_(lead) {}

Event RecordingEvents::Next() {
  if (!frame_) {
    Frame frame;
    if (!source_->Next(&frame)) return EndOfStream{};
    frame_ = std::move(frame);
  }
  if (NeedsPose()) return poses_[next_pose_++];
  return *std::exchange(frame_, std::nullopt);
}

bool RecordingEvents::NeedsPose() const {
  if (next_pose_ == poses_.size()) return false;
  return next_pose_ == 0 || poses_[next_pose_ - 1].time < frame_->time + lead_;
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/event_source.h"

#include <chrono>
#include <utility>

namespace kestrel {

RecordingEvents::RecordingEvents(FrameSource* source, std::vector<PoseSample> poses, Duration lead)
    : source_(source),
      poses_(std::move(poses)),
      lead_(lead),
      gimbal_(source->gimbal()),
      zoom_(source->zoom()) {}

Event RecordingEvents::Next() {
  if (!frame_) {
    Frame frame;
    if (!source_->Next(&frame)) return EndOfStream{};
    frame_ = std::move(frame);
  }
  if (NeedsPose()) return poses_[next_pose_++];
  if (NeedsReport(gimbal_, next_gimbal_)) return gimbal_[next_gimbal_++];
  if (NeedsReport(zoom_, next_zoom_)) return zoom_[next_zoom_++];
  return *std::exchange(frame_, std::nullopt);
}

template <class Report>
bool RecordingEvents::NeedsReport(const std::vector<Report>& reports, std::size_t next) const {
  constexpr Duration kAhead = std::chrono::milliseconds(500);
  if (next == reports.size()) return false;
  return next == 0 || reports[next - 1].time < frame_->time + lead_ + kAhead;
}

bool RecordingEvents::NeedsPose() const {
  if (next_pose_ == poses_.size()) return false;
  return next_pose_ == 0 || poses_[next_pose_ - 1].time < frame_->time + lead_;
}

}  // namespace kestrel

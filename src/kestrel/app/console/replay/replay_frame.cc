// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/replay_frame.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace kestrel {
namespace {

FrameMark MarkOf(const LandingObservation& observation) {
  if (!observation.report.detection) return FrameMark::kNothing;
  const bool is_far = observation.fate == MeasurementFate::kFarFromTrack;
  return is_far ? FrameMark::kFalse : FrameMark::kFound;
}

FrameMark MarkOf(const HuntObservation& observation) {
  return observation.report.detections.empty() ? FrameMark::kNothing : FrameMark::kFound;
}

FrameMark MarkOf(const FollowObservation& observation) {
  const auto& region = observation.region;
  const bool is_seen = region && region->state == RegionState::kFollowing;
  return is_seen ? FrameMark::kFound : FrameMark::kNothing;
}

}  // namespace

ReplayFrame ReplayFrameOf(const TaskView& view, const Observation& observation) {
  const auto mark_of = [](const auto& seen) { return MarkOf(seen); };
  return {ViewFrameOf(view, observation), std::visit(mark_of, observation.seen)};
}

std::vector<OverlayShape> ShapesOf(const ReplayResult& first, const ReplayResult* second,
                                   std::size_t frame) {
  std::vector<OverlayShape> shapes = first.frames[frame].shapes;
  if (second == nullptr) return shapes;
  for (OverlayShape shape : second->frames[frame].shapes) {
    shape.run = 2;
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

std::size_t FirstFound(const std::vector<ReplayFrame>& frames) {
  const auto found = std::find_if(frames.begin(), frames.end(), [](const ReplayFrame& frame) {
    return frame.mark == FrameMark::kFound;
  });
  return found == frames.end() ? 0 : static_cast<std::size_t>(found - frames.begin());
}

void MarkLost(std::vector<ReplayFrame>* frames) {
  const auto has_pattern = [](const ReplayFrame& frame) {
    return frame.mark != FrameMark::kNothing;
  };
  const auto first = std::find_if(frames->begin(), frames->end(), has_pattern);
  const auto last = std::find_if(frames->rbegin(), frames->rend(), has_pattern).base();
  for (auto frame = first; frame < last; ++frame) {
    if (!has_pattern(*frame)) frame->mark = FrameMark::kLost;
  }
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay_frame.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace kestrel {

ReplayFrame ReplayFrameOf(const LandingView& view, const LandingObservation& observation) {
  ReplayFrame frame;
  frame.time = observation.time;
  if (observation.report.detection) {
    const bool is_far = observation.fate == MeasurementFate::kFarFromTrack;
    frame.mark = is_far ? FrameMark::kFalse : FrameMark::kFound;
  }
  frame.sample = LandingSample(observation);
  frame.status = LandingStatus(observation);
  frame.map = LandingMap(view, observation);
  frame.shapes = LandingShapes(view, observation);
  frame.facts = LandingFacts(observation);
  return frame;
}

ReplayFrame ReplayFrameOf(const HuntView& view, const HuntObservation& observation) {
  ReplayFrame frame;
  frame.time = observation.time;
  if (!observation.report.detections.empty()) frame.mark = FrameMark::kFound;
  frame.sample = HuntSample(observation);
  frame.status = HuntStatus(observation);
  frame.map = HuntMap(view, observation);
  frame.shapes = HuntShapes(view, observation);
  frame.facts = HuntFacts(view, observation);
  return frame;
}

ReplayFrame ReplayFrameOf(const TaskView& view, const Observation& observation) {
  return std::visit(
      [&]<class View>(const View& one) {
        return ReplayFrameOf(one, std::get<typename View::Seen>(observation.seen));
      },
      view);
}

ReplayFrame BrokenReplayFrame(const TaskView& view, const BrokenFrame& broken) {
  ReplayFrame frame = std::visit(
      [&]<class View>(const View& one) {
        typename View::Seen nothing;
        nothing.time = broken.time;
        return ReplayFrameOf(one, nothing);
      },
      view);
  frame.facts = {{"image", "unreadable: " + broken.fault}};
  return frame;
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

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/views/task_view.h"

#include "kestrel/core/base/error.h"
#include "kestrel/flight/session/follow_task.h"
#include "kestrel/flight/session/hunt_task.h"
#include "kestrel/flight/session/land_task.h"

namespace kestrel {
namespace {

ViewFrame ViewFrameOf(const LandingView& view, const LandingObservation& observation) {
  return {observation.time,
          LandingSample(observation),
          LandingStatus(observation),
          LandingMap(view, observation),
          LandingShapes(view, observation),
          LandingFacts(observation)};
}

ViewFrame ViewFrameOf(const HuntView& view, const HuntObservation& observation) {
  return {observation.time,           HuntSample(observation),       HuntStatus(observation),
          HuntMap(view, observation), HuntShapes(view, observation), HuntFacts(view, observation)};
}

ViewFrame ViewFrameOf(const FollowView& /*view*/, const FollowObservation& observation) {
  return {observation.time,       FollowSample(observation), FollowStatus(observation),
          FollowMap(observation), FollowShapes(observation), FollowFacts(observation)};
}

// Returns null where something else is looked for.
const HuntView* HuntIn(const TaskView& view) { return std::get_if<HuntView>(&view); }

}  // namespace

ViewParts PartsOf(const TaskView& view) {
  if (const HuntView* const hunt = HuntIn(view)) {
    return {HuntSeries(), HuntLayers(), HuntImageViews(*hunt)};
  }
  if (std::holds_alternative<FollowView>(view)) return {FollowSeries(), FollowLayers(), {}};
  return {LandingSeries(), LandingLayers(), LandingImageViews()};
}

TaskView ViewOf(const Task& task, const CameraCalibration& calibration) {
  if (const auto* land = dynamic_cast<const LandTask*>(&task)) {
    return ViewOf(calibration, land->options());
  }
  if (const auto* hunt = dynamic_cast<const HuntTask*>(&task)) {
    return HuntView{hunt->model(), hunt->options().detector};
  }
  if (const auto* follow = dynamic_cast<const FollowTask*>(&task)) {
    return FollowView{follow->options().Tracker().Noise()};
  }
  throw InputError("this task has no view for a page or an MCAP file");
}

const ObjectModel* ModelOf(const TaskView& view) {
  const HuntView* const hunt = HuntIn(view);
  return hunt == nullptr ? nullptr : &hunt->model;
}

std::optional<ViewedTeam> TeamOf(const TaskView& view, const TeamReport& report) {
  const HuntView* const hunt = HuntIn(view);
  if (hunt == nullptr) return std::nullopt;
  return HuntTeam(*hunt, report);
}

ViewFrame ViewFrameOf(const TaskView& view, const Observation& observation) {
  return std::visit(
      [&]<class View>(const View& one) {
        return ViewFrameOf(one, std::get<typename View::Seen>(observation.seen));
      },
      view);
}

ViewFrame ViewFrameOf(const TaskView& view, const BrokenFrame& broken) {
  ViewFrame frame = std::visit(
      [&]<class View>(const View& one) {
        typename View::Seen nothing;
        nothing.time = broken.time;
        return ViewFrameOf(one, nothing);
      },
      view);
  frame.facts = {{"image", "unreadable: " + broken.fault}};
  return frame;
}

}  // namespace kestrel

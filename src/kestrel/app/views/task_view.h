// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "kestrel/app/views/follow_view.h"
#include "kestrel/app/views/hunt_view.h"
#include "kestrel/app/views/landing_view.h"
#include "kestrel/app/views/view_data.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/observation.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// The view of a task, which viewers make of a session's results.
using TaskView = std::variant<LandingView, HuntView, FollowView>;

// The parts of a view: series to plot, layers over the image, and images in its place.
struct ViewParts {
  std::vector<SeriesDescription> series;
  std::vector<OverlayLayer> layers;
  std::vector<ImageView> images;
};
ViewParts PartsOf(const TaskView& view);

// Returns the view of a task. Throws InputError where there is none.
TaskView ViewOf(const Task& task, const CameraCalibration& calibration);

// Returns the objects whose colours a page can teach; null: there are none.
const ObjectModel* ModelOf(const TaskView& view);

// Returns what viewers show of the team's map; nothing for a task that makes none.
std::optional<ViewedTeam> TeamOf(const TaskView& view, const TeamReport& report);

// The view of one frame.
struct ViewFrame {
  Time time;
  ViewSample sample;
  ViewStatus status;
  ViewMap map;
  std::vector<OverlayShape> shapes;
  std::vector<ViewFact> facts;
};
// 'observation': of the view's kind.
ViewFrame ViewFrameOf(const TaskView& view, const Observation& observation);
// Returns the view of a frame whose image cannot be read, which says so.
ViewFrame ViewFrameOf(const TaskView& view, const BrokenFrame& broken);

}  // namespace kestrel

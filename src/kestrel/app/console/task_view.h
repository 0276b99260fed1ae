// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <variant>
#include <vector>

#include "kestrel/app/console/hunt_view.h"
#include "kestrel/app/console/landing_view.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/session/task.h"

namespace kestrel {

// What viewers show of a session's results.
using TaskView = std::variant<LandingView, HuntView>;

// What a page plots, draws over the image, and can show in its place.
struct ViewParts {
  std::vector<SeriesDescription> series;
  std::vector<OverlayLayer> layers;
  std::vector<ImageView> images;
};
ViewParts PartsOf(const TaskView& view);

// Returns the view of a task. Throws InputError where there is none.
TaskView ViewOf(const Task& task, const CameraCalibration& calibration);

}  // namespace kestrel

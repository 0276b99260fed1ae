// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/task_view.h"

#include "kestrel/core/base/error.h"
#include "kestrel/flight/session/hunt_task.h"
#include "kestrel/flight/session/land_task.h"

namespace kestrel {

ViewParts PartsOf(const TaskView& view) {
  if (const auto* hunt = std::get_if<HuntView>(&view)) {
    return {HuntSeries(), HuntLayers(), HuntImageViews(*hunt)};
  }
  return {LandingSeries(), LandingLayers(), LandingImageViews()};
}

TaskView ViewOf(const Task& task, const CameraCalibration& calibration) {
  if (const auto* land = dynamic_cast<const LandTask*>(&task)) {
    return ViewOf(calibration, land->options());
  }
  if (const auto* hunt = dynamic_cast<const HuntTask*>(&task)) {
    return HuntView{hunt->model(), hunt->options().detector};
  }
  throw InputError("this task has no view for a page or an MCAP file");
}

}  // namespace kestrel

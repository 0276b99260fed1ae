// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/zoom_checks.h"

#include <string>

#include <fmt/format.h>

#include "kestrel/core/camera/zoom_lens.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {

Finding CheckZoom(const DoctorObservations& observations) {
  constexpr double kLeast_hz = 2;
  const std::string check = "zoom";
  const LinkObservations& link = observations.link;
  if (!link.is_heard || link.listened_s <= 0) {
    return NotChecked(check, "the autopilot was not heard for long enough");
  }
  if (!link.view_rad) {
    return Wrong(check, "no report of the field of view came: no image is searched",
                 "CAMERA_FOV_STATUS from the camera (CAM1_TYPE, ArduPilot; MAV_n_FORWARD 1, PX4); "
                 "is zoom.device_id in the camera's file right?");
  }
  const double rate_hz = link.zoom_reports / link.listened_s;
  const std::string measured =
      fmt::format("{:.1f} deg wide, {:.1f} reports/s", Degrees(*link.view_rad), rate_hz);
  if (!LensAt(*observations.calibration.zoom, *link.view_rad)) {
    return Wrong(check, measured + ": the camera's file has no lens for it",
                 "kestrel calibrate lens --zoom-deg, at this setting, too");
  }
  if (rate_hz >= kLeast_hz) return Good(check, measured);
  return Doubtful(check, measured,
                  "2 or more: until the next report a lens that moves slowly is not noticed");
}

}  // namespace kestrel

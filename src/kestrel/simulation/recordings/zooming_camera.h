// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/simulation/rendering/flight_camera.h"
#include "kestrel/simulation/vehicle/zoom_model.h"

namespace kestrel {

// A camera on a flying body whose lens may zoom. Thread-safe.
class ZoomingCamera {
 public:
  using Make = std::function<std::shared_ptr<const FlightCamera>(const CameraIntrinsics& lens)>;

  // 'lens': before it zooms; 'make': the camera with another lens.
  ZoomingCamera(const ZoomOptions& options, const CameraIntrinsics& lens, Make make);

  // Returns the camera with its lens at a time.
  std::shared_ptr<const FlightCamera> At(double time_s) const;

 private:
  ZoomOptions options_;
  CameraIntrinsics lens_;
  Make make_;
  std::shared_ptr<const FlightCamera> first_, last_;  // at rest, before and after
};

}  // namespace kestrel

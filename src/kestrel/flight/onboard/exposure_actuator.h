// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace kestrel {

// Sets the exposure of a camera.
class ExposureActuator {
 public:
  virtual ~ExposureActuator() = default;

  // Sets the exposure of the images to come; false when the camera refuses or is away. Does not
  // throw.
  virtual bool SetExposure(double exposure_s) = 0;
};

}  // namespace kestrel

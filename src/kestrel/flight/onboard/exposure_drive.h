// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/exposure_controller.h"

namespace kestrel {

// What sets the exposure of a camera.
class ExposureActuator {
 public:
  virtual ~ExposureActuator() = default;

  // Sets it for the images to come; false when the camera refuses, or is away. Does not throw.
  virtual bool SetExposure(double exposure_s) = 0;
};

// Exposure control of a live camera: the controller's result goes to the camera.
class ExposureDrive {
 public:
  // 'actuator' must outlive this. Throws InputError when the options are not valid.
  ExposureDrive(const ExposureOptions& options, double exposure_s, ExposureActuator* actuator);

  // As ExposureController::Update. What the camera refuses is given to it again with the next
  // image.
  void Update(const cv::Mat& image, const cv::Rect& area = {});

  double exposure_s() const { return controller_.exposure_s(); }
  // Whether the camera has the exposure.
  bool is_set() const { return set_s_ == controller_.exposure_s(); }

 private:
  ExposureController controller_;
  ExposureActuator* actuator_;
  double set_s_ = 0;
};

// The exposure of a V4L2 device: V4L2_CID_EXPOSURE_ABSOLUTE (0.1 ms), with the driver's own control
// switched off where it has one.
class V4l2ExposureActuator : public ExposureActuator {
 public:
  // 'device': "/dev/video0". It need not be there yet.
  explicit V4l2ExposureActuator(std::string device);

  bool SetExposure(double exposure_s) override;

 private:
  std::string device_;
};

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/exposure_controller.h"
#include "kestrel/flight/onboard/exposure_actuator.h"

namespace kestrel {

// Exposure control of a live camera: passes the controller's result to the camera.
class ExposureDrive {
 public:
  // 'actuator' must outlive this. Throws InputError when the options are not valid.
  ExposureDrive(const ExposureOptions& options, double exposure_s, ExposureActuator* actuator);

  // As ExposureController::Update. An exposure that the camera refused is sent again with the next
  // image.
  void Update(const cv::Mat& image, const cv::Rect& area = {});

  double exposure_s() const { return controller_.exposure_s(); }
  // True when the camera has accepted the exposure.
  bool is_set() const { return set_s_ == controller_.exposure_s(); }

 private:
  ExposureController controller_;
  ExposureActuator* actuator_;
  double set_s_ = 0;
};

// Exposure of a V4L2 device: V4L2_CID_EXPOSURE_ABSOLUTE (0.1 ms). Switches the driver's own
// exposure control off, if it has one.
class V4l2ExposureActuator : public ExposureActuator {
 public:
  // 'device': "/dev/video0". It need not exist yet.
  explicit V4l2ExposureActuator(std::string device);

  bool SetExposure(double exposure_s) override;

 private:
  std::string device_;
};

}  // namespace kestrel

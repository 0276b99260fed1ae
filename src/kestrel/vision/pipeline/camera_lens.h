// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/zoom_history.h"
#include "kestrel/vision/pipeline/image_turn.h"

namespace kestrel {

// The lens of a camera that zooms at the times of its images: by the reports of the zoom, as long
// as the images do not contradict them.
class CameraLens {
 public:
  // 'calibration' has a zoom.
  CameraLens(const CameraCalibration& calibration, std::size_t capacity);

  // Adds a report of the zoom, on its clock.
  PoseStatus Add(const ZoomSample& report) { return history_.Add(report); }

  // Takes the next image, CV_8UC1 of the camera's size, and its time on the images' clock. Returns
  // the reported view of its lens (rad); nothing while the lens moves, where no report holds, and
  // from an image whose background is another size than in the one before, as after a switch of the
  // sensor, until two reports after it agree. Does not throw or allocate.
  std::optional<double> ViewAt(const cv::Mat& image, Time image_time);

  // Returns the lens with a reported view; nothing where the calibration does not reach that far.
  std::optional<CameraIntrinsics> LensOf(double view_rad) const { return LensAt(zoom_, view_rad); }

 private:
  ZoomLens zoom_;
  Duration image_to_zoom_;  // t_zoom = t_image + this
  ZoomHistory history_;
  ImageTurn turn_;
};

}  // namespace kestrel

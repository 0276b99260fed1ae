// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/target/target_detection.h"
#include "kestrel/vision/target/target_shape.h"

namespace kestrel {

// Memory of one thread's detections. A detector that needs none uses this class as it is.
class TargetWorkspace {
 public:
  TargetWorkspace() = default;
  virtual ~TargetWorkspace() = default;

 protected:
  TargetWorkspace(const TargetWorkspace&) = default;
  TargetWorkspace(TargetWorkspace&&) = default;
  TargetWorkspace& operator=(const TargetWorkspace&) = default;
  TargetWorkspace& operator=(TargetWorkspace&&) = default;
};

// Finds one kind of pad in an image. All that comes after the detection (track, guidance, link,
// tables, pictures) knows a pad by this class alone.
class TargetDetector {
 public:
  virtual ~TargetDetector() = default;

  // Searches one image. 'image': CV_8UC1 of the camera's size; anything else is a programming
  // error, which the report tells. 'workspace': one of MakeWorkspace(), of one thread at a time;
  // with it this is thread-safe. Does not throw, and does not allocate once the workspace has
  // warmed up, unless the detector says so.
  virtual TargetReport Detect(const cv::Mat& image, const TargetHint& hint,
                              TargetWorkspace& workspace) const = 0;

  // Searches one image of which nothing is known, with a workspace of its own. A loop over images
  // keeps a workspace instead, which saves its memory and the time to make it.
  TargetReport Detect(const cv::Mat& image) const {
    return Detect(image, TargetHint(), *MakeWorkspace());
  }

  virtual std::unique_ptr<TargetWorkspace> MakeWorkspace() const = 0;

  virtual const CameraModel& camera() const = 0;
  virtual const TargetShape& shape() const = 0;

 protected:
  TargetDetector() = default;
  TargetDetector(const TargetDetector&) = default;
  TargetDetector(TargetDetector&&) = default;
  TargetDetector& operator=(const TargetDetector&) = default;
  TargetDetector& operator=(TargetDetector&&) = default;
};

}  // namespace kestrel

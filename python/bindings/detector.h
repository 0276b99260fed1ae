// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "arrays.h"
#include "kestrel/target_detector.h"
#include "seen.h"

namespace kestrel::python {

// A detector of Python: any threads may use it at the same time, each with a workspace of its own.
class Detector {
 public:
  explicit Detector(std::shared_ptr<const TargetDetector> detector);
  virtual ~Detector() = default;
  Detector(const Detector&) = delete;
  Detector& operator=(const Detector&) = delete;

  // Searches a gray image of the camera's size. Does not hold the interpreter while it does.
  SeenReport Detect(const pybind11::handle& image, const TargetHint& hint);

  const std::shared_ptr<const TargetDetector>& target() const { return detector_; }
  const std::shared_ptr<PadView>& view() const { return view_; }

 private:
  std::unique_ptr<TargetWorkspace> TakeWorkspace();

  std::shared_ptr<const TargetDetector> detector_;
  std::shared_ptr<PadView> view_;
  std::vector<std::unique_ptr<TargetWorkspace>> idle_;  // guarded by the interpreter's lock
};

// A detector for a pipeline, which wants one of its own.
class SharedDetector : public TargetDetector {
 public:
  explicit SharedDetector(std::shared_ptr<const TargetDetector> detector)
      : detector_(std::move(detector)) {}

  TargetReport Detect(const cv::Mat& image, const TargetHint& hint,
                      TargetWorkspace& workspace) const override {
    return detector_->Detect(image, hint, workspace);
  }
  std::unique_ptr<TargetWorkspace> MakeWorkspace() const override {
    return detector_->MakeWorkspace();
  }
  const CameraModel& camera() const override { return detector_->camera(); }
  const TargetShape& shape() const override { return detector_->shape(); }

 private:
  std::shared_ptr<const TargetDetector> detector_;
};

}  // namespace kestrel::python

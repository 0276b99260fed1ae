// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/helipad_detector.h"

#include <utility>

#include "kestrel/core/base/options.h"
#include "kestrel/vision/helipad/helipad_candidates.h"
#include "kestrel/vision/helipad/helipad_model.h"
#include "kestrel/vision/helipad/helipad_search.h"

namespace kestrel {

struct HelipadDetector::Impl {
  Impl(const CameraModel& of_image, const HelipadDetectorOptions& how)
      : camera(of_image),
        options(Checked(how)),
        pad(options),
        finder(camera, pad),
        alignment(camera, pad.parts),
        shape(ShapeOf(options)) {}

  CameraModel camera;
  HelipadDetectorOptions options;
  HelipadModel pad;
  HelipadFinder finder;
  PadAlignment alignment;
  TargetShape shape;
};

HelipadDetector::HelipadDetector(const CameraModel& camera, const HelipadDetectorOptions& options)
    : impl_(std::make_unique<const Impl>(camera, options)) {}
HelipadDetector::~HelipadDetector() = default;
HelipadDetector::HelipadDetector(HelipadDetector&&) noexcept = default;
HelipadDetector& HelipadDetector::operator=(HelipadDetector&&) noexcept = default;

TargetReport HelipadDetector::Detect(const cv::Mat& image, const TargetHint& hint,
                                     TargetWorkspace& workspace) const {
  constexpr double kPartFactor = 1.5, kPartMarginPx = 12;
  const HelipadSearchModels models{{impl_->camera, impl_->alignment, impl_->pad.radius_m,
                                    impl_->options.level_sigma_deg, kPartFactor, kPartMarginPx},
                                   impl_->pad,
                                   impl_->finder,
                                   impl_->options.min_quality};
  return HelipadSearch(models, image, hint, &dynamic_cast<HelipadSearchBuffers&>(workspace)).Run();
}

std::unique_ptr<TargetWorkspace> HelipadDetector::MakeWorkspace() const {
  auto workspace = std::make_unique<HelipadSearchBuffers>();
  workspace->pad.samples.Reserve(impl_->pad.samples.count());
  impl_->alignment.Reserve(&workspace->pad.alignment);
  return workspace;
}

const CameraModel& HelipadDetector::camera() const { return impl_->camera; }
const TargetShape& HelipadDetector::shape() const { return impl_->shape; }

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/camera/camera_model.h"
#include "kestrel/camera/ray_table.h"
#include "kestrel/landing/landing_pattern.h"
#include "kestrel/landing/pattern_view.h"
#include "kestrel/landing/small_pattern.h"

namespace kestrel {

// Memory of RectifiedPrint.
struct RectifiedPrintBuffers {
  cv::Mat gray;  // CV_8UC1
  cv::Mat seen;  // CV_8UC1, 255 where the image shows the print
};

// Looks at the gray values of a print whose place in the image is known, of any size: as a small
// print that a camera sees from straight above.
class RectifiedPrint {
 public:
  explicit RectifiedPrint(const LandingPattern& pattern);
  // The parts refer to each other.
  RectifiedPrint(const RectifiedPrint&) = delete;
  RectifiedPrint& operator=(const RectifiedPrint&) = delete;

  // Half the side of the square that a view must cover.
  double extent_m() const { return extent_m_; }

  // Takes the print out of 'image', which 'view' refers to. Does not allocate after the first call.
  void Rectify(const cv::Mat& image, const PatternView& view, RectifiedPrintBuffers* buffers) const;

  // How well it agrees with the print; nothing when too little of it is in view, or there are no
  // shadows. Does not allocate.
  std::optional<SmallPatternFitter::Fit> Compare(const RectifiedPrintBuffers& buffers,
                                                 SmallPatternFitter::Light light,
                                                 SmallPatternWorkspace* workspace) const;

 private:
  double extent_m_;
  CameraModel camera_;
  RayTable rays_;
  SmallPatternFitter fitter_;
};

}  // namespace kestrel

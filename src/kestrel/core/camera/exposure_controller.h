// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"

namespace kestrel {

struct ExposureOptions {
  double low_gray = 200;
  double high_gray = 240;
  double gamma = 1;
  double black_gray = 4;  // linear value without light
  int delay_frames = 2;
  double min_exposure_s = 2e-5;
  double max_exposure_s = 0.01;

  static void Visit(auto& self, auto&& visit) {
    visit("low_gray", self.low_gray, MoreThan(0),
          "lower limit of the gray value of the image's brightest part");
    visit("high_gray", self.high_gray, Range{0, 254, true, false},
          "upper limit of the gray value of the image's brightest part");
    visit("gamma", self.gamma, Range{0.1, 3}, "exponent of the camera's curve; 1 is linear");
    visit("delay_frames", self.delay_frames, Range{0, 100},
          "number of images after a change that may still have the old exposure");
    visit("min_exposure_s", self.min_exposure_s, MoreThan(0), "shortest exposure");
    visit("max_exposure_s", self.max_exposure_s, "longest exposure");
    visit.Gone({"image_share", "area_share", "black_gray", "largest_step"});
  }
  std::vector<std::string> Validate() const;
};

// Controls the exposure so that the brightest part of the image keeps its brightness in any light
// (paper, section 2.1: "the brightest point in the image is in the range 200 to 240").
//
// Light is proportional to exposure, so one image determines the right exposure, unless it is
// saturated or black. After each change the controller waits until the change must be visible. An
// image with an older exposure is thus never taken for the effect of the new one, which prevents
// oscillation. Does not allocate.
class ExposureController {
 public:
  // Starts with 'exposure_s', clamped to the camera's range. Throws InputError when the options are
  // invalid.
  ExposureController(const ExposureOptions& options, double exposure_s);

  // Returns the exposure (s) for the following images. 'image': CV_8UC1, every image of the camera,
  // in order. 'area': the pattern's area in it, whose white is then measured; empty: the whole
  // image is measured.
  double Update(const cv::Mat& image, const cv::Rect& area = {});

  double exposure_s() const { return exposure_s_; }

 private:
  double Linear(double gray) const;
  double StepFor(int bright_gray, int samples) const;

  ExposureOptions options_;
  double exposure_s_ = 0;
  int frames_to_wait_ = 0;
  std::array<int, 256> histogram_{};
};

}  // namespace kestrel

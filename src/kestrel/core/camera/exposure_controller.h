// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace kestrel {

struct ExposureOptions {
  // Gray values between which the brightest part of the image is kept (paper, section 2.1). Within
  // them the exposure stays; outside of them it aims at the middle.
  double low_gray = 200;
  double high_gray = 240;
  // Share of the pixels that may be brighter, 0 to 1: of an image, so that a glint or the sun does
  // not darken everything else, and of the pattern's area, much of which is white.
  double image_share = 0.01;
  double area_share = 0.1;
  // The camera's curve: gray = 255 (linear / 255)^gamma. 'black_gray' is the linear value without
  // light.
  double gamma = 1;
  double black_gray = 4;
  // Number of images after a change that may still have an older exposure. Too high a number only
  // slows the control; too low a number makes it oscillate.
  int delay_frames = 2;
  // Limits of the camera; the upper one also limits motion blur.
  double min_exposure_s = 2e-5;
  double max_exposure_s = 0.01;
  // Largest factor of one change, above 1.
  double largest_step = 8;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("low_gray", self.low_gray, "",
            "lower limit of the gray value of the image's brightest part");
    visitor("high_gray", self.high_gray, "",
            "upper limit of the gray value of the image's brightest part");
    visitor("image_share", self.image_share, "1", "share of an image that may be brighter");
    visitor("area_share", self.area_share, "1", "share of the pattern's area that may be brighter");
    visitor("gamma", self.gamma, "1", "exponent of the camera's curve; 1 is linear");
    visitor("black_gray", self.black_gray, "", "gray value without light, before gamma");
    visitor("delay_frames", self.delay_frames, "1",
            "number of images after a change that may still have the old exposure");
    visitor("min_exposure_s", self.min_exposure_s, "s", "shortest exposure");
    visitor("max_exposure_s", self.max_exposure_s, "s", "longest exposure");
    visitor("largest_step", self.largest_step, "1", "largest factor of one change");
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

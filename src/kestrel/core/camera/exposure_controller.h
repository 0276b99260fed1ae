// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace kestrel {

struct ExposureOptions {
  // Gray values between which the brightest part of the image is kept (paper, section 2.1). In
  // between nothing is changed; outside of it the exposure aims at the middle.
  double low_gray = 200;
  double high_gray = 240;
  // Share of the pixels that may be brighter, 0 to 1: of an image, so that a glint or the sun does
  // not darken all the rest, and of the pattern's area, where a good part is white.
  double image_share = 0.01;
  double area_share = 0.1;
  // The camera's curve: gray = 255 (linear / 255)^gamma, where 'black_gray' (linear) is without
  // light.
  double gamma = 1;
  double black_gray = 4;
  // Images after a change that may still have an older exposure. Too many only make it slower; with
  // too few it oscillates.
  int delay_frames = 2;
  // What the camera can do, and at most as much as motion blur allows.
  double min_exposure_s = 2e-5;
  double max_exposure_s = 0.01;
  // Largest factor by which the exposure changes at once, above 1.
  double largest_step = 8;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("low_gray", self.low_gray, "", "the brightest part of the image is no darker");
    visitor("high_gray", self.high_gray, "", "and no brighter");
    visitor("image_share", self.image_share, "1", "share of an image that may be brighter");
    visitor("area_share", self.area_share, "1", "share of the pattern's area that may be brighter");
    visitor("gamma", self.gamma, "1", "exponent of the camera's curve; 1 is linear");
    visitor("black_gray", self.black_gray, "", "gray value without light, before gamma");
    visitor("delay_frames", self.delay_frames, "1",
            "images after a change that may still have the old exposure");
    visitor("min_exposure_s", self.min_exposure_s, "s", "shortest exposure");
    visitor("max_exposure_s", self.max_exposure_s, "s", "longest exposure");
    visitor("largest_step", self.largest_step, "1", "largest factor of one change");
  }
  std::vector<std::string> Validate() const;
};

// Controls the exposure so that the brightest part of the image keeps its brightness whatever the
// light (paper, section 2.1: "the brightest point in the image is in the range 200 to 240").
//
// Light is proportional to exposure: one image tells the right exposure, unless it is saturated or
// black. After each change it waits until the change must show: an image taken with an older
// exposure is never mistaken for the effect of the new one, hence no oscillation. Allocates
// nothing.
class ExposureController {
 public:
  // Begins with 'exposure_s', brought into the camera's range. Throws InputError when the options
  // are not valid.
  ExposureController(const ExposureOptions& options, double exposure_s);

  // The exposure (s) for the images to come. 'image': CV_8UC1, every one that the camera takes, in
  // order; 'area': where the pattern is in it, whose white then counts; empty: the whole image
  // does.
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

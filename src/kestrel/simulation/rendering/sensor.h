// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/simulation/rendering/lens.h"

namespace kestrel {

// Conversion of light to 8 bits. Gray values of noise and levels are those before gamma.
struct SensorOptions {
  double black_level = 4;
  double white_level = 235;
  double gain_variation = 0;
  double gamma = 1;
  double read_noise = 1.2;
  double shot_noise = 1;
  double blur_sigma_px = 0.6;
  double sharpening = 0;
  int jpeg_quality = 100;

  static void Visit(auto& self, auto&& visit) {
    visit("black_level", self.black_level, Range{0, 255}, "gray value without light");
    visit("white_level", self.white_level, Range{1, 5000},
          "gray value of a white horizontal surface in full light; more than 255 overexposes");
    visit("gain_variation", self.gain_variation, Range{0, 1},
          "variation of the exposure by its control, to both sides");
    visit("gamma", self.gamma, Range{0.1, 3}, "exponent of the camera's curve; 1 is linear");
    visit("read_noise", self.read_noise, Range{0, 100},
          "standard deviation in gray values, before gamma");
    visit("shot_noise", self.shot_noise, Range{0, 100},
          "standard deviation at gray 100, before gamma; it grows with the root of light");
    visit("blur_sigma_px", self.blur_sigma_px, Range{0, 20},
          "standard deviation of the optics' blur");
    visit("sharpening", self.sharpening, Range{0, 3}, "part of the detail that is added once more");
    visit("jpeg_quality", self.jpeg_quality, Range{1, 100},
          "below 100 the images are compressed by JPEG");
  }
};

// Returns the 8-bit image of 'radiance' (CV_32FC1 or CV_32FC3, linear, in units of white, as from
// FrameRenderer): seen behind the airframe and through the lens, blurred, exposed with noise.
// 'seed' determines the noise; 'gain' multiplies the light.
cv::Mat Expose(const SensorOptions& options, const Lens& lens, double gain, std::uint64_t seed,
               cv::Mat radiance);

}  // namespace kestrel

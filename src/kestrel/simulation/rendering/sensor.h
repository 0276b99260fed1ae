// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/simulation/rendering/lens.h"

namespace kestrel {

// Conversion of light to 8 bits. Gray values of noise and levels are those before gamma.
struct SensorOptions {
  double black_level = 4;      // gray value without light, 0 to 255
  double white_level = 235;    // gray value of a white horizontal surface in full light
  double gain_variation = 0;   // relative variation of the gain by exposure control, to both sides,
                               // 0 to 1
  double gamma = 1;            // exponent of the camera's curve; 1 is linear, 0.45 as for screens
  double read_noise = 1.2;     // standard deviation, gray values
  double shot_noise = 1;       // standard deviation at gray 100; proportional to the root of the
                               // light
  double blur_sigma_px = 0.6;  // Gaussian blur of the optics, 0 to 20
  double sharpening = 0;       // part of the detail that the camera adds, 0 to 3
  int jpeg_quality = 100;      // below 100: the camera compresses its images, 1 to 100

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("black_level", self.black_level, "", "gray value without light");
    visitor("white_level", self.white_level, "",
            "gray value of a white horizontal surface in full light; more than 255 overexposes");
    visitor("gain_variation", self.gain_variation, "1",
            "variation of the exposure by its control, to both sides");
    visitor("gamma", self.gamma, "1", "exponent of the camera's curve; 1 is linear");
    visitor("read_noise", self.read_noise, "", "standard deviation in gray values, before gamma");
    visitor("shot_noise", self.shot_noise, "",
            "standard deviation at gray 100, before gamma; it grows with the root of light");
    visitor("blur_sigma_px", self.blur_sigma_px, "px", "standard deviation of the optics' blur");
    visitor("sharpening", self.sharpening, "1", "part of the detail that is added once more");
    visitor("jpeg_quality", self.jpeg_quality, "1", "below 100 the images are compressed by JPEG");
  }
  std::vector<std::string> Validate() const;
};

// Returns the 8-bit image of 'radiance' (CV_32FC1 or CV_32FC3, linear, in units of white, as from
// FrameRenderer): seen behind the airframe and through the lens, blurred, exposed with noise.
// 'seed' determines the noise; 'gain' multiplies the light.
cv::Mat Expose(const SensorOptions& options, const Lens& lens, double gain, std::uint64_t seed,
               cv::Mat radiance);

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/simulation/rendering/frame_view.h"
#include "kestrel/simulation/rendering/lens.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// Exposure of a frame.
struct ShutterOptions {
  double exposure_s = 0.003;  // of a row, > 0
  double readout_s = 0;       // from the exposure of the first row to that of the last; 0: global
                              // shutter
  int rays_per_pixel = 8;     // 1 to 64, spread over the pixel and over the exposure

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("exposure_s", self.exposure_s, "s", "exposure time of a row");
    visitor(
        "readout_s", self.readout_s, "s",
        "time from the first row's exposure to the last's (rolling shutter); 0: a global shutter");
    visitor("rays_per_pixel", self.rays_per_pixel, "1",
            "rays per pixel, spread over its area and over the exposure");
  }
  std::vector<std::string> Validate() const;
};

// Ray casting: the light on the pixels of a moving camera in a moving world. Every ray has its own
// place in the pixel and its own moment of the exposure, which gives motion blur and rolling
// shutter as in a camera. Immutable and thread-safe; a frame depends only on its own arguments.
class FrameRenderer {
 public:
  // 'world' and 'lens' must outlive the renderer. Throws InputError when options are not valid.
  FrameRenderer(const Lens& lens, const World& world, const ShutterOptions& shutter);

  // Returns CV_32FC1 or CV_32FC3 (the world's channels): linear light in units of white, before the
  // loss in the lens; 0 where the lens is dark. 'time_s' is the middle of the exposure (of the
  // middle row), 'world_from_camera' the camera's motion. 'seed' determines the places of the rays
  // within pixels.
  cv::Mat Render(double time_s, const Motion& world_from_camera, std::uint64_t seed) const;

  // Returns the middle of the exposure of row 'v' (fractions allowed) relative to the frame's time,
  // s.
  double RowTime(double v) const;

  const ShutterOptions& shutter() const { return shutter_; }

 private:
  template <int kChannels>
  cv::Mat RenderChannels(double time_s, const Motion& world_from_camera, std::uint64_t seed) const;

  const Lens& lens_;
  const World& world_;
  ShutterOptions shutter_;
  ImageTiles tiles_;
};

}  // namespace kestrel

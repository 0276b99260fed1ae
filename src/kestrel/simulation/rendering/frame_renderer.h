// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/simulation/rendering/frame_view.h"
#include "kestrel/simulation/rendering/lens.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// Exposure of a frame.
struct ShutterOptions {
  double exposure_s = 0.003;
  double readout_s = 0;
  int rays_per_pixel = 8;

  static void Visit(auto& self, auto&& visit) {
    visit("exposure_s", self.exposure_s, Range{1e-6, 1}, "exposure time of a row");
    visit(
        "readout_s", self.readout_s, Range{0, 1},
        "time from the first row's exposure to the last's (rolling shutter); 0: a global shutter");
    visit("rays_per_pixel", self.rays_per_pixel, Range{1, 64},
          "rays per pixel, spread over its area and over the exposure");
  }
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

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/poses/zoom_history.h"

namespace kestrel {

// A lens that zooms once, and its reports.
struct ZoomOptions {
  double rate_hz = 0;
  double factor = 2;
  double at_s = 2;
  double takes_s = 1;

  static void Visit(auto& self, auto&& visit) {
    visit("rate_hz", self.rate_hz, Range{0, 200},
          "reports of the field of view per second; 0: the lens is fixed");
    visit("factor", self.factor, Range{0.1, 10}, "focal length after it has zoomed, over before");
    visit("at_s", self.at_s, Range{0, 1e6}, "time at which it begins to zoom");
    visit("takes_s", self.takes_s, Range{0, 100},
          "time until it is at rest again; 0: a switch to another sensor");
  }
  bool is_there() const { return rate_hz > 0; }

  // Focal length at a time over that before; between the two it grows by equal ratios.
  double FactorAt(double time_s) const;
};

// Returns the lens at a time; 'lens': before it zooms.
CameraIntrinsics ZoomedLens(const ZoomOptions& options, CameraIntrinsics lens, double time_s);

// Returns all reports from 'begin_s' to 'end_s', stamped 'clock_offset_s' after the clock of the
// images. 'lens': before it zooms.
std::vector<ZoomSample> ZoomReportsOf(const ZoomOptions& options, const CameraIntrinsics& lens,
                                      double begin_s, double end_s, double clock_offset_s);

}  // namespace kestrel

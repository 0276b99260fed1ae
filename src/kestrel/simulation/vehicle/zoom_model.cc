// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/zoom_model.h"

#include <algorithm>
#include <cmath>

#include "kestrel/core/camera/zoom_lens.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {

double ZoomOptions::FactorAt(double time_s) const {
  if (time_s < at_s) return 1;
  const double part = takes_s > 0 ? std::min((time_s - at_s) / takes_s, 1.0) : 1;
  return std::pow(factor, part);
}

CameraIntrinsics ZoomedLens(const ZoomOptions& options, CameraIntrinsics lens, double time_s) {
  const double factor = options.FactorAt(time_s);
  lens.fx_px *= factor;
  lens.fy_px *= factor;
  return lens;
}

std::vector<ZoomSample> ZoomReportsOf(const ZoomOptions& options, const CameraIntrinsics& lens,
                                      double begin_s, double end_s, double clock_offset_s) {
  std::vector<ZoomSample> reports;
  for (int i = 0; begin_s + i / options.rate_hz <= end_s; ++i) {
    const double time_s = begin_s + i / options.rate_hz;
    reports.push_back(
        {TimeOfFlight(time_s + clock_offset_s), ViewOf(ZoomedLens(options, lens, time_s))});
  }
  return reports;
}

}  // namespace kestrel

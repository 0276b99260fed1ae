// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "kestrel/calibration/print/print_lines.h"
#include "kestrel/calibration/print/print_measurement.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// An approximate or measured print: its pose, its pattern and the camera.
struct FoundPrint {
  CameraIntrinsics camera;
  RigidTransform camera_from_target;
  LandingPattern pattern;
  double pixel_m;  // size of a pixel on the print
};

// Prior knowledge of a lens.
struct LensPrior {
  double zoom_sigma;  // relative standard deviation of the focal length
  double bend_sigma;  // standard deviation of the shift of the image's corners outwards, relative
  double focal_px;    // the most likely focal length
};

struct PrintFit {
  PrintMeasurement measurement;
  FoundPrint print;    // with the measured values
  bool is_consistent;  // the edges lie on outlines, and the spread of black is usual
};

// Estimates dimensions, pose and lens with which the outlines of 'print' come nearest to 'edges',
// by robust least squares from approximate values. The outer diameter is fixed to that of the
// pattern. Returns nothing when there are too few edges.
std::optional<PrintFit> FitPrint(std::span<const PrintLineEdge> edges, const LensPrior& lens,
                                 const FoundPrint& print);

}  // namespace kestrel

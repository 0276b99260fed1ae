// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "kestrel/calibration/print/print_lines.h"
#include "kestrel/calibration/print/print_measurement.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Where a print is and what it is like, about.
struct FoundPrint {
  CameraIntrinsics camera;
  RigidTransform camera_from_pattern;
  LandingPattern pattern;
  double pixel_m;  // of the print that a pixel shows
};

// What is known of a lens before a print is looked at.
struct LensPrior {
  double zoom_sigma;  // relative, of the focal length
  double bend_sigma;  // by what part the corners of the image may lie farther out
  double focal_px;    // the likeliest
};

struct PrintFit {
  PrintMeasurement measurement;
  FoundPrint print;    // by what was measured
  bool is_consistent;  // the edges lie on outlines, and black and white spread no more than usual
};

// Dimensions, pose and lens that bring the outlines of 'print' nearest to 'edges', robust least
// squares from what it is about; the outer diameter is that of its pattern. Nothing where the edges
// are too few.
std::optional<PrintFit> FitPrint(std::span<const PrintLineEdge> edges, const LensPrior& lens,
                                 const FoundPrint& print);

}  // namespace kestrel

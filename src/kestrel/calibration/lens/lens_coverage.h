// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>

#include "kestrel/calibration/lens/lens_view.h"
#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// Which parts of the image views of the pattern say something about.
struct LensCoverage {
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;

  std::array<int, kColumns * kRows> edges{};  // in each field of the image, row by row
  double max_angle_deg = 0;                   // from the optical axis; all but 1 % are nearer
  double reach = 0;  // the same from the middle of the image, in halves of its diagonal

  int fields() const;  // that hold edges
  int EdgesAt(int column, int row) const { return edges[row * kColumns + column]; }

  // One sentence on how far the edges reach and one on what they leave out, if anything.
  std::string InWords() const;
};

LensCoverage CoverageOf(std::span<const LensView> views, const CameraModel& camera);

}  // namespace kestrel

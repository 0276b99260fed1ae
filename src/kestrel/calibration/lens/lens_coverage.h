// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "kestrel/calibration/lens/lens_view.h"
#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// The parts of the image in which the views have edges of the pattern.
struct LensCoverage {
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;

  std::array<int, kColumns * kRows> edges{};  // number in each field of the image, row by row
  double max_angle_deg = 0;                   // from the optical axis; 99 % are nearer
  double reach = 0;  // the same from the middle of the image, in halves of its diagonal

  int fields() const;  // number of fields with edges
  int EdgesAt(int column, int row) const { return edges[row * kColumns + column]; }

  // Returns the parts at the border of the image without edges, in words: corners, and sides that
  // are otherwise empty.
  std::vector<std::string> EmptyParts() const;

  // Returns a sentence on how far the edges reach, and one on the parts without any.
  std::string InWords() const;
};

LensCoverage CoverageOf(std::span<const LensView> views, const CameraModel& camera);

}  // namespace kestrel

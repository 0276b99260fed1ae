// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The detector of a board of AprilTags and ArUco markers, or of a single one.
//
// Example:
//   const TagBoard board{{BoardTag{.family = "tag36h11", .id = 3, .size_m = 0.5}}};
//   const TagBoardDetector detector(CameraModel(PaperCamera()), board, {});
//   if (const TargetReport report = detector.Detect(image); report.detection) {
//     std::cout << report.detection->camera_from_target.translation.transpose() << " m\n";
//   }

#include "kestrel/vision/tags/tag_board_detector.h"  // IWYU pragma: export

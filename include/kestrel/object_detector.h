// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The detector of coloured objects: a colour image in, all configured objects in it out.
//
// Example:
//   const ObjectDetector detector(CameraModel(PaperCamera()), DefaultObjectModel());
//   ObjectWorkspace workspace;
//   ObjectReport report;
//   detector.Detect(color_image, /*hint=*/{}, workspace, &report);
//   for (const ObjectDetection& detection : report.detections) {
//     std::cout << detector.model().classes[detection.class_index].name << "\n";
//   }

#include "kestrel/vision/objects/object_detector.h"  // IWYU pragma: export

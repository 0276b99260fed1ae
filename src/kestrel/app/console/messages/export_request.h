// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>

#include "kestrel/app/web_server/export_answer.h"

namespace kestrel {

// A file that the page requests from a recording, by numbers and never by a path.
struct ExportRequest {
  enum class Kind {
    kFrame,         // /export/frame-12.png: the image as it is
    kOverlays,      // /export/overlays-12.png: the image with the overlay drawn on it
    kDetections,    // /export/detections-1.csv: all detections of the first or the second run
    kPicture,       // /export/picture-12.jpg: the image in colour, for the page of colours
    kLabels,        // /export/labels-12.bin: labels and marks of its pixels
    kCalibration,   // /export/calibration-3.yaml: result of the third calibration
    kClip,          // /export/clip-12-80.mp4: a video of the frames 12 to 80 as they are
    kOverlaysClip,  // /export/overlays-12-80.mp4: the same with the overlay drawn on them
  };
  Kind kind = Kind::kFrame;
  std::size_t number = 0;  // frame from 0, run 1 or 2, or calibration from 1
  std::size_t last = 0;    // last frame of a clip; not before 'number'
};

// True when it requests a video, which takes long.
bool IsClip(const ExportRequest& request);

// True when the page of colours answers it.
bool IsOfColors(const ExportRequest& request);

// Returns nothing unless the path is exactly one of those above. Numbers have at most nine digits.
std::optional<ExportRequest> ParseExportPath(std::string_view path);

// A request that waits for the thread that has the recording.
struct PendingExport {
  ExportRequest request;
  // Any thread; call it once.
  std::function<void(const ExportAnswer&)> answer;
  // Any thread. True while the browser still waits for the answer.
  std::function<bool()> is_wanted;
};

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "kestrel/app/console/temporary_folder.h"

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

// True when it asks for a video, which takes long.
bool IsClip(const ExportRequest& request);

// True when the page of colours answers it.
bool IsOfColors(const ExportRequest& request);

// Returns nothing unless the path is exactly one of those above. Numbers have at most nine digits.
std::optional<ExportRequest> ParseExportPath(std::string_view path);

// A file on disk that is removed with its last owner.
struct ExportFile {
  TemporaryFolder folder;
  std::string path;
};

struct ExportAnswer {
  std::string content = {};  // empty: nothing, or it is in 'file'
  std::string type = {};     // as "image/png"
  std::string name = {};     // file name to save it as
  std::shared_ptr<const ExportFile> file = nullptr;
  std::string refusal = {};  // why it was not made; empty when the request is unknown
  std::string coding = {};   // coding of the content, as "deflate"
};

// A request that waits for the thread that has the recording.
struct PendingExport {
  ExportRequest request;
  // Any thread; call it once.
  std::function<void(const ExportAnswer&)> answer;
  // Any thread. True while the browser still waits for the answer.
  std::function<bool()> is_wanted;
};

}  // namespace kestrel

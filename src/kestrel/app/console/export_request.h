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

// What the page takes away from a recording, by numbers and never by a path.
struct ExportRequest {
  enum class Kind {
    kFrame,         // /export/frame-12.png: the image as it is
    kOverlays,      // /export/overlays-12.png: with what was found drawn on it
    kDetections,    // /export/detections-1.csv: all that the first or the second run found
    kPicture,       // /export/picture-12.jpg: the image in colour, as the page of colours shows it
    kLabels,        // /export/labels-12.bin: what its pixels are taken for and marked as
    kCalibration,   // /export/calibration-3.yaml: what the third calibration came to
    kClip,          // /export/clip-12-80.mp4: a video of the frames 12 to 80 as they are
    kOverlaysClip,  // /export/overlays-12-80.mp4: with what was found drawn on them
  };
  Kind kind = Kind::kFrame;
  std::size_t number = 0;  // of the frame from 0, of the run: 1 or 2, of the calibration from 1
  std::size_t last = 0;    // of a clip, the first at least
};

// Whether it is a video, which takes long.
bool IsClip(const ExportRequest& request);

// Whether the page of colours answers it.
bool IsOfColors(const ExportRequest& request);

// Nothing when it is none of those above, to the letter. Numbers have at most nine digits.
std::optional<ExportRequest> ParseExportPath(std::string_view path);

// A file on disk that is removed with the last who holds it.
struct ExportFile {
  TemporaryFolder folder;
  std::string path;
};

struct ExportAnswer {
  std::string content = {};  // empty: there is none, or it is in the file
  std::string type = {};     // as "image/png"
  std::string name = {};     // that it is saved by
  std::shared_ptr<const ExportFile> file = nullptr;
  std::string refusal = {};  // why it is not made; empty where it is not known what is asked for
  std::string coding = {};   // of the content, as "deflate"
};

// A request that waits for the thread that knows the recording.
struct PendingExport {
  ExportRequest request;
  // By any thread, once.
  std::function<void(const ExportAnswer&)> answer;
  // By any thread: whether who has asked still waits.
  std::function<bool()> is_wanted;
};

}  // namespace kestrel

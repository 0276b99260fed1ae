// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/recording_writer.h"

namespace kestrel {

// A recording that is to be rendered: all but its images is there.
struct RecordingPlan {
  std::vector<Time> times;  // of the images
  // The image at an index of 'times'; the same whenever and on whatever thread it is called.
  std::function<cv::Mat(std::size_t index)> render;
  // scene.yaml: names all that the images depend on.
  std::string scene;
  std::vector<RecordingFile> files;  // other than scene.yaml and cam0/data.csv
};

// Called from one thread at a time with the number of images that are done; returns whether to go
// on.
using RenderProgress = std::function<bool(std::size_t done)>;

// Renders the plan into the folder 'output' on 'threads' threads (at least 1). Until everything is
// there it lies in a folder beside it, "<output>.part", where a call with the same plan goes on
// after an interruption; a plan of another scene starts anew. Returns false when 'progress' stopped
// it. Throws InputError when 'output' exists (unless it is empty, or 'replace' and a recording) or
// cannot be written.
bool WriteRecording(const RecordingPlan& plan, const std::filesystem::path& output, bool replace,
                    int threads, const RenderProgress& progress);

}  // namespace kestrel

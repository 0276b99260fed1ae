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

// A recording to be rendered: it has everything except the images.
struct RecordingPlan {
  std::vector<Time> times;  // of the images
  // Renders the image at an index of 'times'; the result is the same at any time and on any thread.
  std::function<cv::Mat(std::size_t index)> render;
  // scene.yaml: names everything on which the images depend.
  std::string scene;
  std::vector<RecordingFile> files;  // all except scene.yaml and cam0/data.csv
};

// Called from one thread at a time with the number of finished images; returns whether to go on.
using RenderProgress = std::function<bool(std::size_t done)>;

// Renders the plan into the folder 'output' on 'threads' threads (at least 1). Until it is complete
// it is in the folder "<output>.part", where a call with the same plan continues after an
// interruption; a plan of another scene starts anew. Returns false when 'progress' stopped it.
// Throws InputError when 'output' exists (unless it is empty, or 'replace' and a recording) or
// cannot be written.
bool WriteRecording(const RecordingPlan& plan, const std::filesystem::path& output, bool replace,
                    int threads, const RenderProgress& progress);

}  // namespace kestrel

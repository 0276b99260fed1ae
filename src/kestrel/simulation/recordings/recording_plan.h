// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/io/recording/euroc/recording_file.h"

namespace kestrel {

// A recording to be rendered: it has everything except the images.
struct RecordingPlan {
  std::vector<Time> times;  // image times
  // Renders the image at an index of 'times'; the result is the same at any time and on any thread.
  std::function<cv::Mat(std::size_t index)> render;
  // scene.yaml: names everything on which the images depend.
  std::string scene;
  std::vector<RecordingFile> files;  // all except scene.yaml and cam0/data.csv

  // The images of the cameras 1, 2, ...: their times, and 'render' for each.
  struct Camera {
    std::vector<Time> times;
    std::function<cv::Mat(std::size_t index)> render;
  };
  std::vector<Camera> further = {};

  std::size_t image_count() const;  // counts those of all cameras
};

// The camera of the paper on a UAV: it looks down, and the top of its image is forward.
CameraCalibration PaperCalibration();
// The colour camera of a hunt: 1280x720, 77 degrees wide, mounted in the same way.
CameraCalibration HuntCalibration();
// A colour camera that looks ahead and 34 degrees down: 752x480, 70 degrees wide.
CameraCalibration FollowCalibration();

// Plans a flight over the landing pattern, or a hunt, by the name of its scenario and "key=value"
// settings, as `kestrel simulate` does: "calm", "figure8"; its --list names them. The same
// arguments give the same recording. Throws InputError when the scenario does not exist, or a
// setting or the camera is not valid.
RecordingPlan PlanLandingScenario(const std::string& scenario,
                                  const std::vector<std::string>& settings,
                                  const CameraCalibration& camera, std::uint64_t seed);
RecordingPlan PlanHuntScenario(const std::string& scenario,
                               const std::vector<std::string>& settings,
                               const CameraCalibration& camera, std::uint64_t seed);

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

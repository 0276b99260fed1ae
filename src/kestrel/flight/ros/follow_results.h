// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/flight/session/result_connection.h"
#include "kestrel/vision/pipeline/follow_pipeline.h"

namespace kestrel {

// Names of the published frames.
struct FollowResultsOptions {
  std::string camera_frame;
  std::optional<std::string> world_frame;  // where there are poses
  std::string target_frame;
};

// Publishes what is followed: its track, and the image with its box when somebody subscribes.
class FollowResults {
 public:
  // 'connection' must outlive this.
  FollowResults(FollowResultsOptions options, ResultConnection* connection);

  void PublishTrack(const FollowObservation& observation);
  void PublishImage(const cv::Mat& image, const FollowObservation& observation);

 private:
  FollowResultsOptions options_;
  ResultConnection* connection_;
};

}  // namespace kestrel

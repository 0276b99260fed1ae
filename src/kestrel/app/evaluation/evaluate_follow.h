// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/app/evaluation/report.h"
#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/euroc/truth_rows.h"

namespace kestrel {

// A row of follow_track.csv whose image could be read.
struct FollowRow {
  Time time;
  bool is_following = false;      // seen in this image, not predicted
  std::optional<cv::Rect2d> box;  // nothing when it is lost
  struct Place {
    Eigen::Vector2d in_world;
    double sigma_along_m, sigma_across_m;
  };
  std::optional<Place> place;
};
// Throws InputError when the table is not valid.
std::vector<FollowRow> ParseFollowRows(std::string_view text, const std::string& file);

// Rows of region0/data.csv. Throws InputError when the table is not valid.
std::vector<TrueRegion> ParseTrueRegions(std::string_view text, const std::string& file);

// Compares the output of `kestrel follow` in the folder 'output' (follow_track.csv) with the truth
// of 'recording' (region0, and region1 and so on, if there, for things that look like it). Throws
// InputError when a file is missing or not valid, or does not belong to the recording.
Report EvaluateFollow(const std::string& recording, const std::string& output);

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/overlays/follow_overlay.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

cv::Scalar ColorOf(RegionState state) {
  switch (state) {
    case RegionState::kFollowing:
      return {60, 220, 60};
    case RegionState::kCoasting:
      return {0, 230, 255};
    case RegionState::kLost:
      break;
  }
  return {40, 40, 255};
}

}  // namespace

std::string InWords(const FollowObservation& observation) {
  if (!observation.region) return "not marked yet";
  std::string words = ToString(observation.region->state);
  if (const auto distance_m = observation.distance_m()) {
    words += fmt::format(", {:.1f} m, {:.1f} m/s", *distance_m, observation.target->speed());
  }
  return words;
}

cv::Mat DrawFollowOverlay(const cv::Mat& image, const FollowObservation& observation) {
  cv::Mat drawn = image.clone();
  const double scale = std::clamp(image.cols / 900.0, 0.5, 4.0);
  const int thin = std::max(1, static_cast<int>(scale));
  cv::Scalar color(255, 255, 255);
  cv::Point text(static_cast<int>(8 * scale), static_cast<int>(24 * scale));
  if (observation.region) {
    color = ColorOf(observation.region->state);
    const cv::Rect box = observation.region->box_px;
    cv::rectangle(drawn, box, {0, 0, 0}, 3 * thin, cv::LINE_AA);
    cv::rectangle(drawn, box, color, thin, cv::LINE_AA);
  }
  for (const auto& [thickness, ink] : {std::pair(3, cv::Scalar(0, 0, 0)), std::pair(1, color)}) {
    cv::putText(drawn, InWords(observation), text, cv::FONT_HERSHEY_SIMPLEX, 0.6 * scale, ink,
                thickness * thin, cv::LINE_AA);
  }
  return drawn;
}

}  // namespace kestrel

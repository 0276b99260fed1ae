// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/unlike_views.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

namespace kestrel {
namespace {

// The features in which views differ: place of the print in the image, its distance, its normal.
using ViewFeatures = Eigen::Vector<double, 6>;

ViewFeatures FeaturesOf(const LensView& view, int width_px) {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  for (const LensEdge& edge : view.edges) center += edge.pixel;
  center /= static_cast<double>(view.edges.size()) * width_px;
  const RigidTransform& pose = view.camera_from_target;
  ViewFeatures features;
  features << center, 0.3 * std::log(pose.translation.norm()),
      pose.rotation * Eigen::Vector3d::UnitZ();
  return features;
}

}  // namespace

double DifferenceOf(const LensView& view, const LensView& other, int width_px) {
  return (FeaturesOf(view, width_px) - FeaturesOf(other, width_px)).norm();
}

std::vector<LensView> UnlikeViews(const std::vector<LensView>& views, std::size_t max_views,
                                  int width_px) {
  if (views.size() <= max_views) return views;
  std::vector<ViewFeatures> features;
  for (const LensView& view : views) features.push_back(FeaturesOf(view, width_px));
  std::vector<double> distances(views.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> chosen{0};
  while (chosen.size() < max_views) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      distances[i] = std::min(distances[i], (features[i] - features[chosen.back()]).norm());
    }
    chosen.push_back(std::max_element(distances.begin(), distances.end()) - distances.begin());
  }
  std::sort(chosen.begin(), chosen.end());
  std::vector<LensView> unlike;
  for (const std::size_t index : chosen) unlike.push_back(views[index]);
  return unlike;
}

}  // namespace kestrel

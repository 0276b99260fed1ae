// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/search/plane_borders.h"
#include "kestrel/vision/tags/square_pose.h"

namespace kestrel {

// A border whose sides are straight in space: perhaps the square of a tag.
struct TagQuad {
  SquareCorners corners;
  bool dark_inside;
  double side_px;  // mean length of its sides
};

// Memory of one thread's search for quads.
struct TagQuadBuffers {
  BorderBuffers borders;
  std::vector<TagQuad> quads;  // found by all passes since Begin
  std::size_t examined = 0;    // number of borders of the last pass
};

// Finds quads in the raw image: borders with four straight sides.
class TagQuadFinder {
 public:
  explicit TagQuadFinder(const CameraModel& camera);

  // As of PlaneBorders.
  bool Covers(int pass, double least_px, double most_px) const {
    return borders_.Covers(pass, least_px, most_px);
  }
  void Begin(const cv::Mat& image, const cv::Rect& part, TagQuadBuffers* buffers) const;
  void BeginLinear(const cv::Mat& image, const cv::Rect& part, TagQuadBuffers* buffers) const {
    borders_.BeginLinear(image, part, &buffers->borders);
  }

  // Returns what one pass finds, which is added to 'buffers->quads'.
  std::span<const TagQuad> Find(const cv::Rect& part, int pass, TagQuadBuffers* buffers) const;

 private:
  bool FitQuad(const Border& border, const cv::Rect& part, int pass, BorderBuffers* buffers,
               TagQuad* quad) const;

  PlaneBorders borders_;
  double focal_px_;
};

}  // namespace kestrel

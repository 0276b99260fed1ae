// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/image/border_tracing.h"
#include "kestrel/core/image/local_threshold.h"

namespace kestrel {

// A border whose sides are straight in space: perhaps the square of a tag.
struct TagQuad {
  std::array<Eigen::Vector3d, 4> corners;  // unit rays, clockwise in the image
  bool dark_inside;
  double side_px;  // mean length of its sides
};

// Memory of one thread's search for quads.
struct TagQuadBuffers {
  int width_px = 0;  // size of the image that it was reserved for
  int height_px = 0;
  TilePyramid pyramid;
  LocalThreshold threshold;
  BinaryImage binary;
  BorderTracer tracer;
  std::vector<TagQuad> quads;
  std::size_t borders = 0;  // number of borders that were examined
};

// Finds quads in the raw image. A lens bends lines, so borders are tested as rays: on a plane
// across the ray to their middle a straight edge is straight, however far from the axis.
class TagQuadFinder {
 public:
  static constexpr int kPasses = 4;  // from the image at an eighth, for near tags, to all of it

  explicit TagQuadFinder(const CameraModel& camera)
      : rays_(camera), focal_px_(camera.intrinsics().fx_px) {}

  // Returns whether quads of these extents (px) are among those of a pass.
  static bool Covers(int pass, double least_px, double most_px);

  // Prepares a search of 'part', whole pixels in the image; Find does not allocate afterwards once
  // it has seen an image of this size.
  void Begin(const cv::Mat& image, const cv::Rect& part, TagQuadBuffers* buffers) const;

  // Writes what one pass finds to 'buffers->quads'.
  void Find(const cv::Rect& part, int pass, TagQuadBuffers* buffers) const;

 private:
  // The part of an image at the resolution of a pass.
  struct Level {
    double scale;  // pixels of the image per pixel of the level
    cv::Point origin;
  };
  bool FitQuad(const BorderTracer& tracer, const Border& border, const Level& level,
               TagQuad* quad) const;

  RayTable rays_;
  double focal_px_;
};

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/image/border_tracing.h"
#include "kestrel/core/image/local_threshold.h"
#include "kestrel/vision/helipad/helipad_model.h"

namespace kestrel {

// A border that is an H as far as its moments tell, on the plane across the ray to its middle, at
// distance 1.
struct HelipadCandidate {
  Eigen::Matrix3d camera_from_plane;  // its columns: the plane's axes and that ray
  FigureMoments moments;
};

// Memory of one thread's search for candidates.
struct HelipadCandidateBuffers {
  int width_px = 0;  // size of the image that it was reserved for
  int height_px = 0;
  TilePyramid pyramid;
  LocalThreshold threshold;
  BinaryImage binary;
  BorderTracer tracer;
  std::vector<Eigen::Vector2d> corners;  // of one border, on the plane
  std::vector<HelipadCandidate> candidates;
  std::size_t borders = 0;  // number of borders that were examined
};

class HelipadFinder {
 public:
  static constexpr int kPasses = 4;  // from the image at an eighth, for near pads, to all of it

  // Keeps the model by reference.
  HelipadFinder(const CameraModel& camera, const HelipadModel& model)
      : rays_(camera), model_(model) {}

  // Returns whether figures of these extents (px) are among those of a pass.
  static bool Covers(int pass, double least_px, double most_px);

  // Prepares a search of 'part', whole pixels in the image; Find does not allocate afterwards once
  // it has seen an image of this size.
  void Begin(const cv::Mat& image, const cv::Rect& part, HelipadCandidateBuffers* buffers) const;

  // Writes what one pass finds to 'buffers->candidates'.
  void Find(const cv::Rect& part, int pass, HelipadCandidateBuffers* buffers) const;

 private:
  // The part of an image at the resolution of a pass.
  struct Level {
    double scale;  // pixels of the image per pixel of the level
    cv::Point origin;
  };
  bool Examine(const Border& border, const Level& level, HelipadCandidateBuffers* buffers) const;

  RayTable rays_;
  const HelipadModel& model_;
};

}  // namespace kestrel

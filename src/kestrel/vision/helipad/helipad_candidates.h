// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/helipad/helipad_model.h"
#include "kestrel/vision/search/plane_borders.h"

namespace kestrel {

// A border that is an H or its frame as far as its moments tell, on the plane across the ray to its
// middle, at distance 1.
struct HelipadCandidate {
  Eigen::Matrix3d camera_from_plane;  // its columns: the plane's axes and that ray
  FigureMoments moments;
  const FigureMoments* printed;  // the pad's figure that it may be
};

// Memory of one thread's search for candidates.
struct HelipadCandidateBuffers {
  BorderBuffers borders;
  NarrowBorderBuffers narrow;
  std::vector<HelipadCandidate> candidates;
  std::size_t examined = 0;  // number of borders
};

// Finds borders with the moments of an H, or of all that is within its frame, in the raw image.
class HelipadFinder {
 public:
  // Keeps the model by reference.
  HelipadFinder(const CameraModel& camera, const HelipadModel& model);

  // As of PlaneBorders.
  bool Covers(int pass, double least_px, double most_px) const {
    return borders_.Covers(pass, least_px, most_px);
  }
  void Begin(const cv::Mat& image, const cv::Rect& part, HelipadCandidateBuffers* buffers) const;
  void BeginLinear(const cv::Mat& image, const cv::Rect& part,
                   HelipadCandidateBuffers* buffers) const {
    borders_.BeginLinear(image, part, &buffers->borders);
  }

  // Writes what one pass finds to 'buffers->candidates'.
  void Find(const cv::Rect& part, int pass, HelipadCandidateBuffers* buffers) const;

  // The same for strokes across which the edge of a shadow may run.
  void FindNarrow(const cv::Rect& part, int pass, HelipadCandidateBuffers* buffers) const;

 private:
  // Adds those of the borders, in pixels of a level, that are candidates.
  void Add(std::span<const Border> borders, bool around_ink, const cv::Rect& part, int level,
           HelipadCandidateBuffers* buffers) const;
  bool Examine(const Border& border, const cv::Rect& part, int level, BorderBuffers* buffers,
               HelipadCandidate* candidate) const;

  PlaneBorders borders_;
  const HelipadModel& model_;
};

}  // namespace kestrel

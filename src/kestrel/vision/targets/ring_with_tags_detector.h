// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/tags/tag_board.h"
#include "kestrel/vision/tags/tag_board_detector.h"
#include "kestrel/vision/target/target_detector.h"

namespace kestrel {

// Returns the shape of the ring with the tags of a valid board.
TargetShape ShapeOf(const LandingPattern& ring, const TagBoard& board);

// Finds the ring with a cross whose board also has tags, in the ring's frame.
//
// The ring is found as by LandingPatternDetector. At its pose the cells of the tags are read in the
// four headings under which the ring looks the same. Tags that are read tell the heading and which
// pad it is; the pose is the ring's. A ring without readable tags is reported as the ring's
// detector reports it. A ring that has another tag of the same family clearly in a tag's place is
// another pad: it is not reported. Where no ring of this pad is found, the tags are searched for by
// themselves: near the pad the ring is out of view.
class RingWithTagsDetector final : public TargetDetector {
 public:
  // Throws InputError when the camera, the board or the options are not valid.
  RingWithTagsDetector(const CameraModel& camera, const LandingPatternDetectorOptions& ring,
                       const TagBoard& board, const TagBoardDetectorOptions& tags);
  ~RingWithTagsDetector() override;
  RingWithTagsDetector(RingWithTagsDetector&&) noexcept;
  RingWithTagsDetector& operator=(RingWithTagsDetector&&) noexcept;

  // As of TargetDetector. The detection's id is that of the board's first tag.
  using TargetDetector::Detect;
  TargetReport Detect(const cv::Mat& image, const TargetHint& hint,
                      TargetWorkspace& workspace) const override;
  std::unique_ptr<TargetWorkspace> MakeWorkspace() const override;
  const CameraModel& camera() const override;
  const TargetShape& shape() const override;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/tags/tag_board.h"
#include "kestrel/vision/target/target_detector.h"

namespace kestrel {

struct TagBoardDetectorOptions {
  double min_quality = 0.7;
  double level_sigma_deg = 3;

  static void Visit(auto& self, auto&& visit) {
    visit("min_quality", self.min_quality, Range{0, 1},
          "smallest accepted probability of the board");
    visit("level_sigma_deg", self.level_sigma_deg, MoreThan(0),
          "tilt from level, standard deviation");
  }
};

// Returns the shape of a board: the squares of its tags, the largest first. The board must be
// valid.
TargetShape ShapeOf(const TagBoard& board);

// Finds a board of AprilTags and ArUco markers in the raw image of any lens.
//
// Borders of the image whose sides are straight in space may be tags: their cells are sampled along
// rays and held against the bits of the board's tags. From one tag all edges between black and
// white cells of all tags in view give the pose, by least squares in the image. Where the hint has
// the orientation, the board is first looked for by its appearance at the expected place, which
// works on a part of a tag as well.
//
// Does not decode other tags than the board's. libapriltag gives the bits of its families
// at construction; the search itself does not use it, so it does not allocate.
class TagBoardDetector final : public TargetDetector {
 public:
  // Throws InputError when the board, the options or the camera are not valid.
  TagBoardDetector(const CameraModel& camera, const TagBoard& board,
                   const TagBoardDetectorOptions& options);
  ~TagBoardDetector() override;
  TagBoardDetector(TagBoardDetector&&) noexcept;
  TagBoardDetector& operator=(TagBoardDetector&&) noexcept;

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

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/search/pad_samples.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/tag_board.h"
#include "kestrel/vision/target/target_detection.h"

namespace kestrel {

// Logarithm of the odds against a board where it is expected.
inline constexpr double kExpectedOdds = 4;

// Result of reading a board's tags at a pose.
struct BoardReading {
  double evidence = 0;  // natural logarithm of how much likelier the tags are than other bits
  SeenParts parts;      // the tags that are read; SeenPart::tag is the index on the board
};

// Reads the cells of all tags at a pose. A tag counts when its evidence is positive and no more of
// its bits are wrong than may be misread. 'samples': room for the cells of a tag. Does not
// allocate.
BoardReading ReadBoard(const cv::Mat& image, const CameraModel& camera, const BoardModel& board,
                       const RigidTransform& camera_from_board, PadSamples* samples,
                       DimSample dim = DimSample::kWrong);

// The tags that another board of the same layout may have: those of the same families whose ids
// are not on the board.
class OtherTags {
 public:
  // 'board' must be valid.
  explicit OtherTags(const TagBoard& board);

  // Returns whether another tag is read clearly at the place of a tag of the board that is not
  // among 'read': all its bits are in view, no more of them are wrong than may be misread, and they
  // are much likelier than those of the board's tag. 'board': that of the constructor. Does not
  // allocate.
  bool IsRead(const cv::Mat& image, const CameraModel& camera, const BoardModel& board,
              const RigidTransform& camera_from_board, const SeenParts& read,
              PadSamples* samples) const;

 private:
  std::vector<std::vector<TagGrid>> grids_;  // what the other tags have, for each tag of the board
};

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/board_samples.h"
#include "kestrel/vision/tags/tag_quads.h"

namespace kestrel {

// A tag that a quad may be.
struct TagMatch {
  const TagModel* tag;
  RigidTransform camera_from_board;  // by the corners of the quad alone
};

// Returns the tag of the board whose bits are most like what a quad shows, in the best of four
// turns; nothing when none is. 'samples': room for the cells of a tag. Does not allocate.
std::optional<TagMatch> MatchTag(const cv::Mat& image, const CameraModel& camera,
                                 const BoardModel& board, const TagQuad& quad,
                                 BoardSamples* samples);

}  // namespace kestrel

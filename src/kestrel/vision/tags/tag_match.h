// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/search/pad_samples.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/tag_quads.h"

namespace kestrel {

// A tag that a quad may be.
struct TagMatch {
  const TagModel* tag;
  RigidTransform camera_from_board;  // by the corners of the quad alone
};

// Returns the index, in the grid of a quad, of a tag's cell when the tag's first corner is the
// quad's corner 'turn' (0 to 3), clockwise. 'width': of the grid.
int TurnedIndex(int column, int row, int turn, int width);

// Returns the gray values of the cells of 'grid' if a quad of mean side 'side_px' is its square;
// negative out of view. 'homography': of the quad's corners, which it meets exactly; a pose does
// not, for a small quad or a lens that is not quite as described.
std::span<const float> ReadQuad(const cv::Mat& image, const CameraModel& camera,
                                const Eigen::Matrix3d& homography, double side_px,
                                const TagGrid& grid, PadSamples* samples);

// Returns the tag of the board whose bits are most like what a quad shows, in the best of four
// turns; nothing when none is. 'samples': room for the cells of a tag. Does not allocate.
std::optional<TagMatch> MatchTag(const cv::Mat& image, const CameraModel& camera,
                                 const BoardModel& board, const TagQuad& quad, PadSamples* samples);

}  // namespace kestrel

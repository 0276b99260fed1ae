// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/lens/lens_board.h"
#include "kestrel/calibration/lens/lens_view.h"
#include "kestrel/core/camera/camera_model.h"

namespace kestrel {

// Finds the board in an image (CV_8UC1) of a lens that is not known yet. Of a ChArUco board and an
// AprilGrid a part is enough, a chessboard must be whole. Each corner is two edges of the view. The
// pose is by the lens 'guess'. Returns nothing when too little of the board is found.
std::optional<LensView> FindBoard(const std::string& name, const cv::Mat& image,
                                  const LensBoard& board, const CameraIntrinsics& guess);

// Returns the views of a board with their poses by this lens, without those that it does not show.
std::vector<LensView> PosedBy(const CameraIntrinsics& lens, std::span<const LensView> views);

// Returns the lens, of several, by which views of a board are most like a plane.
CameraIntrinsics LikeliestLens(std::span<const CameraIntrinsics> lenses,
                               std::span<const LensView> views);

}  // namespace kestrel

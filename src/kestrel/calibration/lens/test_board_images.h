// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/calibration/lens/lens_board.h"
#include "kestrel/calibration/lens/lens_calibration.h"
#include "kestrel/core/base/random.h"
#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {

// True where squares of a checkered board are black, with its upper left square black unless
// 'begins_white'. 'columns', 'rows': of squares.
inline bool IsBlackSquare(double x, double y, int columns, int rows, double side_m,
                          bool begins_white) {
  const double column = std::floor(x / side_m + 0.5 * columns);
  const double row = std::floor(0.5 * rows - y / side_m);
  if (column < 0 || row < 0 || column >= columns || row >= rows) return false;
  return (static_cast<int>(column + row) % 2 == 0) != begins_white;
}

// The print of a board as its makers describe it. The squares beside an AprilGrid's tags touch
// their corners.
inline Print BoardPrint(const LensBoard& board) {
  const std::vector<PrintedTag> tags = board.Tags().Printed();
  const Eigen::Vector2d size = board.Size();
  return [=](double x, double y) {
    for (const PrintedTag& tag : tags) {
      const double column = (x - tag.center.x()) / tag.cell_m + 0.5 * tag.grid.width;
      const double row = 0.5 * tag.grid.width - (y - tag.center.y()) / tag.cell_m;
      if (column < 0 || row < 0 || column >= tag.grid.width || row >= tag.grid.width) continue;
      const TagCell cell = tag.grid.at(static_cast<int>(column), static_cast<int>(row));
      if (cell == TagCell::kBlack) return true;
    }
    if (board.kind == LensBoardKind::kAprilGrid) {
      const double step = board.side_m * (1 + board.gap);
      const double gap = board.side_m * board.gap;
      const double across = x + 0.5 * size.x(), up = y + 0.5 * size.y();
      return across >= 0 && up >= 0 && across < size.x() && up < size.y() &&
             std::fmod(across, step) < gap && std::fmod(up, step) < gap;
    }
    const int more = board.kind == LensBoardKind::kChessboard ? 1 : 0;
    return IsBlackSquare(x, y, board.columns + more, board.rows + more, board.side_m,
                         board.begins_white);
  };
}

// Renders views of a board from random places, as a person shows it to a camera: 'reach': how far
// from the middle of the image its middle is, in halves of the image.
inline std::vector<LensImage> RenderBoard(const CameraModel& camera, const LensBoard& board,
                                          int count, double reach, std::uint64_t seed) {
  LandingPattern sheet;
  sheet.board_size_m = 1.15 * board.Size().maxCoeff();
  const Print print = BoardPrint(board);
  Random random(seed);
  std::vector<LensImage> images;
  for (int i = 0; i < count; ++i) {
    const CameraIntrinsics& lens = camera.intrinsics();
    Eigen::Vector3d ray;
    camera.Unproject({0.5 * lens.width_px * (1 + random.Uniform(-reach, reach)),
                      0.5 * lens.height_px * (1 + random.Uniform(-reach, reach))},
                     &ray);
    const double distance =
        random.Uniform(1.3, 2.2) * board.Size().maxCoeff() * lens.fx_px / lens.width_px;
    const RigidTransform pose = PrintPose(distance * ray, random.Uniform(0, 0.7),
                                          random.Uniform(-3, 3), random.Uniform(-0.4, 0.4));
    const cv::Mat image = DrawPrint(camera, sheet, print, pose);
    images.push_back({"view " + std::to_string(i), AddNoise(image, 2, &random)});
  }
  return images;
}

}  // namespace kestrel

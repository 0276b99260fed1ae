// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/target/landing_detection.h"

namespace kestrel {

// Smaller cells in the image are not looked at.
inline constexpr double kLeastCellPx = 1;

// Points of a board, their places in the image and gray values there. Memory that is kept.
class BoardSamples {
 public:
  void Reserve(std::size_t most);

  void Clear() { count_ = 0; }
  // Adds a point in the camera frame. There must be room.
  void Add(const Eigen::Vector3d& point_in_camera);

  // Computes the places of all points; NaN where the lens does not see them.
  void Project(const CameraModel& camera);
  // Reads the gray values at the places, moved by (dx, dy) px; negative outside of the image.
  std::span<const float> Read(const cv::Mat& image, float dx = 0, float dy = 0);
  // The same where the points are the cells of a grid, row by row, of 'cell_px' each: small cells
  // are sharpened, because lens and pixels mix them with their neighbours.
  std::span<const float> ReadCells(const cv::Mat& image, int grid_width, double cell_px);

  std::size_t count() const { return count_; }
  float u(std::size_t i) const { return u_[i]; }
  float v(std::size_t i) const { return v_[i]; }

 private:
  std::size_t count_ = 0;
  std::vector<float> x_, y_, z_, u_, v_, moved_u_, moved_v_, gray_;
};

// Side of a tag's cell in the image across its shorter direction, px, as far as its distance and
// slant tell. 0 when its face is turned away.
double CellPx(const CameraModel& camera, const RigidTransform& camera_from_board,
              const TagModel& tag);

// Returns the mean of the bright samples minus that of the dark ones, over the spread of all: how
// much gray values, negative where out of view, look like a print. 'color' of a sample's index: 1
// bright, 0 dark, -1 neither. Negative when few are in view.
template <class Color>
double Likeness(std::span<const float> gray, const Color& color) {
  constexpr int kFewest = 4;
  double sum[2] = {0, 0}, squares = 0;
  int count[2] = {0, 0};
  for (std::size_t i = 0; i < gray.size(); ++i) {
    const int here = color(i);
    if (here < 0 || gray[i] < 0) continue;
    sum[here] += gray[i];
    squares += gray[i] * gray[i];
    ++count[here];
  }
  if (count[0] < kFewest || count[1] < kFewest) return -1;
  const int all = count[0] + count[1];
  const double mean = (sum[0] + sum[1]) / all;
  const double spread = std::sqrt(std::max(1.0, squares / all - mean * mean));
  return (sum[1] / count[1] - sum[0] / count[0]) / spread;
}

// Agreement of the gray values of a tag's cells with its bits.
struct TagAgreement {
  double evidence = 0;  // natural logarithm of how much likelier the tag is than other bits
  int seen = 0;         // number of data cells in view
  int wrong = 0;        // of them, those that look like the other colour
};

// Returns how much a data cell of a tag tells (nats): the length of the shortest description of its
// picture, by the share of vertices that are corners or by its straight edges, over its data cells.
// A stripe, a block or a letter tells little, however many cells it has, because windows and prints
// show them as well; so does a checker. At most log 2, for a picture at random.
double CellInformation(const TagGrid& grid, const std::vector<bool>& is_data);

// Meaning of a sample of a print with less contrast than usual, but clear contrast: a white cell
// darker than the white around it, and lighter than the black. On a pad that is followed it is in a
// shadow; in a search another print is as likely.
enum class DimSample { kWrong, kUnknown };
inline DimSample DimSampleIn(DetectionMethod method) {
  return method == DetectionMethod::kFollowed ? DimSample::kUnknown : DimSample::kWrong;
}

// Compares gray values of all cells of a tag, of 'cell_px' each and negative where out of view,
// with its bits. A cell is held against the white and the black cells around it, so that the edge
// of a shadow over the tag does not matter. A match counts by CellInformation, less where the cells
// are so small that lens and pixels make them alike.
TagAgreement CompareCells(const TagModel& tag, double cell_px, std::span<const float> gray,
                          DimSample dim = DimSample::kWrong);
// The same for a tag of these cells. 'is_data': as TagModel's.
TagAgreement CompareCells(const TagGrid& grid, const std::vector<bool>& is_data, double cell_px,
                          std::span<const float> gray, DimSample dim = DimSample::kWrong);

}  // namespace kestrel

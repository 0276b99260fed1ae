// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/board_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kestrel/core/image/gray_sampling.h"

namespace kestrel {
namespace {

constexpr int kNeighbors = 2;             // cells around a cell that it is held against
constexpr double kLeastCellContrast = 5;  // gray values, between white and black cells

// Sums over the cells of one colour.
struct ColorSum {
  double gray = 0, log = 0;
  int count = 0;
};

// Returns the place of a gray value between those of the cells of the other colour (-1) and of its
// own colour (1).
double PlaceBetween(double value, double black, double white, bool is_white) {
  const double place = (value - 0.5 * (white + black)) / (0.5 * (white - black));
  return std::clamp(is_white ? place : -place, -1.0, 1.0);
}

// Returns the place of a cell's gray value between those of the cells around it of the other colour
// (-1) and of its own colour (1); 0 where there are none. Lens and pixels mix gray values, a shadow
// multiplies them: of the places by gray values and by their logarithms the better one counts.
double CellAgreement(const TagGrid& grid, std::span<const float> gray, std::span<const float> log,
                     int column, int row) {
  ColorSum sums[2];  // of black and of white cells
  for (int y = std::max(0, row - kNeighbors); y <= std::min(grid.width - 1, row + kNeighbors);
       ++y) {
    for (int x = std::max(0, column - kNeighbors);
         x <= std::min(grid.width - 1, column + kNeighbors); ++x) {
      const int i = y * grid.width + x;
      if (grid.cells[i] == TagCell::kNone || gray[i] < 0 || (x == column && y == row)) continue;
      ColorSum& sum = sums[grid.cells[i] == TagCell::kWhite];
      sum.gray += gray[i];
      sum.log += log[i];
      ++sum.count;
    }
  }
  const auto& [black, white] = sums;
  if (black.count == 0 || white.count == 0) return 0;
  if (white.gray / white.count - black.gray / black.count < kLeastCellContrast) return -1;
  const int i = row * grid.width + column;
  const bool is_white = grid.cells[i] == TagCell::kWhite;
  const double by_gray =
      PlaceBetween(gray[i], black.gray / black.count, white.gray / white.count, is_white);
  const double log_contrast = white.log / white.count - black.log / black.count;
  if (!(log_contrast > 0)) return by_gray;
  return std::max(by_gray,
                  PlaceBetween(log[i], black.log / black.count, white.log / white.count, is_white));
}

// A clear match is one bit; a clear mismatch weighs more, as print and light are seldom that wrong.
double CellEvidence(double agreement) {
  constexpr double kMismatch = 3;
  constexpr double kClear = 0.5;
  const double clearness = std::min(1.0, std::abs(agreement) / kClear);
  return agreement > 0 ? std::numbers::ln2 * clearness : -kMismatch * clearness;
}

}  // namespace

void BoardSamples::Reserve(std::size_t most) {
  for (std::vector<float>* column : {&x_, &y_, &z_, &u_, &v_, &moved_u_, &moved_v_, &gray_}) {
    if (column->size() < most) column->resize(most);
  }
}

void BoardSamples::Add(const Eigen::Vector3d& point_in_camera) {
  x_[count_] = static_cast<float>(point_in_camera.x());
  y_[count_] = static_cast<float>(point_in_camera.y());
  z_[count_] = static_cast<float>(point_in_camera.z());
  ++count_;
}

void BoardSamples::Project(const CameraModel& camera) {
  camera.ProjectMany({x_.data(), y_.data(), z_.data()}, count_, u_.data(), v_.data());
}

std::span<const float> BoardSamples::Read(const cv::Mat& image, float dx, float dy) {
  for (std::size_t i = 0; i < count_; ++i) {
    moved_u_[i] = u_[i] + dx;
    moved_v_[i] = v_[i] + dy;
  }
  SampleGrays(image, moved_u_.data(), moved_v_.data(), count_, gray_.data());
  return {gray_.data(), count_};
}

std::span<const float> BoardSamples::ReadCells(const cv::Mat& image, int grid_width,
                                               double cell_px) {
  const std::span<const float> blurred = Read(image);
  // A blur by 'kBlurPx', undone to first order and then some: the series goes on.
  constexpr double kBlurPx = 0.8;
  constexpr double kMost = 0.5;
  const auto share = static_cast<float>(std::min(kMost, kBlurPx * kBlurPx / (cell_px * cell_px)));
  std::vector<float>& sharp = moved_u_;
  for (std::size_t i = 0; i < count_; ++i) {
    const int column = static_cast<int>(i) % grid_width;
    const int row = static_cast<int>(i) / grid_width;
    float excess = 0;  // over the neighbours
    const auto add = [&](int x, int y) {
      if (x < 0 || y < 0 || x >= grid_width || y >= grid_width) return;
      const float neighbor = blurred[y * grid_width + x];
      if (neighbor >= 0) excess += blurred[i] - neighbor;
    };
    add(column - 1, row);
    add(column + 1, row);
    add(column, row - 1);
    add(column, row + 1);
    sharp[i] = blurred[i] < 0 ? blurred[i] : std::max(0.0f, blurred[i] + share * excess);
  }
  return {sharp.data(), count_};
}

double CellPx(const CameraModel& camera, const RigidTransform& camera_from_board,
              const TagModel& tag) {
  const Eigen::Vector2d& middle = tag.printed.center;
  const Eigen::Vector3d place = camera_from_board * Eigen::Vector3d(middle.x(), middle.y(), 0);
  const Eigen::Vector3d face = camera_from_board.rotation * Eigen::Vector3d::UnitZ();
  const double distance = place.norm();
  const double slant = -face.dot(place) / distance;
  return std::max(0.0, slant) * camera.intrinsics().fx_px * tag.printed.cell_m / distance;
}

TagAgreement CompareCells(const TagModel& tag, std::span<const float> gray) {
  return CompareCells(tag.grid(), tag.is_data, gray);
}

TagAgreement CompareCells(const TagGrid& grid, const std::vector<bool>& is_data,
                          std::span<const float> gray) {
  constexpr double kBorderWeight = 0.1;    // border cells are alike in all tags and in windows
  constexpr std::size_t kMostCells = 256;  // no family has more
  constexpr float kFloor = 4;              // gray values: what darkness and noise leave
  std::array<float, kMostCells> log;
  for (std::size_t i = 0; i < std::min(gray.size(), kMostCells); ++i) {
    log[i] = std::log(std::max(0.0f, gray[i]) + kFloor);
  }
  TagAgreement agreement;
  for (int row = 0; row < grid.width; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const int i = row * grid.width + column;
      if (grid.cells[i] == TagCell::kNone || gray[i] < 0) continue;
      const double here = CellAgreement(grid, gray, log, column, row);
      agreement.evidence += (is_data[i] ? 1 : kBorderWeight) * CellEvidence(here);
      if (!is_data[i]) continue;
      ++agreement.seen;
      agreement.wrong += here < 0;
    }
  }
  return agreement;
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/image_turn.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

constexpr int kFinest_px = 160;  // width; each coarser level has half of it
constexpr int kFinestStep_px = 4;
constexpr int kLighter = 3, kGrowth = 4;  // indices in a Turn

// Returns the gray value between the pixels; NaN outside of the image.
float GrayAt(const cv::Mat& image, const Eigen::Vector2f& at) {
  const auto x = static_cast<int>(std::floor(at.x()));
  const auto y = static_cast<int>(std::floor(at.y()));
  if (x < 0 || y < 0 || x + 1 >= image.cols || y + 1 >= image.rows) return NAN;
  const float right = at.x() - static_cast<float>(x);
  const float down = at.y() - static_cast<float>(y);
  const float* above = image.ptr<float>(y) + x;
  const float* below = image.ptr<float>(y + 1) + x;
  return (1 - down) * ((1 - right) * above[0] + right * above[1]) +
         down * ((1 - right) * below[0] + right * below[1]);
}

}  // namespace

ImageTurn::Level ImageTurn::MakeLevel(const CameraModel& camera, int width_px, int step_px) {
  const double scale = static_cast<double>(camera.width_px()) / width_px;
  Level level;
  level.before.create(cvRound(camera.height_px() / scale), width_px, CV_32FC1);
  level.now.create(level.before.size(), CV_32FC1);
  for (int y = 1; y + 1 < level.before.rows; y += step_px) {
    for (int x = 1; x + 1 < level.before.cols; x += step_px) {
      const Eigen::Vector2d pixel(scale * (x + 0.5) - 0.5, scale * (y + 0.5) - 0.5);
      Eigen::Vector3d ray;
      Eigen::Vector2d again;
      Eigen::Matrix<double, 2, 3> slope;
      if (camera.Unproject(pixel, &ray) == ProjectionStatus::kOutsideModel) continue;
      if (camera.Project(ray, &again, &slope) == ProjectionStatus::kOutsideModel) continue;
      // When the camera turns by r, a ray turns by ray x r.
      Eigen::Matrix3d cross;
      cross << 0, -ray.z(), ray.y(), ray.z(), 0, -ray.x(), -ray.y(), ray.x(), 0;
      level.samples.push_back({x, y, (slope * cross / scale).cast<float>()});
    }
  }
  return level;
}

ImageTurn::ImageTurn(const CameraIntrinsics& camera, bool may_zoom) : may_zoom_(may_zoom) {
  const CameraModel model(camera);
  int width_px = std::min(kFinest_px, camera.width_px);
  int step_px = kFinestStep_px;
  for (Level& level : levels_) {
    level = MakeLevel(model, width_px, step_px);
    width_px /= 2;
    step_px /= 2;
  }
}

bool ImageTurn::Fit(const Level& level, Turn* turn) const {
  constexpr int kIterations = 6;
  constexpr float kOutlier = 20;           // gray levels, of what moves by itself
  constexpr float kMostUnexplained = 0.3;  // share of the contrast
  constexpr float kLeastContrast = 4;      // mean square; less is noise
  float contrast = 0;
  float unexplained = 0;
  float weights = 0;
  const auto mean = static_cast<float>(cv::mean(level.before)[0]);
  const Eigen::Vector2f middle(0.5F * level.before.cols, 0.5F * level.before.rows);
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix<float, 5, 5> normal = Eigen::Matrix<float, 5, 5>::Zero();
    Turn right = Turn::Zero();
    contrast = unexplained = weights = 0;
    for (const Sample& sample : level.samples) {
      const Eigen::Vector3f rotation = turn->head<3>();
      const Eigen::Vector2f place(sample.x, sample.y);
      const Eigen::Vector2f at =
          place + sample.shift_of_turn * rotation + (*turn)[kGrowth] * (place - middle);
      const float before = level.before.at<float>(sample.y, sample.x);
      const float difference = GrayAt(level.now, at) - before - (*turn)[kLighter];
      if (std::isnan(difference)) continue;
      const float slope_x = level.slope_x.at<float>(sample.y, sample.x);
      const float slope_y = level.slope_y.at<float>(sample.y, sample.x);
      Turn row = Turn::Constant(-1);
      for (int axis = 0; axis < 3; ++axis) {
        row[axis] =
            sample.shift_of_turn(0, axis) * slope_x + sample.shift_of_turn(1, axis) * slope_y;
      }
      row[kGrowth] = 0;
      if (may_zoom_) row[kGrowth] = (place - middle).dot(Eigen::Vector2f(slope_x, slope_y));
      const float weight = 1 / (1 + difference * difference / (kOutlier * kOutlier));
      normal += weight * row * row.transpose();
      right += weight * difference * row;
      contrast += weight * (before - mean) * (before - mean);
      unexplained += weight * difference * difference;
      weights += weight;
    }
    if (!may_zoom_) normal(kGrowth, kGrowth) = 1;
    const Turn step = normal.ldlt().solve(right);
    if (!step.allFinite()) return false;
    *turn -= step;
  }
  // An image that has become larger shows less of the one before.
  const float factor = std::max(1.0F, 1 + (*turn)[kGrowth]);
  return weights > 0.3F / (factor * factor) * static_cast<float>(level.samples.size()) &&
         contrast > kLeastContrast * weights && unexplained < kMostUnexplained * contrast;
}

bool ImageTurn::FitAll(Turn* turn) const {
  bool is_good = false;
  for (std::size_t i = levels_.size(); i-- > 0;) is_good = Fit(levels_[i], turn);
  return is_good;
}

// Tries factors so close together that the coarsest image leads from one of them to the true one.
bool ImageTurn::FitZoom(Turn* turn) const {
  constexpr float kStep = 1.2F;
  constexpr int kSteps = 6;
  float factor = 1;
  for (int i = 0; i < kSteps; ++i) {
    factor *= kStep;
    for (const float start : {factor, 1 / factor}) {
      *turn = Turn::Zero();
      (*turn)[kGrowth] = start - 1;
      if (Fit(levels_.back(), turn) && FitAll(turn)) return true;
    }
  }
  return false;
}

std::optional<Eigen::Vector3d> ImageTurn::Add(const cv::Mat& image) {
  constexpr double kSobel = 1.0 / 8;  // the operator's gain
  const cv::Mat* gray = &image;
  if (image.channels() == 3) {
    cv::cvtColor(image, gray_, cv::COLOR_BGR2GRAY);
    gray = &gray_;
  }
  for (Level& level : levels_) {
    cv::swap(level.before, level.now);
    cv::resize(*gray, small_, level.now.size(), 0, 0, cv::INTER_AREA);
    small_.convertTo(level.now, CV_32F);
    cv::Sobel(level.before, level.slope_x, CV_32F, 1, 0, 3, kSobel);
    cv::Sobel(level.before, level.slope_y, CV_32F, 0, 1, 3, kSobel);
  }
  if (!std::exchange(has_before_, true)) return std::nullopt;
  Turn turn = Turn::Zero();
  if (!FitAll(&turn) && !(may_zoom_ && FitZoom(&turn))) return std::nullopt;
  scale_ = 1 + turn[kGrowth];
  return turn.head<3>().cast<double>();
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/overlays/map_inset.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

const cv::Scalar kPaper(245, 245, 245);
const cv::Scalar kInk(40, 40, 40);
constexpr int kScaleHeight_px = 24;

// Maps metres in the world to pixels of the inset.
class Plan {
 public:
  Plan(const Eigen::AlignedBox2d& area, const cv::Rect& frame) : area_(area), frame_(frame) {
    constexpr double kMargin_px = 16;
    const Eigen::Vector2d room(frame.width - 2 * kMargin_px, frame.height - 2 * kMargin_px);
    per_m_ = (room.array() / area.sizes().array()).minCoeff();
  }

  cv::Point At(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d offset = per_m_ * (point - area_.center());
    return {frame_.x + frame_.width / 2 + static_cast<int>(std::lround(offset.x())),
            frame_.y + frame_.height / 2 - static_cast<int>(std::lround(offset.y()))};
  }
  double per_m() const { return per_m_; }

 private:
  Eigen::AlignedBox2d area_;
  cv::Rect frame_;
  double per_m_;
};

Eigen::AlignedBox2d AreaOf(const std::vector<MappedObject>& objects,
                           const std::optional<Eigen::Vector2d>& uav) {
  constexpr double kMinHalfSide_m = 2;
  Eigen::AlignedBox2d area;
  for (const MappedObject& object : objects) {
    area.extend(Eigen::Vector2d(object.position().head<2>()));
  }
  if (uav) area.extend(*uav);
  const Eigen::Vector2d center = area.center();
  area.extend(Eigen::Vector2d(center.array() - kMinHalfSide_m));
  area.extend(Eigen::Vector2d(center.array() + kMinHalfSide_m));
  return area;
}

cv::Scalar ColorOf(const MappedObject& object) {
  const Hsv& color = object.color;
  const cv::Mat3f hsv(1, 1, cv::Vec3f(color.hue_deg, color.saturation, color.value));
  cv::Mat3f bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  return cv::Scalar(bgr(0, 0)) * 255;
}

void DrawObject(const Plan& plan, const MappedObject& object, const ObjectModel& model,
                cv::Mat* image) {
  constexpr double kMinRadius_px = 4;
  constexpr double kMaxRadius_px = 12;
  const Eigen::Vector2d position = object.position().head<2>();
  const cv::Point at = plan.At(position);
  const double radius_px =
      std::clamp(plan.per_m() * object.sigma_m(), kMinRadius_px, kMaxRadius_px);
  if (object.may_move) {
    const Eigen::Vector2d next = position + object.velocity().head<2>();
    cv::line(*image, at, plan.At(next), kInk, 1, cv::LINE_AA);
  }
  cv::circle(*image, at, static_cast<int>(std::lround(radius_px)), ColorOf(object), cv::FILLED,
             cv::LINE_AA);
  cv::circle(*image, at, static_cast<int>(std::lround(radius_px)), kInk, 1, cv::LINE_AA);
  cv::putText(*image, fmt::format("{:g}", ScoreOf(object, model)), at + cv::Point(7, 4),
              cv::FONT_HERSHEY_SIMPLEX, 0.35, kInk, 1, cv::LINE_AA);
}

// Draws a bar of 1, 2, 5, 10 ... m.
void DrawScale(const Plan& plan, const cv::Rect& frame, cv::Mat* image) {
  const double wanted_m = 0.25 * frame.width / plan.per_m();
  const double power = std::pow(10, std::floor(std::log10(wanted_m)));
  const double length_m = power * (wanted_m >= 5 * power ? 5 : wanted_m >= 2 * power ? 2 : 1);
  const cv::Point start(frame.x + 8, frame.y + frame.height - 8);
  cv::line(*image, start, start + cv::Point(static_cast<int>(plan.per_m() * length_m), 0), kInk, 2);
  cv::putText(*image, fmt::format("{:g} m", length_m), start - cv::Point(0, 5),
              cv::FONT_HERSHEY_SIMPLEX, 0.35, kInk, 1, cv::LINE_AA);
}

// Returns the frame of the inset, in the corner where it covers least of 'seen'.
cv::Rect InsetFrame(const cv::Size& image, const std::vector<cv::Rect>& seen) {
  constexpr double kShare = 0.28;  // share of the image's width
  constexpr double kAspect = 0.7;
  const auto width = static_cast<int>(kShare * image.width);
  const int height = std::min(static_cast<int>(kAspect * width), image.height);
  const int right = image.width - width, bottom = image.height - height;
  const std::array<cv::Rect, 4> corners = {
      cv::Rect(right, bottom, width, height), cv::Rect(0, bottom, width, height),
      cv::Rect(right, 0, width, height), cv::Rect(0, 0, width, height)};
  const auto covered = [&](const cv::Rect& corner) {
    int area = 0;
    for (const cv::Rect& box : seen) area += (box & corner).area();
    return area;
  };
  return *std::min_element(corners.begin(), corners.end(),
                           [&](const auto& a, const auto& b) { return covered(a) < covered(b); });
}

}  // namespace

void DrawMapInset(const std::vector<MappedObject>& objects, const ObjectModel& model,
                  const std::optional<Eigen::Vector2d>& uav, const std::vector<cv::Rect>& seen,
                  cv::Mat* image) {
  if (objects.empty()) return;
  const cv::Rect frame = InsetFrame(image->size(), seen);
  cv::Mat inset = (*image)(frame);
  cv::addWeighted(inset, 0.2, cv::Mat(inset.size(), inset.type(), kPaper), 0.8, 0, inset);
  cv::rectangle(*image, frame, kInk);
  // The scale lies below the plan.
  const cv::Rect plan_frame(frame.x, frame.y, frame.width, frame.height - kScaleHeight_px);
  const Plan plan(AreaOf(objects, uav), plan_frame);
  for (const MappedObject& object : objects) DrawObject(plan, object, model, image);
  if (uav) cv::drawMarker(*image, plan.At(*uav), kInk, cv::MARKER_TILTED_CROSS, 10, 2, cv::LINE_AA);
  DrawScale(plan, frame, image);
}

}  // namespace kestrel

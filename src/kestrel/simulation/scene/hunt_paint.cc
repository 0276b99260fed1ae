// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/hunt_paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

constexpr int kPaint_px = 128;

Color ColorOf(const std::string& name) {
  if (name == "red") return {0.025, 0.02, 0.5};
  if (name == "green") return {0.03, 0.36, 0.08};
  if (name == "blue") return {0.5, 0.12, 0.015};
  if (name == "yellow") return {0.02, 0.55, 0.7};
  return {0.01, 0.2, 0.7};  // orange
}

SquarePaint MakePaint(double fading, const std::string& color, Random* random) {
  const Color fresh = ColorOf(color) * random->Uniform(0.75, 1.2);
  const Color bleached = fresh + fading * (Gray(0.55) - fresh);
  SquarePaint paint(kPaint_px, 1, bleached.cwiseMin(1.0));
  paint.Soil(random->Uniform(0.02, 0.12), random->Bits());
  return paint;
}

// Hershey fonts other than DUPLEX and COMPLEX: those two are for training the reader of digits,
// which is thereby tested on unseen digits.
constexpr std::array<int, 5> kFonts = {
    cv::FONT_HERSHEY_SIMPLEX, cv::FONT_HERSHEY_TRIPLEX, cv::FONT_HERSHEY_PLAIN,
    cv::FONT_HERSHEY_SIMPLEX | cv::FONT_ITALIC, cv::FONT_HERSHEY_TRIPLEX | cv::FONT_ITALIC};

void PutDigit(int digit, Random* random, cv::Mat* codes) {
  const int font = kFonts[random->Integer(0, kFonts.size() - 1)];
  const std::string text = std::to_string(digit);
  const int stroke = random->Integer(7, 11);
  const double height = kPaint_px * random->Uniform(0.55, 0.72);
  int baseline = 0;
  const cv::Size unit = cv::getTextSize(text, font, 1, 1, &baseline);
  const double scale = (height - stroke) / unit.height;
  const cv::Size size = cv::getTextSize(text, font, scale, stroke, &baseline);
  const cv::Point lower_left((kPaint_px - size.width) / 2, (kPaint_px + size.height) / 2);
  cv::putText(*codes, text, lower_left, font, scale, CodesOf(Gray(random->Uniform(0.65, 0.85))),
              stroke, cv::LINE_AA);
}

using Polygon = std::vector<cv::Point>;

constexpr double kMiddle_px = 0.5 * kPaint_px;

// Returns corners at the given radii (parts of half the side), at equal steps of angle.
Polygon Star(const std::vector<double>& radii) {
  Polygon corners;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / radii.size();
    const double radius = 0.48 * kPaint_px * radii[i];
    corners.emplace_back(static_cast<int>(kMiddle_px + radius * std::cos(angle)),
                         static_cast<int>(kMiddle_px + radius * std::sin(angle)));
  }
  return corners;
}

}  // namespace

std::shared_ptr<const Texture> FadedPaint(double fading, const std::string& color, int channels,
                                          Random* random) {
  return MakePaint(fading, color, random).ToTexture(channels);
}

std::shared_ptr<const Texture> DigitPaint(double fading, const std::string& color, int digit,
                                          int channels, Random* random) {
  cv::Mat codes = MakePaint(fading, color, random).codes().clone();
  PutDigit(digit, random, &codes);
  return std::make_shared<Texture>(codes, channels);
}

std::shared_ptr<const Texture> DistractorMask(Random* random) {
  cv::Mat mask(kPaint_px, kPaint_px, CV_8U, cv::Scalar(0));
  const auto fill = [&mask](const Polygon& polygon) {
    cv::fillPoly(mask, std::vector<Polygon>{polygon}, cv::Scalar(255), cv::LINE_AA);
  };
  constexpr int kLast = kPaint_px - 1;
  switch (random->Integer(0, 6)) {
    case 0:
      fill(Star({1, 1, 1}));
      break;
    case 1:
      mask = 255;  // a rectangle
      break;
    case 2:
      fill(Star({1, 0.4, 1, 0.4, 1, 0.4, 1, 0.4, 1, 0.4}));
      break;
    case 3:
      cv::circle(mask, {kPaint_px / 2, kPaint_px / 2}, kPaint_px * 2 / 5, cv::Scalar(255),
                 kPaint_px / 7, cv::LINE_AA);
      break;
    case 4:
      fill({{0, 0}, {40, 0}, {40, 88}, {kLast, 88}, {kLast, kLast}, {0, kLast}});
      break;
    case 5:
      cv::line(mask, {10, 64}, {118, 64}, cv::Scalar(255), 30, cv::LINE_AA);
      cv::line(mask, {64, 10}, {64, 118}, cv::Scalar(255), 30, cv::LINE_AA);
      break;
    default:
      for (int i = 0; i < 3; ++i) {
        cv::rectangle(mask, cv::Rect(0, 8 + 42 * i, kPaint_px, 24), cv::Scalar(255), -1);
      }
  }
  return std::make_shared<Texture>(mask, 1);
}

}  // namespace kestrel

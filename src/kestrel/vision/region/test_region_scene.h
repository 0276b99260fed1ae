// SPDX-License-Identifier: BSD-3-Clause
// Images of a thing that moves over textured ground, for tests.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

inline constexpr int kRegionImageWidth = 640, kRegionImageHeight = 480;

// Blotches of several sizes in colour.
inline cv::Mat RegionTexture(const cv::Size& size, std::uint64_t seed, double contrast) {
  Random random(seed);
  cv::Mat sum(size, CV_32FC3, cv::Scalar::all(0));
  for (const int cell : {3, 9, 27}) {
    cv::Mat coarse(size.height / cell + 2, size.width / cell + 2, CV_32FC3);
    for (int y = 0; y < coarse.rows; ++y) {
      for (int x = 0; x < coarse.cols; ++x) {
        for (int c = 0; c < 3; ++c) {
          coarse.at<cv::Vec3f>(y, x)[c] = static_cast<float>(contrast * random.Normal());
        }
      }
    }
    cv::Mat large;
    cv::resize(coarse, large, size, 0, 0, cv::INTER_CUBIC);
    sum += large;
  }
  cv::Mat texture;
  sum.convertTo(texture, CV_8UC3, 1, 110);
  return texture;
}

// A thing on the ground.
struct RegionThing {
  cv::Mat look;
  Eigen::Vector2d center_px = {0, 0};  // on the ground
  double scale = 1, turn_deg = 0;
};

// Ground with things on it, seen by a camera that moves.
class RegionScene {
 public:
  explicit RegionScene(std::uint64_t seed)
      : random_(seed), ground_(RegionTexture({1400, 1000}, seed + 1, 9)) {
    target.look = RegionTexture({40, 52}, seed + 2, 30);
    target.center_px = {600, 480};
  }

  cv::Mat Take() {
    cv::Mat image;
    const cv::Matx23f shift(1, 0, static_cast<float>(-camera_px.x()), 0, 1,
                            static_cast<float>(-camera_px.y()));
    cv::warpAffine(ground_, image, shift, {kRegionImageWidth, kRegionImageHeight}, cv::INTER_LINEAR,
                   cv::BORDER_REFLECT);
    Draw(target, &image);
    if (other) Draw(*other, &image);
    if (cover) Draw(*cover, &image);
    cv::Mat noise(image.size(), CV_8UC3);
    for (int y = 0; y < image.rows; ++y) {
      auto* row = noise.ptr<std::uint8_t>(y);
      for (int i = 0; i < 3 * image.cols; ++i)
        row[i] = static_cast<std::uint8_t>(random_.Bits() & 7);
    }
    cv::add(image, noise, image);
    time += std::chrono::milliseconds(50);
    return image;
  }

  Eigen::Vector2d InImage() const { return target.center_px - camera_px; }
  cv::Rect2d Box() const {
    const Eigen::Vector2d size = target.scale * Eigen::Vector2d(target.look.cols, target.look.rows);
    const Eigen::Vector2d corner = InImage() - 0.5 * (size - Eigen::Vector2d::Ones());
    return {corner.x(), corner.y(), size.x(), size.y()};
  }

  RegionThing target;
  std::optional<RegionThing> other, cover;
  Eigen::Vector2d camera_px = {280, 240};  // where the image's corner is on the ground
  Time time{};

 private:
  void Draw(const RegionThing& thing, cv::Mat* image) const {
    const Eigen::Vector2d at = thing.center_px - camera_px;
    const cv::Point2f middle(0.5f * static_cast<float>(thing.look.cols - 1),
                             0.5f * static_cast<float>(thing.look.rows - 1));
    cv::Mat map = cv::getRotationMatrix2D(middle, thing.turn_deg, thing.scale);
    map.at<double>(0, 2) += at.x() - middle.x;
    map.at<double>(1, 2) += at.y() - middle.y;
    cv::warpAffine(thing.look, *image, map, image->size(), cv::INTER_LINEAR,
                   cv::BORDER_TRANSPARENT);
  }

  Random random_;
  cv::Mat ground_;
};

}  // namespace kestrel

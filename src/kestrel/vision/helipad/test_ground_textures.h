// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {

// Images of grounds and walls on which there is no pad.
class GroundTextures {
 public:
  static constexpr std::array kKinds{"scratches", "gravel",     "grass",   "cracks",
                                     "letters",   "road marks", "windows", "bricks"};

  GroundTextures(cv::Size size, std::uint64_t seed) : size_(size), random_(seed) {}

  // 'kind': index of kKinds. As sharp, noisy and contrasty as images are.
  cv::Mat Draw(std::size_t kind) {
    image_ = cv::Mat(size_, CV_8UC1, cv::Scalar(random_.Uniform(60, 190)));
    ink_contrast_ = random_.Uniform(25, 110) * (random_.Chance(0.5) ? 1 : -1);
    switch (kind) {
      case 0:
        Lines(random_.Integer(300, 1500), 5, 70, 1);
        break;
      case 1:
        Gravel();
        break;
      case 2:
        Lines(random_.Integer(4000, 9000), 3, 18, 1);
        break;
      case 3:
        Cracks();
        break;
      case 4:
        Letters();
        break;
      case 5:
        Lines(random_.Integer(20, 90), 10, 200, 9);
        break;
      case 6:
        Grids(2, 4);
        break;
      default:
        Grids(9, 25);
    }
    return Taken();
  }

 private:
  cv::Point Place() {
    const int x = random_.Integer(0, size_.width - 1);
    return {x, random_.Integer(0, size_.height - 1)};
  }
  cv::Scalar Ink() { return {127 + ink_contrast_ * random_.Uniform(0.4, 1.1)}; }

  // Half of them along two directions, as what is made by people.
  void Lines(int count, double shortest, double longest, int widest) {
    const double main = random_.Uniform(0, kPi);
    for (int i = 0; i < count; ++i) {
      const bool is_along = random_.Chance(0.5);
      const double angle =
          is_along ? main + (random_.Chance(0.5) ? kPi / 2 : 0) : random_.Uniform(0, kPi);
      const double length = random_.Uniform(shortest, longest);
      const cv::Point from = Place();
      const cv::Point to = from + cv::Point(static_cast<int>(length * std::cos(angle)),
                                            static_cast<int>(length * std::sin(angle)));
      const int width = random_.Integer(1, widest);
      cv::line(image_, from, to, Ink(), width, cv::LINE_AA);
    }
  }

  void Gravel() {
    const int largest = random_.Integer(3, 14);
    for (int i = 0; i < 60000 / (largest * largest) + 500; ++i) {
      const cv::Point at = Place();
      const cv::Size axes(random_.Integer(1, largest), random_.Integer(1, largest));
      const double turn = random_.Uniform(0, 180);
      cv::ellipse(image_, at, axes, turn, 0, 360, {random_.Uniform(20, 235)}, cv::FILLED,
                  cv::LINE_AA);
    }
  }

  void Cracks() {
    for (int i = random_.Integer(10, 60); i > 0; --i) {
      cv::Point at = Place();
      double angle = random_.Uniform(0, 2 * kPi);
      const cv::Scalar ink = Ink();
      const int width = random_.Integer(1, 3);
      for (int step = random_.Integer(10, 60); step > 0; --step) {
        angle += random_.Chance(0.1) ? kPi / 2 : 0.5 * random_.Normal();
        const cv::Point next = at + cv::Point(static_cast<int>(10 * std::cos(angle)),
                                              static_cast<int>(10 * std::sin(angle)));
        cv::line(image_, at, next, ink, width, cv::LINE_AA);
        at = next;
      }
    }
  }

  // Any letter but an H.
  void Letters() {
    const std::string letters = "ABCDEFGIJKLMNOPQRSTUVWXYZabcdefgijkmnopqrstuvwxyz0123456789#=+%&";
    for (int i = random_.Integer(30, 150); i > 0; --i) {
      const cv::Point at = Place();
      const char letter = letters[random_.Integer(0, static_cast<int>(letters.size()) - 1)];
      const double scale = random_.Uniform(0.4, 3);
      const int width = random_.Integer(1, std::max(1, static_cast<int>(3 * scale)));
      cv::putText(image_, std::string(1, letter), at, cv::FONT_HERSHEY_SIMPLEX, scale, Ink(), width,
                  cv::LINE_AA);
    }
  }

  // Frames of rows and columns.
  void Grids(int fewest, int most) {
    for (int i = random_.Integer(8, 40); i > 0; --i) {
      const cv::Point at = Place();
      const cv::Size cell(random_.Integer(4, 40), random_.Integer(4, 40));
      const int columns = random_.Integer(1, most), rows = random_.Integer(fewest, most);
      const int width = random_.Integer(1, 4);
      const cv::Scalar ink = Ink();
      for (int k = 0; k <= columns; ++k) {
        const int x = at.x + k * cell.width;
        cv::line(image_, {x, at.y}, {x, at.y + rows * cell.height}, ink, width);
      }
      for (int k = 0; k <= rows; ++k) {
        const int y = at.y + k * cell.height;
        cv::line(image_, {at.x, y}, {at.x + columns * cell.width, y}, ink, width);
      }
    }
  }

  cv::Mat Taken() {
    cv::Mat blurred;
    cv::GaussianBlur(image_, blurred, cv::Size(), random_.Uniform(0.4, 1.2));
    const double noise = random_.Uniform(1, 8);
    cv::Mat taken(size_, CV_8UC1);
    for (int v = 0; v < taken.rows; ++v) {
      for (int u = 0; u < taken.cols; ++u) {
        taken.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(
            blurred.at<std::uint8_t>(v, u) + noise * random_.Normal());
      }
    }
    return taken;
  }

  cv::Size size_;
  Random random_;
  double ink_contrast_ = 0;
  cv::Mat image_;
};

}  // namespace kestrel

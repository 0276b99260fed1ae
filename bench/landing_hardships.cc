// SPDX-License-Identifier: BSD-3-Clause
#include "landing_hardships.h"

#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace kestrel {
namespace {

// Blends two images by a map of 0 to 1.
cv::Mat Blend(const cv::Mat& from, const cv::Mat& to, const cv::Mat& share) {
  cv::Mat a, b, out;
  from.convertTo(a, CV_32F);
  to.convertTo(b, CV_32F);
  out = a + share.mul(b - a);
  out.convertTo(out, CV_8U);
  return out;
}

cv::Mat Dark(const cv::Mat& image, std::uint64_t seed) {
  cv::RNG random(seed + 1);
  const double gain = std::pow(10.0, random.uniform(-1.2, -0.5));
  cv::Mat noise(image.size(), CV_32F), out;
  random.fill(noise, cv::RNG::NORMAL, 0, random.uniform(0.7, 2.0));
  image.convertTo(out, CV_32F, gain);
  out += noise;
  out.convertTo(out, CV_8U);
  return out;
}

// Too bright by the exposure, and by lights that the board reflects.
cv::Mat Overexposed(const cv::Mat& image, std::uint64_t seed) {
  cv::RNG random(seed + 2);
  cv::Mat light = cv::Mat::zeros(image.size(), CV_8U);
  constexpr int kLights = 6;
  for (int i = 0; i < kLights; ++i) {
    const cv::Point center(random.uniform(0, image.cols), random.uniform(0, image.rows));
    cv::circle(light, center, random.uniform(5, 60), random.uniform(60, 255), cv::FILLED);
  }
  const double blur = random.uniform(5.0, 30.0);
  cv::GaussianBlur(light, light, {}, blur);
  cv::Mat out;
  image.convertTo(out, CV_8U, random.uniform(1.2, 2.8));
  out += light;
  return out;
}

// Blots with a gray value of their own, in sizes from pixels to rings.
cv::Mat Dirty(const cv::Mat& image, std::uint64_t seed) {
  cv::RNG random(seed + 3);
  const double size_px = std::exp(random.uniform(std::log(2.0), std::log(20.0)));
  cv::Mat blots(std::max(2, static_cast<int>(image.rows / size_px)),
                std::max(2, static_cast<int>(image.cols / size_px)), CV_32F);
  random.fill(blots, cv::RNG::NORMAL, 0, 1);
  cv::resize(blots, blots, image.size(), 0, 0, cv::INTER_CUBIC);
  const double least = random.uniform(0.8, 1.8);  // threshold of the noise for a blot
  blots = (blots - least) * random.uniform(1.0, 4.0);
  cv::threshold(blots, blots, 0, 0, cv::THRESH_TOZERO);
  cv::threshold(blots, blots, 1, 1, cv::THRESH_TRUNC);
  const cv::Mat gray(image.size(), CV_8U, cv::Scalar(random.uniform(40, 200)));
  return Blend(image, gray, blots * random.uniform(0.4, 1.0));
}

// Shadows of arms and rotors: bars and discs that take away some of the light.
cv::Mat Shadowed(const cv::Mat& image, std::uint64_t seed) {
  cv::RNG random(seed + 4);
  cv::Mat shadow = cv::Mat::zeros(image.size(), CV_32F);
  constexpr int kShadows = 60;
  const double depth = random.uniform(0.3, 0.7);
  for (int i = 0; i < kShadows; ++i) {
    const cv::Point from(random.uniform(0, image.cols), random.uniform(0, image.rows));
    const cv::Point along(random.uniform(-60, 60), random.uniform(-60, 60));
    if (random.uniform(0, 3) == 0) {
      cv::circle(shadow, from, random.uniform(2, 25), depth, cv::FILLED);
    } else {
      cv::line(shadow, from, from + along, depth, random.uniform(1, 9));
    }
  }
  cv::GaussianBlur(shadow, shadow, {}, random.uniform(0.5, 2.0));
  return Blend(image, cv::Mat::zeros(image.size(), CV_8U), shadow);
}

constexpr std::array kHardships = {ImageVariant{"dark", Dark},
                                   ImageVariant{"overexposed", Overexposed},
                                   ImageVariant{"dirty", Dirty}, ImageVariant{"shadows", Shadowed}};

}  // namespace

std::span<const ImageVariant> Hardships() { return kHardships; }

}  // namespace kestrel

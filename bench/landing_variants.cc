// SPDX-License-Identifier: BSD-3-Clause
#include "landing_variants.h"

#include <array>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "kestrel/core/codec/image_codec.h"
#include "kestrel/core/codec/jpeg_codec.h"

namespace kestrel {
namespace {

cv::Mat Same(const cv::Mat& image, std::uint64_t /*seed*/) { return image; }

template <int kPercent>
cv::Mat Exposed(const cv::Mat& image, std::uint64_t /*seed*/) {
  cv::Mat out;
  image.convertTo(out, CV_8U, kPercent / 100.0);
  return out;
}

template <int kPercent>
cv::Mat Gamma(const cv::Mat& image, std::uint64_t /*seed*/) {
  cv::Mat table(1, 256, CV_8U);
  for (int i = 0; i < 256; ++i) {
    table.at<std::uint8_t>(i) =
        cv::saturate_cast<std::uint8_t>(255 * std::pow(i / 255.0, kPercent / 100.0));
  }
  cv::Mat out;
  cv::LUT(image, table, out);
  return out;
}

cv::Mat Noisy(const cv::Mat& image, std::uint64_t seed) {
  constexpr double kSigma = 4;
  cv::Mat noise(image.size(), CV_16S), sum;
  cv::RNG(seed + 1).fill(noise, cv::RNG::NORMAL, 0, kSigma);
  image.convertTo(sum, CV_16S);
  sum += noise;
  sum.convertTo(sum, CV_8U);
  return sum;
}

cv::Mat Blurred(const cv::Mat& image, std::uint64_t /*seed*/) {
  cv::Mat out;
  cv::GaussianBlur(image, out, {}, 0.7);
  return out;
}

// The path is not centred: the truth stays where it was, half a pixel from the image's.
cv::Mat MovedByFourPixels(const cv::Mat& image, std::uint64_t /*seed*/) {
  cv::Mat path = cv::Mat::zeros(1, 5, CV_32F);
  path.colRange(0, 4) = 0.25;
  cv::Mat out;
  cv::filter2D(image, out, -1, path);
  return out;
}

cv::Mat Sharpened(const cv::Mat& image, std::uint64_t /*seed*/) {
  cv::Mat smooth, out;
  cv::GaussianBlur(image, smooth, {}, 1.2);
  cv::addWeighted(image, 1.7, smooth, -0.7, 0, out);
  return out;
}

cv::Mat Compressed(const cv::Mat& image, std::uint64_t /*seed*/) {
  return DecodeImage(EncodeJpeg(image, 60), "image");
}

constexpr std::array kVariants = {ImageVariant{"as they are", Same},
                                  ImageVariant{"exposure x 0.6", Exposed<60>},
                                  ImageVariant{"exposure x 1.35", Exposed<135>},
                                  ImageVariant{"gamma 0.6", Gamma<60>},
                                  ImageVariant{"gamma 1.5", Gamma<150>},
                                  ImageVariant{"noise of 4 gray values", Noisy},
                                  ImageVariant{"blur of 0.7 px", Blurred},
                                  ImageVariant{"moved by 4 px", MovedByFourPixels},
                                  ImageVariant{"sharpened", Sharpened},
                                  ImageVariant{"JPEG, quality 60", Compressed}};

}  // namespace

std::span<const ImageVariant> ImageVariants() { return kVariants; }

LandingFrameSet Mirrored(const LandingFrameSet& set, bool left_right, bool top_bottom) {
  if (!left_right && !top_bottom) return set;
  LandingFrameSet mirrored = set;
  CameraIntrinsics& camera = mirrored.camera;
  const Eigen::Array2d last_px(camera.width_px - 1, camera.height_px - 1);
  const Eigen::Array2d sign(left_right ? -1 : 1, top_bottom ? -1 : 1);
  const auto mirror_px = [&](const Eigen::Vector2d& pixel) -> Eigen::Vector2d {
    return (sign < 0).select(last_px - pixel.array(), pixel.array());
  };
  const Eigen::Vector2d principal = mirror_px({camera.cx_px, camera.cy_px});
  camera.cx_px = principal.x();
  camera.cy_px = principal.y();
  const Eigen::Vector3d in_camera(sign.x(), sign.y(), 1);
  // The mirror rotates the print about its normal, or also swaps its sides.
  const Eigen::Vector3d in_print(sign.prod(), 1, 1);
  const int code = left_right && top_bottom ? -1 : left_right ? 1 : 0;
  for (LandingFrame& frame : mirrored.frames) {
    cv::Mat image;
    cv::flip(frame.image, image, code);
    frame.image = image;
    frame.center_px = mirror_px(frame.center_px);
    if (frame.outer) {
      frame.outer->center = mirror_px(frame.outer->center);
      frame.outer->angle *= sign.prod();
    }
    if (frame.camera_from_target) {
      RigidTransform& pose = *frame.camera_from_target;
      const Eigen::Matrix3d rotation =
          in_camera.asDiagonal() * pose.rotation.toRotationMatrix() * in_print.asDiagonal();
      pose.rotation = Eigen::Quaterniond(rotation);
      pose.translation = in_camera.cwiseProduct(pose.translation);
    }
    if (frame.up_in_camera) frame.up_in_camera = in_camera.cwiseProduct(*frame.up_in_camera);
  }
  return mirrored;
}

}  // namespace kestrel

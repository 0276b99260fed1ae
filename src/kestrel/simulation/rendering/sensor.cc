// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/core/codec/jpeg_codec.h"

namespace kestrel {
namespace {

constexpr int kNormals = 1 << 14;
constexpr float kShotNoiseGray = 100;  // gray value at which 'shot_noise' is given

// Standard normal numbers, selected by random bits.
const std::array<float, kNormals>& Normals() {
  static const std::array<float, kNormals> normals = [] {
    std::array<float, kNormals> values{};
    Random random(1);
    for (float& value : values) value = static_cast<float>(random.Normal());
    return values;
  }();
  return normals;
}

void PassLens(const Lens& lens, cv::Mat* radiance) {
  const int channels = radiance->channels();
  const auto airframe = static_cast<float>(lens.options().airframe_radiance);
  for (int v = 0; v < radiance->rows; ++v) {
    const auto* gain = lens.gain().ptr<float>(v);
    const auto* cover = lens.airframe_cover().ptr<float>(v);
    auto* light = radiance->ptr<float>(v);
    for (int i = 0; i < radiance->cols * channels; ++i) {
      const int u = i / channels;
      light[i] = gain[u] * (light[i] + cover[u] * (airframe - light[i]));
    }
  }
}

void Sharpen(double part, cv::Mat* image) {
  cv::Mat smooth;
  cv::GaussianBlur(*image, smooth, cv::Size(), 1.2);
  cv::addWeighted(*image, 1 + part, smooth, -part, 0, *image);
}

cv::Mat Compressed(const cv::Mat& image, int jpeg_quality) {
  return DecodeImage(EncodeJpeg(image, jpeg_quality), "image");
}

// Table of the gray values for light in steps of a quarter.
class ToneCurve {
 public:
  explicit ToneCurve(double gamma) {
    for (std::size_t i = 0; i < grays_.size(); ++i) {
      const double linear = std::min(static_cast<double>(i) / kStepsPerGray, 255.0) / 255;
      grays_[i] = cv::saturate_cast<std::uint8_t>(255 * std::pow(linear, gamma));
    }
  }
  std::uint8_t operator()(float gray) const {
    const float step = std::clamp(gray, 0.0f, 255.0f) * kStepsPerGray + 0.5f;
    return grays_[static_cast<std::size_t>(step)];
  }

 private:
  static constexpr int kStepsPerGray = 32;
  std::array<std::uint8_t, 256 * kStepsPerGray> grays_{};
};

}  // namespace

cv::Mat Expose(const SensorOptions& options, const Lens& lens, double gain, std::uint64_t seed,
               cv::Mat radiance) {
  PassLens(lens, &radiance);
  if (options.blur_sigma_px > 0) {
    cv::GaussianBlur(radiance, radiance, cv::Size(), options.blur_sigma_px, options.blur_sigma_px,
                     cv::BORDER_REPLICATE);
  }
  const ToneCurve curve(options.gamma);
  const std::array<float, kNormals>& normals = Normals();
  const auto black = static_cast<float>(options.black_level);
  const auto range = static_cast<float>(gain * (options.white_level - options.black_level));
  const auto read = static_cast<float>(options.read_noise * options.read_noise);
  const auto shot = static_cast<float>(options.shot_noise * options.shot_noise) / kShotNoiseGray;
  cv::Mat image(radiance.size(), CV_8UC(radiance.channels()));
  const int columns = radiance.cols * radiance.channels();
  for (int v = 0; v < image.rows; ++v) {
    const auto* light = radiance.ptr<float>(v);
    auto* out = image.ptr<std::uint8_t>(v);
    for (int i = 0; i < columns; ++i) {
      const float gray = range * light[i];
      const std::uint64_t bits = Hash(seed, static_cast<std::uint64_t>(v) * columns + i);
      out[i] = curve(black + gray + std::sqrt(read + shot * gray) * normals[bits % kNormals]);
    }
  }
  if (options.sharpening > 0) Sharpen(options.sharpening, &image);
  return options.jpeg_quality < 100 ? Compressed(image, options.jpeg_quality) : image;
}

}  // namespace kestrel

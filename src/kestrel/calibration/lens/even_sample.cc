// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/even_sample.h"

namespace kestrel {

void EvenSample::Add(const std::string& name, const cv::Mat& image) {
  if (count_++ % stride_ != 0) return;
  images_.push_back({name, image.clone()});
  constexpr std::size_t kMaxImages = 400;
  if (images_.size() <= kMaxImages) return;
  stride_ *= 2;
  for (std::size_t i = 1; 2 * i < images_.size(); ++i) images_[i] = std::move(images_[2 * i]);
  images_.resize((images_.size() + 1) / 2);
}

}  // namespace kestrel

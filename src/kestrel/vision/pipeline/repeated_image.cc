// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/repeated_image.h"

#include <functional>
#include <string_view>

#include "kestrel/core/base/hash.h"

namespace kestrel {

std::uint64_t HashOf(const cv::Mat& image) {
  constexpr int kRowStep = 8;
  const std::size_t row_bytes = static_cast<std::size_t>(image.cols) * image.elemSize();
  std::uint64_t hash = Hash(static_cast<std::uint64_t>(image.rows), row_bytes);
  for (int y = 0; y < image.rows; y += kRowStep) {
    const std::string_view row(image.ptr<char>(y), row_bytes);
    hash = Hash(hash, std::hash<std::string_view>()(row));
  }
  return hash;
}

bool RepeatedImage::IsRepeated(const cv::Mat& image) {
  const std::uint64_t hash = HashOf(image);
  const bool is_repeated = hash == hash_;
  hash_ = hash;
  in_a_row_ = is_repeated ? in_a_row_ + 1 : 0;
  return is_repeated;
}

}  // namespace kestrel

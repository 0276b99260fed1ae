// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

namespace kestrel {

// Memory for images that go from thread to thread: an image is reused when its last user has
// released it. One thread takes; any may release.
class ImagePool {
 public:
  // Keeps up to 'capacity' images; further ones are allocated each time.
  explicit ImagePool(std::size_t capacity) { images_.reserve(capacity); }

  // Returns an image that nobody else uses; its contents are undefined.
  cv::Mat Take(cv::Size size, int type) {
    for (cv::Mat& image : images_) {
      if (!IsUnused(image)) continue;
      image.create(size, type);
      return image;
    }
    cv::Mat image(size, type);
    if (images_.size() < images_.capacity()) images_.push_back(image);
    return image;
  }

 private:
  // Acquire makes another thread's last use of the pixels, before its release, visible.
  static bool IsUnused(const cv::Mat& image) {
    return std::atomic_ref(image.u->refcount).load(std::memory_order_acquire) == 1;
  }

  std::vector<cv::Mat> images_;
};

}  // namespace kestrel

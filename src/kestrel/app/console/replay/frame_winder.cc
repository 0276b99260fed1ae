// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/frame_winder.h"

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {

void FrameWinder::Begin() {
  source_ = open_();
  source_->set_on_broken([this](const BrokenImage&) { Keep(cv::Mat()); });
  next_ = 0;
  kept_.clear();
}

void FrameWinder::Keep(const cv::Mat& image) {
  kept_.push_back(image);
  if (kept_.size() > kMaxKept) kept_.pop_front();
  ++next_;
}

cv::Mat FrameWinder::Read(std::size_t index) {
  Frame frame;
  if (source_->Read(index, &frame)) return frame.image;
  if (index + kept_.size() < next_) {
    Begin();
  }
  while (next_ <= index) {
    if (!source_->Next(&frame)) {
      throw InputError(fmt::format("the source has ended before its frame {}", index));
    }
    Keep(frame.image.clone());
  }
  cv::Mat image = kept_[kept_.size() - (next_ - index)];
  if (image.empty()) throw InputError(fmt::format("the frame {} cannot be read", index));
  return image;
}

}  // namespace kestrel

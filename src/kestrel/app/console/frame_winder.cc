// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/frame_winder.h"

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {

cv::Mat FrameWinder::Read(std::size_t index) {
  Frame frame;
  if (source_->Read(index, &frame)) return frame.image;
  if (index + kept_.size() < next_) {
    source_ = open_();
    next_ = 0;
    kept_.clear();
  }
  while (next_ <= index) {
    if (!source_->Next(&frame)) {
      throw InputError(fmt::format("the source has ended before its frame {}", index));
    }
    kept_.push_back(frame.image.clone());
    if (kept_.size() > kMaxKept) kept_.pop_front();
    ++next_;
  }
  return kept_[kept_.size() - (next_ - index)];
}

}  // namespace kestrel

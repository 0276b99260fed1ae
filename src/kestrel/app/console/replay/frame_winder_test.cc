// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/frame_winder.h"

#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// 300 images that can only be read in order; the pixels hold the index.
class ForwardSource : public FrameSource {
 public:
  bool ReadNext(Frame* frame) override {
    if (count_ == 300) return false;
    frame->image = cv::Mat(1, 1, CV_32SC1, cv::Scalar(count_++));
    return true;
  }
  std::optional<std::size_t> frame_count() const override { return 300; }
  double rate_hz() const override { return 10; }

 private:
  int count_ = 0;
};

TEST(FrameWinderTest, SeeksBothWaysInForwardOnlySource) {
  int opened = 0;
  FrameWinder winder([&] {
    ++opened;
    return std::make_unique<ForwardSource>();
  });
  for (const std::size_t frame : {0, 1, 150, 149, 51, 299, 200}) {
    EXPECT_EQ(winder.Read(frame).at<int>(0), static_cast<int>(frame));
  }
  EXPECT_EQ(opened, 1) << "a little back is kept";
  EXPECT_EQ(winder.Read(199).at<int>(0), 199);
  EXPECT_EQ(winder.Read(100).at<int>(0), 100);
  EXPECT_EQ(opened, 2);
  EXPECT_EQ(winder.Read(5).at<int>(0), 5);
  EXPECT_EQ(opened, 3);
  EXPECT_THROW(winder.Read(300), InputError);
  EXPECT_EQ(winder.Read(299).at<int>(0), 299);
}

}  // namespace
}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/video_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using ::testing::StartsWith;

TEST(VideoDeviceTest, ExplainsFaultOfDeviceInCameraOrPipeline) {
  for (const char* const camera : {"/dev/video987", "v4l2src device=/dev/video987 ! videoconvert",
                                   "v4l2src device=\"/dev/video987\" io-mode=2 ! video/x-raw",
                                   "v4l2src device=/dev/video987"}) {
    EXPECT_THAT(CameraFault(camera), StartsWith("there is no /dev/video987, ")) << camera;
  }
  EXPECT_EQ(CameraFault("/dev/null"), "/dev/null: is no video device");
}

TEST(VideoDeviceTest, ExplainsNothingWithoutDevice) {
  for (const char* const camera :
       {"videotestsrc ! videoconvert", "rtsp://10.0.0.2/stream", "udpsrc port=5600 ! decodebin"}) {
    EXPECT_EQ(CameraFault(camera), "") << camera;
  }
}

}  // namespace
}  // namespace kestrel

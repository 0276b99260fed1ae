// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/video_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(VideoAddressTest, PasswordsAreNotShown) {
  for (const auto& [text, shown] :
       {std::pair{"rtsp://admin:secret@10.0.0.2:554/main", "rtsp://***@10.0.0.2:554/main"},
        {"rtsp://admin:se@c/ret@10.0.0.2/main: refused", "rtsp://***@10.0.0.2/main: refused"},
        {"rtspsrc location=\"rtsps://a:b@host/x\" ! decodebin",
         "rtspsrc location=\"rtsps://***@host/x\" ! decodebin"},
        {"rtsp://a:b@one/x and http://c:d@two", "rtsp://***@one/x and http://***@two"},
        {"rtsp://10.0.0.2/main?user=me@home", "rtsp://10.0.0.2/main?user=me@home"},
        {"rtsp://10.0.0.2/main?user=me&password=secret&channel=1",
         "rtsp://10.0.0.2/main?user=me&password=***&channel=1"},
        {"rtspsrc location=rtsp://host/x user-id=me user-pw=secret ! decodebin",
         "rtspsrc location=rtsp://host/x user-id=me user-pw=*** ! decodebin"},
        {"rtspsrc user-pw=\"sec ret\" ! decodebin", "rtspsrc user-pw=*** ! decodebin"},
        {"rtspsrc user-pw=se&cret ! decodebin", "rtspsrc user-pw=*** ! decodebin"},
        {"rtspsrc user-pw=\"it's x\" ! decodebin", "rtspsrc user-pw=*** ! decodebin"},
        {"rtspsrc user-pw=\"a\\\"b\" ! decodebin", "rtspsrc user-pw=*** ! decodebin"},
        {"rtspsrc user-pw = se\\ cret ! decodebin", "rtspsrc user-pw = *** ! decodebin"},
        {"rtspsrc proxy-pw=(string)\"a b\" ! x", "rtspsrc proxy-pw=(string)*** ! x"},
        {"rtsp://host/x?pwd=a:b", "rtsp://host/x?pwd=***"},
        {"compass=1 bypass=2", "compass=1 bypass=2"},
        {"rtsp://host/x?password=secret: refused", "rtsp://host/x?password=***: refused"},
        {"/dev/video0", "/dev/video0"}}) {
    EXPECT_EQ(WithoutPassword(text), shown);
  }
}

TEST(VideoAddressTest, NetworkVideoIsKnownByItsName) {
  for (const char* camera :
       {"rtsp://host/main", "rtsps://host/main", "rtp://0.0.0.0:5600", "udp://0.0.0.0:5600",
        "rtspsrc location=x ! decodebin", "udpsrc port=5600 ! application/x-rtp ! decodebin"}) {
    EXPECT_TRUE(IsNetworkVideo(camera)) << camera;
  }
  for (const char* camera : {"/dev/video0", "videotestsrc ! videoconvert", "flight.mp4"}) {
    EXPECT_FALSE(IsNetworkVideo(camera)) << camera;
  }
}

TEST(VideoAddressTest, QuotesDoNotReachPipeline) {
  const std::string error =
      InputErrorOf([] { NetworkVideoText("rtsp://a:secret@host/\" ! filesink location=\"x"); });
  EXPECT_THAT(error, HasSubstr("rtsp://***@host"));
  EXPECT_THAT(error, Not(HasSubstr("secret")));
}

}  // namespace
}  // namespace kestrel

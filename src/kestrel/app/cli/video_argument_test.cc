// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/video_argument.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;

TEST(VideoArgumentTest, ThisComputerNeedsNoPassword) {
  ConsoleOptions console;
  console.token = "0123456789abcdef";
  for (const std::string host : {"127.0.0.1", "[::1]"}) {
    const VideoServerOptions options = ParseVideoUrl("rtsp://" + host + ":8554/a/b", console);
    EXPECT_EQ(options.port, 8554);
    EXPECT_EQ(options.path, "a/b");
    EXPECT_EQ(options.password, "");
    EXPECT_THAT(VideoUrls(options, 8554), ElementsAre("rtsp://" + host + ":8554/a/b"));
  }
}

TEST(VideoArgumentTest, OthersNeedTheTokenOfThePage) {
  ConsoleOptions console;
  console.token = "0123456789abcdef";
  const VideoServerOptions options = ParseVideoUrl("rtsp://0.0.0.0:0/kestrel", console);
  EXPECT_EQ(options.password, console.token);
  EXPECT_EQ(VideoUrls(options, 999).front(),
            "rtsp://kestrel:0123456789abcdef@localhost:999/kestrel");
  EXPECT_THAT(VideoUrls(options, 999).back(), StartsWith("rtsp://kestrel:0123456789abcdef@"));
  EXPECT_EQ(ParseVideoUrl("rtsp://192.168.2.5:1/k", {}).password.size(), 32u) << "a new one";
}

}  // namespace
}  // namespace kestrel

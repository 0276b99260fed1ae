// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/open_live_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

LiveSourceChoice Choice(const std::string& uri) { return {.recording = {.sources = {uri}}}; }

TEST(OpenLiveSourceTest, SchemeOpensMatchingUris) {
  std::string requested;
  const SourceScheme scheme{"mine:", [&](const LiveSourceChoice& choice) {
                              requested = choice.uri();
                              OpenedLiveSource opened;
                              opened.rate_hz = 12;
                              return opened;
                            }};
  EXPECT_EQ(OpenLiveSource(Choice("mine:left"), {}, {scheme}).rate_hz, 12);
  EXPECT_EQ(requested, "mine:left");
  EXPECT_THROW(OpenLiveSource(Choice("/nowhere/mine:left"), {}, {scheme}), InputError);
}

TEST(OpenLiveSourceTest, CameraRequiresCalibration) {
  EXPECT_THAT(InputErrorOf([] { OpenLiveSource(Choice("/dev/video0"), {}); }),
              HasSubstr("give it by --camera FILE"));
}

}  // namespace
}  // namespace kestrel

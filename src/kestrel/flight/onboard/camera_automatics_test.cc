// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/camera_automatics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(CameraAutomatics, AreUnknownForNonCamera) {
  for (const char* device : {"/dev/null", "/no/such/device", "videotestsrc ! appsink"}) {
    const CameraAutomatics automatics = ReadCameraAutomatics(device);
    EXPECT_FALSE(automatics.white_balance) << device;
    EXPECT_FALSE(automatics.exposure) << device;
  }
}

TEST(CameraAutomatics, WarnsOfEnabledAutomatics) {
  EXPECT_THAT(ColorWarnings({}), IsEmpty());
  EXPECT_THAT(ColorWarnings({.white_balance = false, .exposure = false}), IsEmpty());
  EXPECT_THAT(
      ColorWarnings({.white_balance = true, .exposure = true}),
      ElementsAre(HasSubstr("white balance is automatic"), HasSubstr("exposure is automatic")));
  EXPECT_THAT(ColorWarnings({.white_balance = true, .exposure = {}}),
              ElementsAre(HasSubstr("white balance")));
}

}  // namespace
}  // namespace kestrel

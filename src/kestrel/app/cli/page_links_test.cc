// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/page_links.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(PageLinksTest, QrCodeIsSquareWithMargin) {
  // This text takes version 2: 25 modules, and 2 on either side, two rows a line.
  const std::string lines = QrLines("http://192.168.1.17:8080/?token=x");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 15);
  EXPECT_THAT(lines, testing::StartsWith("\x1b[97;40m███")) << "the margin is white";
  EXPECT_THAT(lines, testing::HasSubstr(" ▄▄▄▄▄ ")) << "the square in a corner";
}

TEST(PageLinksTest, PrintsPlainLinksForPrograms) {
  testing::internal::CaptureStderr();
  PrintLinks({"http://localhost:8080/", "http://10.0.0.5:8080/"});
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "console: http://localhost:8080/\nconsole: http://10.0.0.5:8080/\n");
}

}  // namespace
}  // namespace kestrel

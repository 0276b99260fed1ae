// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ToHtml, HasVerdictVideosPicturesAndTables) {
  const std::string html = ToHtml(
      "Demo", {"found 3 of 3"},
      {{.title = "A < B",
        .text = "Why & where.",
        .videos = {"a/b.mp4"},
        .pictures = {"c.png"},
        .tables = {{"t", "Errors", "", {"x"}, {{"1.5"}}}, {"empty", "Nothing", "", {"y"}, {}}}}});
  EXPECT_THAT(html, HasSubstr("<li>found 3 of 3</li>"));
  EXPECT_THAT(html, HasSubstr("<h2>A &lt; B</h2>"));
  EXPECT_THAT(html, HasSubstr("Why &amp; where."));
  EXPECT_THAT(html, HasSubstr("src=\"a/b.mp4\""));
  EXPECT_THAT(html, HasSubstr("<img loading=\"lazy\" alt=\"c.png\" src=\"c.png\">"));
  EXPECT_THAT(html, HasSubstr("<td>1.5</td>"));
  EXPECT_THAT(html, Not(HasSubstr("Nothing")));
}

}  // namespace
}  // namespace kestrel

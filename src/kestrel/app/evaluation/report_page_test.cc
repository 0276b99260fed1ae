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
      "Demo", PageVideo{"first.mp4", 7.5}, {{"found 3 of 3", "needed: 1"}},
      {{.title = "A < B",
        .text = "Why & where.",
        .videos = {{"a/b.mp4", 2}},
        .pictures = {{"c.png", "The \"path\""}},
        .tables = {{"t", "Errors", "", {"x"}, {{"1.5"}}}, {"empty", "Nothing", "", {"y"}, {}}}}},
      {{"Fly & land", "kestrel fly \"a\"", ""}, {"A first landing", "", "docs/first.md"}});
  EXPECT_THAT(html, HasSubstr("<dt>found 3 of 3</dt><dd>needed: 1</dd>"));
  EXPECT_THAT(html, HasSubstr("<details><summary>A &lt; B</summary>"));
  EXPECT_THAT(html, HasSubstr("Why &amp; where."));
  EXPECT_THAT(html, HasSubstr("src=\"a/b.mp4#t=2\""));
  EXPECT_THAT(html, HasSubstr("src=\"first.mp4#t=7.5\""));
  EXPECT_THAT(html, HasSubstr("<figcaption>The &quot;path&quot;</figcaption>"));
  EXPECT_LT(html.find("first.mp4"), html.find("<dt>")) << "the video is beside the verdict";
  EXPECT_LT(html.find("<dt>"), html.find("a/b.mp4")) << "chapters follow";
  EXPECT_THAT(html, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(html, HasSubstr("<td>1.5</td>"));
  EXPECT_THAT(html, Not(HasSubstr("Nothing")));
  EXPECT_THAT(html, HasSubstr("<li>Fly &amp; land: <code>kestrel fly &quot;a&quot;</code></li>"));
  EXPECT_THAT(html, HasSubstr("<li><a href=\"docs/first.md\">A first landing</a></li>"));
  EXPECT_LT(html.find("<td>1.5</td>"), html.find("<h2>Next</h2>")) << "the steps are last";
}

}  // namespace
}  // namespace kestrel

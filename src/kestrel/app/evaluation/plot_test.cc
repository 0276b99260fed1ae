// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/plot.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Plot TwoPanels() {
  return {"flight",
          "It's a flight",
          {{"time, s",
            "height, m",
            {{"true", PlotStyle::kLine, {{0, 1}, {kNaN, kNaN}, {2, 3}}, {}},
             {"nothing", PlotStyle::kPoints, {}, {}}}},
           {"altitude, m", "rate, %", {{"rate", PlotStyle::kErrorBars, {{1, 90}}, {{80, 95}}}}}}};
}

TEST(PlotScript, HasLabelsDataAndGaps) {
  const std::string script = PlotScript(TwoPanels(), "/tmp/a b.png");
  EXPECT_THAT(script, HasSubstr("set output '/tmp/a b.png'"));
  EXPECT_THAT(script, HasSubstr("title 'It''s a flight'"));
  EXPECT_THAT(script, HasSubstr("set xlabel 'time, s'"));
  EXPECT_THAT(script, HasSubstr("\n0 1\n\n2 3\nEOD"));
  EXPECT_THAT(script, HasSubstr("\n1 90 80 95\nEOD"));
}

TEST(PlotScript, LeavesOutSeriesWithoutPoints) {
  EXPECT_THAT(PlotScript(TwoPanels(), "a.png"), Not(HasSubstr("nothing")));
}

TEST(WritePlot, DrawsPicture) {
  const TestFolder folder;
  WritePlot(TwoPanels(), folder / "it's.png");
  const cv::Mat picture = ReadImage(folder / "it's.png");
  ASSERT_FALSE(picture.empty());
  EXPECT_GT(cv::countNonZero(picture.reshape(1) < 128), 500);
}

TEST(WritePlot, ReportsWhyItFails) {
  const std::string error =
      InputErrorOf([] { WritePlot(TwoPanels(), "/nonexistent/folder/a.png"); });
  EXPECT_THAT(error, HasSubstr("/nonexistent/folder/a.png: cannot be drawn"));
}

}  // namespace
}  // namespace kestrel

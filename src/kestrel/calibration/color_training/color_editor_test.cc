// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/color_training/color_editor.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"
#include "kestrel/vision/objects/object_detector.h"
#include "kestrel/vision/objects/test_objects.h"

namespace kestrel {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

const std::array kPaints = {kRedPaint, kOrangePaint, kYellowPaint, kGreenPaint, kBluePaint};
constexpr std::array kNames = {"red", "orange", "yellow", "green", "blue"};

// Discs of all colours on gray ground in light of this brightness, as seen by a sensor with noise.
cv::Mat DiscsInLight(double light, int seed) {
  ObjectScene scene;
  for (std::size_t i = 0; i < kPaints.size(); ++i) {
    const double radius_m = i == 1 ? 0.25 : 0.1;  // as in the model's classes
    scene.DrawDisc(scene.PointUnder({80 + 115.0 * static_cast<double>(i), 240}, 0.012), radius_m,
                   kPaints[i]);
  }
  cv::Mat image = scene.Image();
  Random random(seed);
  for (auto pixel = image.begin<cv::Vec3b>(); pixel != image.end<cv::Vec3b>(); ++pixel) {
    for (int c = 0; c < 3; ++c) {
      (*pixel)[c] = cv::saturate_cast<uchar>(light * (*pixel)[c] + 3 * random.Normal());
    }
  }
  return image;
}

class ColorEditorTest : public ::testing::Test {
 protected:
  // A brush stroke on the disc of a colour.
  static ColorStroke On(std::size_t frame, std::size_t color) {
    const int u = 80 + 115 * static_cast<int>(color);
    return {frame, kNames[color], StrokeTool::kBrush, 4, {{u - 3, 240}, {u + 3, 240}}};
  }
  static ColorStroke OnGround(std::size_t frame) {
    return {frame, "", StrokeTool::kRectangle, 0, {{10, 10}, {600, 60}}};
  }

  const std::array<cv::Mat, 3> frames_ = {DiscsInLight(0.55, 1), DiscsInLight(0.8, 2),
                                          DiscsInLight(1, 3)};
  ColorEditor editor_{DefaultObjectModel(), frames_.size(),
                      [this](std::size_t frame) { return frames_[frame]; }};
};

TEST_F(ColorEditorTest, LaterStrokesOverrideAndCanBeUndone) {
  editor_.Mark({0, "red", StrokeTool::kRectangle, 0, {{0, 0}, {9, 9}}});
  editor_.Mark({0, "", StrokeTool::kRectangle, 0, {{0, 0}, {9, 4}}});
  editor_.Teach("red");
  EXPECT_EQ(editor_.Scores("red").wanted, 50U);
  EXPECT_EQ(editor_.Scores("red").others, 50U);
  EXPECT_TRUE(editor_.Undo());
  EXPECT_EQ(editor_.Scores("red").wanted, 100U);
  EXPECT_TRUE(editor_.Redo());
  EXPECT_EQ(editor_.Scores("red").wanted, 50U);
  EXPECT_FALSE(editor_.Redo());
}

TEST_F(ColorEditorTest, RefusedStrokesChangeNothing) {
  editor_.Mark(On(0, 0));
  EXPECT_THROW(editor_.Mark(On(3, 0)), InputError) << "no such frame";
  EXPECT_THROW(editor_.Mark({0, "pink", StrokeTool::kGrow, 5, {{1, 1}}}), InputError);
  EXPECT_THROW(editor_.Mark({0, "red", StrokeTool::kGrow, 5, {{640, 1}}}), InputError);
  EXPECT_EQ(editor_.draft().strokes().size(), 1U);
  EXPECT_THROW(editor_.Teach("blue"), InputError) << "nothing is marked so";
  EXPECT_THROW(editor_.Scores("pink"), InputError);
}

TEST_F(ColorEditorTest, RefusesContradictionsAndKeepsModel) {
  ColorStroke stroke = On(0, 0);
  stroke.color = "blue";
  editor_.Mark(stroke);
  stroke = On(1, 0);
  stroke.color = "blue";
  editor_.Mark(stroke);
  const std::string before = PrintObjectModel(editor_.model());
  try {
    editor_.Teach("blue");
    ADD_FAILURE() << "the red disc";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("blue cannot be told from red"));
  }
  EXPECT_EQ(PrintObjectModel(editor_.model()), before);
}

TEST_F(ColorEditorTest, LabelsMarks) {
  EXPECT_TRUE(editor_.Marks(0).empty());
  editor_.Mark({0, "green", StrokeTool::kRectangle, 0, {{0, 0}, {9, 9}}});
  editor_.Mark({0, "", StrokeTool::kRectangle, 0, {{0, 0}, {9, 4}}});
  const cv::Mat marks = editor_.Marks(0);
  EXPECT_EQ(marks.at<uchar>(2, 2), kAmbiguousLabel);
  EXPECT_EQ(marks.at<uchar>(7, 2), 4) << "green is the fourth";
  EXPECT_EQ(marks.at<uchar>(20, 2), kBackgroundLabel);
  EXPECT_TRUE(editor_.Marks(1).empty());
}

TEST_F(ColorEditorTest, RestoresDraft) {
  editor_.Mark(On(0, 3));
  editor_.Mark(OnGround(0));
  editor_.Teach("green");
  ColorEditor again(DefaultObjectModel(), frames_.size(),
                    [this](std::size_t frame) { return frames_[frame]; });
  again.Restore(ParseColorDraft(PrintColorDraft(editor_.draft(), "r"), "r", "draft"));
  again.Teach("green");
  EXPECT_EQ(PrintObjectModel(again.model()), PrintObjectModel(editor_.model()))
      << "and is taught the same each time";
}

TEST_F(ColorEditorTest, ScoresMeasureQualityOfColour) {
  for (std::size_t frame = 0; frame < frames_.size(); ++frame) {
    editor_.Mark(On(frame, 3));
    editor_.Mark(OnGround(frame));
  }
  editor_.Teach("green");
  const ColorScores scores = editor_.Scores("green");
  EXPECT_GT(scores.recall, 0.98);
  EXPECT_LT(scores.false_share, 0.01);
  ASSERT_EQ(scores.left_outs.size(), 3U);
  for (const ColorScores::LeftOut& left_out : scores.left_outs) EXPECT_GT(left_out.recall, 0.5);
  const HueSaturationHistogram histogram = editor_.Histogram("green");
  EXPECT_EQ(std::accumulate(histogram.counts().begin(), histogram.counts().end(), 0U),
            scores.wanted);
}

TEST_F(ColorEditorTest, LabelsComeFromTaughtModel) {
  const cv::Mat purple(40, 40, CV_8UC3, cv::Scalar(200, 60, 190));
  ColorEditor editor(DefaultObjectModel(), 1, [&](std::size_t) { return purple; });
  EXPECT_EQ(editor.Labels(purple).at<uchar>(30, 10), kBackgroundLabel);
  editor.Mark({0, "green", StrokeTool::kGrow, 5, {{20, 20}}});
  editor.Teach("green");
  EXPECT_EQ(editor.Labels(purple).at<uchar>(30, 10), 4) << "green is the fourth";
}

TEST(RequireDistinctTest, AcceptsBuiltInColours) {
  const ColorModel model = DefaultObjectModel().colors;
  for (std::size_t i = 0; i < model.colors.size(); ++i) {
    EXPECT_NO_THROW(RequireDistinct(model, i)) << model.colors[i].name;
  }
}

TEST(ScoreColorTest, MeasuresOverlapByCellsOfColour) {
  ColorModel model;
  model.colors = {{"red", {{1, {0, 0.7F, 0.7F}, {10, 0.1F, 0.1F}}}},
                  {"orange", {{1, {40, 0.7F, 0.7F}, {5, 0.1F, 0.1F}}}},
                  {"blue", {{1, {220, 0.7F, 0.7F}, {5, 0.1F, 0.1F}}}}};
  const ColorScores red = ScoreColor(model, ColorGrid(model), 0, {});
  const ColorScores orange = ScoreColor(model, ColorGrid(model), 1, {});
  ASSERT_EQ(red.overlaps.size(), 1U);
  ASSERT_EQ(orange.overlaps.size(), 1U);
  EXPECT_EQ(red.overlaps[0].color, "orange");
  EXPECT_GT(red.overlaps[0].share, 0.001);
  EXPECT_LT(red.overlaps[0].share, orange.overlaps[0].share) << "red has twice as many cells";
}

TEST_F(ColorEditorTest, WarningsAdviseWhatToMarkNext) {
  editor_.Mark({0, "green", StrokeTool::kRectangle, 0, {{10, 10}, {600, 60}}});
  EXPECT_THAT(editor_.Warnings("green"), Contains(HasSubstr("nearly gray")));
  while (editor_.Undo()) continue;
  editor_.Mark(On(0, 0));
  EXPECT_THAT(editor_.Warnings("red"), Contains(HasSubstr("marked on 1 of the frames")));
  EXPECT_THAT(editor_.Warnings("red"), Contains(HasSubstr("nothing is marked that it is not")));
  editor_.Mark(On(1, 0));
  editor_.Mark(On(2, 0));
  editor_.Mark(OnGround(0));
  EXPECT_THAT(editor_.Warnings("red"), Not(Contains(HasSubstr("frames"))));
  EXPECT_THAT(editor_.Warnings("red"), Not(Contains(HasSubstr("nothing is marked"))));
}

// An object found in an image: its class and place.
struct Found {
  std::string name;
  Eigen::Vector2d center_px;
};

class Finder {
 public:
  explicit Finder(const ObjectModel& model) : detector_(ObjectCamera(), model) {}

  std::vector<Found> Find(const cv::Mat& image) {
    detector_.Detect(image, {}, workspace_, &report_);
    std::vector<Found> found;
    for (const ObjectDetection& detection : report_.detections) {
      if (detection.completeness != Completeness::kWhole) continue;
      found.push_back({detector_.model().classes[detection.class_index].name, detection.center_px});
    }
    return found;
  }

 private:
  ObjectDetector detector_;
  ObjectWorkspace workspace_;
  ObjectReport report_;
};

bool IsAmong(const Found& object, const std::vector<Found>& others) {
  return std::ranges::any_of(others, [&](const Found& other) {
    return other.name == object.name && (other.center_px - object.center_px).norm() < 3;
  });
}

struct Agreement {
  int built_in = 0;  // objects that the built-in model finds
  int both = 0;      // those among them that the taught model finds, too
  int more = 0;      // found by the taught model only
};

Agreement Compare(const ObjectModel& taught, std::span<const cv::Mat> frames) {
  Agreement agreement;
  Finder built_in(DefaultObjectModel());
  Finder with_taught(taught);
  for (const cv::Mat& frame : frames) {
    const std::vector<Found> wanted = built_in.Find(frame);
    const std::vector<Found> found = with_taught.Find(frame);
    agreement.built_in += static_cast<int>(wanted.size());
    for (const Found& object : wanted) agreement.both += IsAmong(object, found);
    for (const Found& object : found) agreement.more += !IsAmong(object, wanted);
  }
  return agreement;
}

TEST_F(ColorEditorTest, TenStrokesMatchBuiltInModelInThreeLights) {
  for (std::size_t color = 0; color < kNames.size(); ++color) {
    editor_.Mark(On(0, color));
    editor_.Mark(On(2, color));
    editor_.Teach(kNames[color]);
  }
  ASSERT_EQ(editor_.draft().strokes().size(), 10U);
  const Agreement agreement = Compare(editor_.model(), frames_);
  EXPECT_GE(agreement.built_in, 12);
  EXPECT_GE(agreement.both, 0.99 * agreement.built_in);
  EXPECT_EQ(agreement.more, 0);
}

}  // namespace
}  // namespace kestrel

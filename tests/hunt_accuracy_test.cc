// SPDX-License-Identifier: BSD-3-Clause
// Limits for the object detector on the data sets, if they are there; bench/hunt_accuracy.cc prints
// the results in full.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hunt_score.h"
#include "kestrel/app/evaluation/object_truth.h"
#include "kestrel/app/evaluation/statistics.h"
#include "kestrel/calibration/color_training/color_editor.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/io/recording/open_source.h"
#include "real_frames.h"

namespace kestrel {
namespace {

std::string DataFolder(const std::string& name) {
  return std::string(KESTREL_DATA_DIR) + "/" + name;
}

bool IsThere(const std::string& name) { return std::filesystem::exists(DataFolder(name)); }

TEST(HuntRealTest, FindsDiscsAndNothingElse) {
  if (!IsThere("hunt_real")) GTEST_SKIP() << kNoRealFrames;
  const RealFrameScore score = ScoreRealFrame(DataFolder("hunt_real"));
  int found = 0;
  for (const RealDisc& disc : score.discs) {
    if (disc.color == "green") continue;  // a pile, which is one object in the image
    EXPECT_EQ(disc.found_as, disc.color);
    EXPECT_LE(disc.center_error_px, 3);
    ++found;
  }
  EXPECT_EQ(found, 4);
  EXPECT_EQ(score.single, 5) << "these and the pile";
}

class HuntHardTest : public testing::TestWithParam<const char*> {
 protected:
  std::string Name() const { return std::string("hunt_hard/") + GetParam(); }
};

TEST_P(HuntHardTest, FindsEveryWantedObjectAndNothingElse) {
  if (!IsThere(Name())) GTEST_SKIP() << kNoRealFrames;
  std::vector<double> center_errors_px, depth_errors;
  for (const ObjectComparison& c : ScoreHunt(DataFolder(Name())).comparisons) {
    EXPECT_TRUE(c.IsObject()) << "false " << c.detected_class;
    if (!c.is_wanted) continue;
    EXPECT_EQ(c.detected_class, c.true_class);
    center_errors_px.push_back(c.center_error_px);
    depth_errors.push_back(std::abs(c.depth_error.value_or(1)));
  }
  EXPECT_LE(Median(center_errors_px), 0.35);
  EXPECT_LE(Median(depth_errors), 0.015);
}

TEST_P(HuntHardTest, ReadsDigitsCorrectly) {
  if (!IsThere(Name())) GTEST_SKIP() << kNoRealFrames;
  const DigitScore digits = ScoreHunt(DataFolder(Name())).digits;
  EXPECT_GE(digits.right, 0.9 * digits.count);
}

// A click on the centre of an object.
ColorStroke ClickOn(const TrueSighting& sighting, const std::string& color,
                    const std::vector<Time>& times) {
  const auto frame = std::find(times.begin(), times.end(), sighting.time) - times.begin();
  const cv::Point middle(static_cast<int>(std::lround(sighting.center_px.x())),
                         static_cast<int>(std::lround(sighting.center_px.y())));
  return {static_cast<std::size_t>(frame), color, StrokeTool::kGrow, 30, {middle}};
}

// The built-in model, with each colour taught anew by a click on the first and on the last of its
// objects that are wholly in view.
ObjectModel TaughtModel(const std::string& folder) {
  const auto source = OpenSource({folder}, PixelFormat::kBgr);
  std::vector<Time> times;
  for (Frame frame; source->Next(&frame);) times.push_back(frame.time);
  const std::string truth = folder + "/mav0/objects0/";
  const TrueObjects objects = ParseTrueObjects(ReadFile(truth + "objects.csv"), "objects.csv");
  std::map<std::string, std::vector<ColorStroke>> strokes;
  for (const TrueSighting& sighting :
       ParseTrueSightings(ReadFile(truth + "data.csv"), "data.csv", objects)) {
    if (sighting.visible_fraction < 1) continue;
    const std::string& color = objects.at(sighting.id).class_name;
    strokes[color].push_back(ClickOn(sighting, color, times));
  }
  ColorEditor editor(DefaultObjectModel(), times.size(), [&](std::size_t index) {
    Frame frame;
    source->Read(index, &frame);
    return frame.image;
  });
  for (const auto& [color, of_color] : strokes) {
    editor.Mark(of_color.front());
    editor.Mark(of_color.back());
    editor.Teach(color);
  }
  EXPECT_LE(editor.draft().strokes().size(), 10U);
  return editor.model();
}

TEST(TaughtModelTest, TenStrokesMatchBuiltInModelAndFindNothingElse) {
  const std::string name = "hunt_hard/discs";
  if (!IsThere(name)) GTEST_SKIP() << kNoRealFrames;
  const auto found = [&](const ObjectModel& model) {
    int count = 0;
    for (const ObjectComparison& c : ScoreHunt(DataFolder(name), model).comparisons) {
      EXPECT_TRUE(c.IsObject()) << "false " << c.detected_class;
      count += c.IsObject() && c.detected_class == c.true_class;
    }
    return count;
  };
  EXPECT_GE(found(TaughtModel(DataFolder(name))), 0.99 * found(DefaultObjectModel()));
}

INSTANTIATE_TEST_SUITE_P(Sets, HuntHardTest, testing::Values("discs", "cuboids"));

}  // namespace
}  // namespace kestrel

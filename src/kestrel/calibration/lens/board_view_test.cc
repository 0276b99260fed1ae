// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/board_view.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/calibration/lens/test_board_images.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

CameraIntrinsics Webcam() {
  return {640, 480, 520, 520, 326, 233, DistortionModel::kRadialTangential, {-0.12, 0.05, 0, 0}};
}
CameraIntrinsics Fisheye() {
  return {640, 480, 230, 230, 316, 244, DistortionModel::kEquidistant, {0.01, -0.004, 0, 0}};
}

void ExpectLens(const CameraIntrinsics& truth, const std::string& text, double reach,
                double share) {
  LensCalibrationOptions options;
  options.board = ParseLensBoard(text);
  const auto images = RenderBoard(CameraModel(truth), *options.board, 24, reach, 7);
  const LensCalibration lens = CalibrateLens(images, options);
  EXPECT_NEAR(lens.intrinsics.fx_px / truth.fx_px, 1, 0.004) << text;
  EXPECT_NEAR(lens.intrinsics.cx_px, truth.cx_px, 3) << text;
  EXPECT_NEAR(lens.intrinsics.cy_px, truth.cy_px, 3) << text;
  EXPECT_GT(static_cast<double>(lens.found), share * static_cast<double>(images.size())) << text;
  EXPECT_LT(lens.fit.RootMeanSquare(), 0.3) << text;
}

// The focal length is right to 0.4 %.
TEST(BoardCalibrationTest, ChessboardDeterminesLens) {
  ExpectLens(Webcam(), "chessboard:9x6:0.025", 0.5, 0.7);
}
TEST(BoardCalibrationTest, ChessboardDeterminesFisheyeLens) {
  ExpectLens(Fisheye(), "chessboard:8x5:0.03", 0.6, 0.7);
}
TEST(BoardCalibrationTest, PartialViewsOfCharucoBoardDetermineLens) {
  ExpectLens(Webcam(), "charuco:7x5:0.04:0.03", 0.9, 0.7);
}
TEST(BoardCalibrationTest, PartialViewsOfAprilGridDetermineLens) {
  ExpectLens(Webcam(), "aprilgrid:6x6:0.088:0.3", 0.9, 0.7);
}

TEST(FindBoardTest, ReadsBothKindsOfCharucoBoards) {
  for (const bool begins_white : {false, true}) {
    LensBoard board = ParseLensBoard("charuco:6x8:0.03:0.022:DICT_5X5_100");
    board.begins_white = begins_white;
    const CameraModel camera(Webcam());
    const LensImage image = RenderBoard(camera, board, 1, 0, 3).front();
    const auto view = FindBoard(image.name, image.image,
                                ParseLensBoard("charuco:6x8:0.03:0.022:DICT_5X5_100"), Webcam());
    ASSERT_TRUE(view) << begins_white;
    EXPECT_EQ(view->edges.size(), 2u * 5 * 7) << begins_white;
  }
}

TEST(FindBoardTest, FindsNoViewInImageWithoutBoard) {
  const cv::Mat gray(480, 640, CV_8UC1, cv::Scalar(128));
  for (const char* text :
       {"chessboard:9x6:0.025", "charuco:7x5:0.04:0.03", "aprilgrid:6x6:0.088:0.3"}) {
    EXPECT_FALSE(FindBoard("gray", gray, ParseLensBoard(text), Webcam())) << text;
  }
}

TEST(ParseLensBoardTest, RefusesWrongBoardsAndNamesExpectedFormat) {
  const auto error = [](const std::string& text) {
    return InputErrorOf([&] { ParseLensBoard(text); });
  };
  EXPECT_THAT(error("circles:4x5:1"), HasSubstr("expected chessboard:9x6:0.025"));
  EXPECT_THAT(error("chessboard:9x6"), HasSubstr("expected chessboard:COLUMNSxROWS:SQUARE"));
  EXPECT_THAT(error("chessboard:9:0.025"), HasSubstr("columns and rows from 3 to 100"));
  EXPECT_THAT(error("chessboard:9x6:25"),
              HasSubstr("the side of a square (m) above 0 and below 10"));
  EXPECT_THAT(error("charuco:7x5:0.03:0.04"), HasSubstr("a marker (m) above 0 and below 0.03"));
  EXPECT_THAT(error("charuco:7x5:0.04:0.03:DICT_9X9"), HasSubstr("a dictionary as DICT_4X4_50"));
  EXPECT_THAT(error("charuco:20x20:0.04:0.03"), HasSubstr("at most 50 tags"));
}

TEST(ParseLensBoardTest, AcceptsOpenCvNamesOfDictionaries) {
  EXPECT_EQ(ParseLensBoard("charuco:7x5:0.04:0.03:DICT_5X5_100").family, "aruco_5x5_100");
  EXPECT_EQ(ParseLensBoard("charuco:7x5:0.04:0.03:DICT_APRILTAG_36h11").family, "tag36h11");
  EXPECT_EQ(ParseLensBoard("charuco:7x5:0.04:0.03:aruco_6x6_250").family, "aruco_6x6_250");
}

}  // namespace
}  // namespace kestrel

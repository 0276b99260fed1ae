// SPDX-License-Identifier: BSD-3-Clause
// Renders the files as a print shop does, and measures the result.
#include "kestrel/calibration/print/pattern_print.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/recording/media/image_file.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr double kInch_m = 0.0254;

bool CanRun(const std::string& program) {
  return std::system(fmt::format("command -v {} >/dev/null", program).c_str()) == 0;
}

// Renders a page (from 1); the renderer rounds its size up to whole pixels.
cv::Mat RenderPdf(const std::string& file, int page, double pixels_per_m) {
  const std::string image = file + ".page";
  const std::string command = fmt::format("pdftoppm -r {} -f {} -l {} -gray -singlefile '{}' '{}'",
                                          pixels_per_m * kInch_m, page, page, file, image);
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return ReadGrayImage(image + ".pgm");
}

cv::Mat RenderSvg(const std::string& file, double pixels_per_m) {
  const std::string image = file + ".png";
  const std::string command = fmt::format("rsvg-convert -d {0} -p {0} -b white -o '{1}' '{2}'",
                                          pixels_per_m * kInch_m, image, file);
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return ReadGrayImage(image);
}

// Length of black on the line between two points (m, from the upper left corner), in m; exact where
// the edges are at right angles to the line.
double BlackAlong(const cv::Mat& page, double pixels_per_m, const Vector2d& from,
                  const Vector2d& to) {
  constexpr double kStep_px = 0.05;
  const Vector2d way = (to - from) * pixels_per_m;
  const int steps = static_cast<int>(way.norm() / kStep_px);
  double black = 0;
  for (int i = 0; i < steps; ++i) {
    const Vector2d at = from * pixels_per_m + (i + 0.5) / steps * way - Vector2d(0.5, 0.5);
    const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
    const double u = at.x() - x, v = at.y() - y;
    const auto gray = [&](int row, int column) {
      return static_cast<double>(page.at<std::uint8_t>(std::clamp(row, 0, page.rows - 1),
                                                       std::clamp(column, 0, page.cols - 1)));
    };
    black += 255 - (1 - v) * ((1 - u) * gray(y, x) + u * gray(y, x + 1)) -
             v * ((1 - u) * gray(y + 1, x) + u * gray(y + 1, x + 1));
  }
  return black / 255 * way.norm() / steps / pixels_per_m;
}

class PatternPrintTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"pdftoppm", "rsvg-convert"}) {
      ASSERT_TRUE(CanRun(program)) << program << " is not there: scripts/install-deps";
    }
  }
  // 'tolerance' is in m.
  static void ExpectDimensions(const cv::Mat& page, double scale, const LandingPattern& pattern,
                               double tolerance) {
    const Vector2d center = Vector2d::Constant(0.5 * pattern.board_size_m);
    const auto black = [&](const Vector2d& from, const Vector2d& to) {
      return BlackAlong(page, scale, center + from, center + to);
    };
    const double middle = pattern.outer_radius_m() - 0.5 * pattern.ring_width_m;
    const double in_gap = 0.5 * (pattern.inner_radius_m() + pattern.arm_half_length_m);
    for (int eighth = 0; eighth < 8; ++eighth) {
      const double angle = eighth * kPi / 4;
      const Vector2d out(std::cos(angle), std::sin(angle));
      const Vector2d across(-out.y(), out.x());
      const double rim = 0.5 * (pattern.outer_radius_m() + 0.5 * pattern.board_size_m);
      EXPECT_NEAR(middle + black(middle * out, rim * out), pattern.outer_radius_m(), tolerance);
      EXPECT_NEAR(black(in_gap * out, rim * out), pattern.ring_width_m, tolerance);
      if (eighth % 2 == 0) continue;
      EXPECT_NEAR(black({0, 0}, in_gap * out), pattern.arm_half_length_m, tolerance);
      const double reach = 0.6 * pattern.arm_half_length_m;
      const Vector2d aside = pattern.arm_width_m * across;
      EXPECT_NEAR(black(reach * out - aside, reach * out + aside), pattern.arm_width_m, tolerance);
    }
  }

  TestFolder folder_;
};

TEST_F(PatternPrintTest, PageHasDimensionsOfPattern) {
  const LandingPattern large;
  const LandingPattern small{.outer_diameter_m = 0.3,
                             .ring_width_m = 0.035,
                             .arm_width_m = 0.028,
                             .arm_half_length_m = 0.1,
                             .board_size_m = 0.4};
  for (const LandingPattern& pattern : {large, small}) {
    const double scale = 3000;  // px/m
    PrintPatternPdf(PrintOf(pattern), folder_ / "p.pdf");
    const cv::Mat pdf = RenderPdf(folder_ / "p.pdf", 1, scale);
    ASSERT_NEAR(pdf.cols, scale * pattern.board_size_m, 1);
    ASSERT_NEAR(pdf.rows, scale * pattern.board_size_m, 1);
    ExpectDimensions(pdf, scale, pattern, 0.00015);
    PrintPatternSvg(PrintOf(pattern), folder_ / "p.svg");
    const cv::Mat svg = RenderSvg(folder_ / "p.svg", scale);
    ASSERT_NEAR(svg.cols, scale * pattern.board_size_m, 1);
    ExpectDimensions(svg, scale, pattern, 0.00015);
  }
}

TEST_F(PatternPrintTest, ArmsIntoRingEndWithIt) {
  const LandingPattern pattern{.arm_half_length_m = 0.5};
  PrintPatternPdf(PrintOf(pattern), folder_ / "p.pdf");
  const double scale = 4000;
  const cv::Mat page = RenderPdf(folder_ / "p.pdf", 1, scale);
  const Vector2d center = Vector2d::Constant(0.5 * pattern.board_size_m);
  for (const double degrees : {45.0, 50.0, 40.0, 0.0}) {
    const Vector2d out(std::cos(Radians(degrees)), std::sin(Radians(degrees)));
    EXPECT_NEAR(BlackAlong(page, scale, center + 0.45 * out, center + 0.55 * out), 0.05, 0.0002);
  }
}

// The middle of a line across 'window' (px) of an upright page, in px from the page's left edge.
double LineAt(const cv::Mat& page, const cv::Rect& window) {
  cv::Mat ink;
  cv::reduce(255 - page(window), ink, 0, cv::REDUCE_SUM, CV_64F);
  double sum = 0, moment = 0;
  for (int i = 0; i < ink.cols; ++i) {
    sum += ink.at<double>(i);
    moment += (i + 0.5) * ink.at<double>(i);
  }
  return window.x + moment / sum;
}

// The positions of a page's cut marks: left and right edge of its tile, in px from the page's left.
Vector2d CutMarks(const cv::Mat& page, double scale, const Tiling& tiling) {
  Vector2d marks;
  for (const int right : {0, 1}) {
    const double x = tiling.tile_on_sheet.x() + right * tiling.tile.x();
    const cv::Rect window(static_cast<int>((x - 0.0009) * scale),
                          static_cast<int>((tiling.tile_on_sheet.y() - 0.0045) * scale),
                          static_cast<int>(0.0018 * scale), static_cast<int>(0.003 * scale));
    marks[right] = LineAt(page, window);
  }
  return marks;
}

// The board, glued together from sheets that were cut at their marks.
cv::Mat Assemble(const std::vector<std::string>& sheets, double scale, const Tiling& tiling,
                 const TargetPrint& print) {
  Tiling turned = tiling;
  turned.tile_on_sheet.reverseInPlace();
  turned.tile.reverseInPlace();
  const int side = static_cast<int>(scale * print.board_size_m);
  cv::Mat board(side, side, CV_8UC1, cv::Scalar(255));
  std::size_t used = 0;
  for (int i = 0; i < tiling.count(); ++i) {
    if (!HasPrint(print, tiling, i / tiling.columns, i % tiling.columns)) continue;
    const cv::Mat sheet = ReadGrayImage(sheets.at(used++));
    const Vector2d across = CutMarks(sheet, scale, tiling);
    const Vector2d down = CutMarks(sheet.t(), scale, turned);
    EXPECT_NEAR((across[1] - across[0]) / scale, tiling.tile.x(), 0.0001);
    EXPECT_NEAR((down[1] - down[0]) / scale, tiling.tile.y(), 0.0001);
    const Vector2d corner = scale * tiling.TileOnBoard(i / tiling.columns, i % tiling.columns);
    const Vector2d end = corner + scale * tiling.tile;
    const cv::Rect place(cv::Point(cvRound(corner.x()), cvRound(corner.y())),
                         cv::Point(cvRound(end.x()), cvRound(end.y())));
    // Maps the board's pixels to the sheet's, whose centres are at halves.
    const cv::Matx23d sheet_from_board(1, 0, place.x - corner.x() + across[0], 0, 1,
                                       place.y - corner.y() + down[0]);
    cv::warpAffine(sheet, board(place), sheet_from_board, place.size(),
                   cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  }
  EXPECT_EQ(used, sheets.size()) << "blank sheets";
  return board;
}

TEST_F(PatternPrintTest, TilesJoinWithoutGap) {
  const LandingPattern pattern;
  const double scale = 2000;  // a pixel is half a millimetre
  PrintPatternPdf(PrintOf(pattern), folder_ / "p.pdf");
  const int side = static_cast<int>(scale * pattern.board_size_m);
  const cv::Mat page = RenderPdf(folder_ / "p.pdf", 1, scale);
  const cv::Mat black = page(cv::Rect(0, 0, side, side)) < 100;  // the notes are lighter
  cv::Mat thinner, thicker;
  cv::erode(black, thinner, cv::Mat::ones(3, 3, CV_8U));
  cv::dilate(black, thicker, cv::Mat::ones(3, 3, CV_8U));
  for (const char* paper : {"a4", "a2"}) {
    const Tiling tiling = TileBoard(pattern.board_size_m, *PaperSize(paper));
    PrintTilesPdf({{PrintOf(pattern), tiling}}, folder_ / "tiles.pdf");
    const std::string command = fmt::format("pdftoppm -r {} -gray -f 2 '{}' '{}'", scale * kInch_m,
                                            folder_ / "tiles.pdf", folder_ / paper);
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::vector<std::string> sheets;
    cv::glob(folder_ / (std::string(paper) + "-*.pgm"), sheets);
    ASSERT_LE(std::ssize(sheets), tiling.count());
    const cv::Mat glued = Assemble(sheets, scale, tiling, PrintOf(pattern)) < 128;
    ASSERT_EQ(glued.size(), black.size());
    EXPECT_EQ(cv::countNonZero(thinner & ~glued), 0) << paper << ": white where black should be";
    EXPECT_EQ(cv::countNonZero(glued & ~thicker), 0) << paper << ": black where white should be";
  }
}

TEST_F(PatternPrintTest, RulersHaveTrueLength) {
  const LandingPattern pattern;
  EXPECT_DOUBLE_EQ(RulerLength(pattern.board_size_m), 0.2);
  EXPECT_DOUBLE_EQ(RulerLength(0.43), 0.1);
  const double scale = 2000;
  PrintPatternSvg(PrintOf(pattern), folder_ / "p.svg");
  const cv::Mat page = RenderSvg(folder_ / "p.svg", scale);
  // The long ticks at the ends of the lower ruler are longer than those between.
  const double base = 1.5 - 0.006, tick = 0.00325;
  const cv::Rect window(static_cast<int>(0.0110 * scale), static_cast<int>((base - tick) * scale),
                        static_cast<int>(0.002 * scale), 1);
  cv::Rect end = window;
  end.x += static_cast<int>(0.2 * scale);
  EXPECT_NEAR((LineAt(page, end) - LineAt(page, window)) / scale, 0.2, 0.0001);
}

TEST_F(PatternPrintTest, RefusesUnprintablePattern) {
  const TargetPrint print = PrintOf(LandingPattern());
  EXPECT_THROW(PrintPatternPdf(PrintOf({.board_size_m = 6}), folder_ / "p.pdf"), InputError);
  EXPECT_THROW(PrintPatternPdf(print, folder_ / "none/p.pdf"), InputError);
  EXPECT_THROW(PrintPatternSvg(print, folder_ / "none/p.svg"), InputError);
}

}  // namespace
}  // namespace kestrel

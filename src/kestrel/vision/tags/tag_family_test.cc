// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_family.h"

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/tags/test_aruco_dictionary.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Property;
using ::testing::ThrowsMessage;

// Draws a tag on gray, 'cell_px' pixels per cell.
cv::Mat Drawn(const TagGrid& grid, int cell_px) {
  const int margin = 2 * cell_px;
  const int side = grid.width * cell_px + 2 * margin;
  cv::Mat image(side, side, CV_8UC1, cv::Scalar(128));
  for (int row = 0; row < grid.width; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const TagCell cell = grid.at(column, row);
      if (cell == TagCell::kNone) continue;
      image(cv::Rect(margin + column * cell_px, margin + row * cell_px, cell_px, cell_px))
          .setTo(cell == TagCell::kWhite ? 255 : 0);
    }
  }
  return image;
}

struct AprilTagCase {
  const char* name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

class AprilTagFamilyTest : public testing::TestWithParam<AprilTagCase> {
 protected:
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family_{
      GetParam().create(), GetParam().destroy};
};

TEST_P(AprilTagFamilyTest, MatchesPictureOfLibapriltag) {
  const TagFamily family(GetParam().name);
  EXPECT_EQ(family.id_count(), static_cast<int>(family_->ncodes));
  for (const int id : {0, 7, family.id_count() - 1}) {
    const TagGrid grid = family.Grid(id);
    // libapriltag does not export the function that frees an image.
    const std::unique_ptr<image_u8_t, void (*)(void*)> picture(apriltag_to_image(family_.get(), id),
                                                               std::free);
    const std::unique_ptr<std::uint8_t, void (*)(void*)> pixels(picture->buf, std::free);
    ASSERT_EQ(grid.width, picture->width);
    for (int row = 0; row < grid.width; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        if (grid.at(column, row) == TagCell::kNone) continue;
        EXPECT_EQ(grid.at(column, row) == TagCell::kWhite,
                  pixels.get()[row * picture->stride + column] > 0)
            << "id " << id << " row " << row << " column " << column;
      }
    }
  }
}

TEST_P(AprilTagFamilyTest, IsReadByLibapriltagUpright) {
  const std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector(
      apriltag_detector_create(), apriltag_detector_destroy);
  constexpr int kCorrectedBits = 0;  // the table of corrections takes a minute for 42,000 ids
  apriltag_detector_add_family_bits(detector.get(), family_.get(), kCorrectedBits);
  const TagGrid grid = TagFamily(GetParam().name).Grid(5);
  constexpr int kCellPx = 12;
  cv::Mat image = Drawn(grid, kCellPx);
  image_u8_t view{image.cols, image.rows, static_cast<int>(image.step), image.data};
  zarray_t* found = apriltag_detector_detect(detector.get(), &view);
  ASSERT_EQ(zarray_size(found), 1);
  apriltag_detection_t* detection = nullptr;
  zarray_get(found, 0, static_cast<void*>(&detection));
  EXPECT_EQ(detection->id, 5);
  // The first corner is the lower left one of the square that the size refers to, then
  // anticlockwise.
  const double low = (2 + grid.margin()) * kCellPx;
  const double high = low + grid.border_width * kCellPx;
  const double corners[4][2] = {{low, high}, {high, high}, {high, low}, {low, low}};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(detection->p[i][0], corners[i][0], 1) << i;
    EXPECT_NEAR(detection->p[i][1], corners[i][1], 1) << i;
  }
  apriltag_detections_destroy(found);
}

INSTANTIATE_TEST_SUITE_P(
    Families, AprilTagFamilyTest,
    testing::Values(AprilTagCase{"tag36h11", tag36h11_create, tag36h11_destroy},
                    AprilTagCase{"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy},
                    AprilTagCase{"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy},
                    AprilTagCase{"tagStandard41h12", tagStandard41h12_create,
                                 tagStandard41h12_destroy}),
    [](const auto& test) { return std::string(test.param.name); });

struct ArucoCase {
  const char* name;
  int dictionary;
};

class ArucoFamilyTest : public testing::TestWithParam<ArucoCase> {};

TEST_P(ArucoFamilyTest, OpenCvReadsEveryIdUpright) {
  const cv::aruco::Dictionary dictionary = ArucoDictionary(GetParam().dictionary);
  const TagFamily family(GetParam().name);
  ASSERT_EQ(family.id_count(), dictionary.bytesList.rows);
  EXPECT_EQ(family.min_distance(), 2 * dictionary.maxCorrectionBits + 1);
  for (int id = 0; id < family.id_count(); ++id) {
    const TagGrid grid = family.Grid(id);
    cv::Mat bits(dictionary.markerSize, dictionary.markerSize, CV_8UC1);
    for (int row = 0; row < bits.rows; ++row) {
      for (int column = 0; column < bits.cols; ++column) {
        bits.at<std::uint8_t>(row, column) = grid.at(column + 2, row + 2) == TagCell::kWhite;
      }
    }
    int found = -1;
    int turned = -1;
    ASSERT_TRUE(dictionary.identify(bits, found, turned, 0)) << id;
    ASSERT_EQ(found, id);
    ASSERT_EQ(turned, 0) << id;
  }
}

INSTANTIATE_TEST_SUITE_P(Families, ArucoFamilyTest,
                         testing::Values(ArucoCase{"aruco_4x4_50", cv::aruco::DICT_4X4_50},
                                         ArucoCase{"aruco_4x4_100", cv::aruco::DICT_4X4_100},
                                         ArucoCase{"aruco_4x4_250", cv::aruco::DICT_4X4_250},
                                         ArucoCase{"aruco_4x4_1000", cv::aruco::DICT_4X4_1000},
                                         ArucoCase{"aruco_5x5_50", cv::aruco::DICT_5X5_50},
                                         ArucoCase{"aruco_5x5_100", cv::aruco::DICT_5X5_100},
                                         ArucoCase{"aruco_5x5_250", cv::aruco::DICT_5X5_250},
                                         ArucoCase{"aruco_5x5_1000", cv::aruco::DICT_5X5_1000},
                                         ArucoCase{"aruco_6x6_50", cv::aruco::DICT_6X6_50},
                                         ArucoCase{"aruco_6x6_100", cv::aruco::DICT_6X6_100},
                                         ArucoCase{"aruco_6x6_250", cv::aruco::DICT_6X6_250},
                                         ArucoCase{"aruco_6x6_1000", cv::aruco::DICT_6X6_1000},
                                         ArucoCase{"aruco_7x7_50", cv::aruco::DICT_7X7_50},
                                         ArucoCase{"aruco_7x7_100", cv::aruco::DICT_7X7_100},
                                         ArucoCase{"aruco_7x7_250", cv::aruco::DICT_7X7_250},
                                         ArucoCase{"aruco_7x7_1000", cv::aruco::DICT_7X7_1000},
                                         ArucoCase{"aruco_original",
                                                   cv::aruco::DICT_ARUCO_ORIGINAL}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(TagFamilyTest, EveryFamilyHasItsBorders) {
  for (const std::string& name : TagFamily::Names()) {
    const TagFamily family(name);
    const TagGrid grid = family.Grid(0);
    EXPECT_GE(family.min_distance(), name.starts_with("aruco") ? 1 : 5) << name;
    const int inside = grid.margin();
    for (int i = 0; i < grid.border_width; ++i) {
      EXPECT_EQ(grid.at(inside + i, inside), grid.at(inside, inside)) << name;
      EXPECT_NE(grid.at(inside + i, inside - 1), grid.at(inside, inside)) << name;
      EXPECT_NE(grid.at(inside - 1, inside + i), TagCell::kNone) << name;
    }
  }
}

TEST(TagFamilyTest, KnowsNamesOfOpenCv) {
  for (const char* name : {"DICT_4X4_50", "4x4_50", "4X4_50"}) {
    EXPECT_EQ(TagFamily(name).name(), "aruco_4x4_50");
  }
  EXPECT_EQ(TagFamily("DICT_7X7_1000").name(), "aruco_7x7_1000");
  EXPECT_EQ(TagFamily("DICT_ARUCO_ORIGINAL").name(), "aruco_original");
  EXPECT_EQ(TagFamily("DICT_APRILTAG_36h11").name(), "tag36h11");
  EXPECT_THAT([] { TagFamily("DICT_9X9_50"); }, ThrowsMessage<InputError>(HasSubstr("aruco_")));
}

TEST(TagFamilyTest, ErrorsNameNearestFamilyAndValidIds) {
  EXPECT_THAT(
      [] { TagFamily("tag36h1"); },
      ThrowsMessage<InputError>("unknown family of tags 'tag36h1', did you mean 'tag36h11'?"));
  EXPECT_THAT([] { TagFamily("ARUCO_4x4_50"); }, ThrowsMessage<InputError>(HasSubstr("aruco_")));
  EXPECT_THAT([] { TagFamily("aruco_4x4_50").Grid(50); },
              ThrowsMessage<InputError>("aruco_4x4_50 has no id 50, expected 0 to 49"));
  EXPECT_THROW(TagFamily("tag16h5").Grid(-1), InputError);
}

}  // namespace
}  // namespace kestrel

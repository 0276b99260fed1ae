// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_board_detector.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/tags/plain_tags.h"
#include "kestrel/vision/tags/test_fractal_marker.h"
#include "kestrel/vision/tags/test_tag_images.h"
#include "kestrel/vision/tags/test_tagless_pictures.h"

namespace kestrel {
namespace {

BoardTag OneTag(const std::string& family, int id, double size_m) {
  BoardTag tag;
  tag.family = family;
  tag.id = id;
  tag.size_m = size_m;
  return tag;
}

// Errors of a detection against the true pose.
struct PoseError {
  double place;    // as a share of the true distance
  double angle;    // rad
  double squared;  // by the covariance: chi-squared with six degrees of freedom
};

PoseError ErrorOf(const TargetDetection& detection, const RigidTransform& truth) {
  const RigidTransform& found = detection.camera_from_target;
  Eigen::Matrix<double, 6, 1> error;
  error.head<3>() = found.translation - truth.translation;
  error.tail<3>() = RotationVector(found.rotation * truth.rotation.conjugate());
  return {error.head<3>().norm() / truth.translation.norm(), error.tail<3>().norm(),
          error.dot(detection.covariance.ldlt().solve(error))};
}

class TagBoardDetectorTest : public testing::Test {
 protected:
  void Use(const TagBoard& board) {
    board_ = board;
    detector_ = std::make_unique<TagBoardDetector>(camera_, board, TagBoardDetectorOptions());
    workspace_ = detector_->MakeWorkspace();
  }
  cv::Mat Image(const RigidTransform& pose, std::uint64_t seed) const {
    return renderer_.Render(board_.Printed(), pose, taken_, seed);
  }
  TargetReport Detect(const cv::Mat& image, const TargetHint& hint = {}) {
    return detector_->Detect(image, hint, *workspace_);
  }
  // A hint by a track: near the true place.
  static TargetHint Expected(const RigidTransform& pose, double sigma_m, Random* random) {
    TargetHint hint;
    const double x = random->Normal();
    const double y = random->Normal();
    const double z = random->Normal();
    hint.center_in_camera = pose.translation + sigma_m * Eigen::Vector3d(x, y, z);
    hint.center_sigma_m = sigma_m;
    hint.up_in_camera = pose.rotation * Eigen::Vector3d::UnitZ();
    return hint;
  }

  const CameraModel camera_{PaperCamera()};
  const TagRenderer renderer_{camera_};
  TagImageOptions taken_;
  TagBoard board_;
  std::unique_ptr<TagBoardDetector> detector_;
  std::unique_ptr<TargetWorkspace> workspace_;
};

struct FamilyCase {
  const char* family;
  int id;
  double farthest;  // m, with 0.5 m and 261 px per rad
};

class FamilyTest : public TagBoardDetectorTest, public testing::WithParamInterface<FamilyCase> {};

TEST_P(FamilyTest, IsFoundWithoutHintAtAnyHeight) {
  Use({{OneTag(GetParam().family, GetParam().id, 0.5)}});
  Random random(3);
  int found = 0, frames = 0;
  for (double height = 0.6; height < GetParam().farthest; height *= 1.25) {
    const RigidTransform pose = RandomBoardBelow(height, 0.35, 0.15, &random);
    const TargetReport report = Detect(Image(pose, random.Bits()));
    ++frames;
    if (!report.detection) {
      continue;
    }
    ++found;
    const PoseError error = ErrorOf(*report.detection, pose);
    EXPECT_LT(error.place, 0.03) << height;
    EXPECT_EQ(report.detection->id, GetParam().id);
    EXPECT_EQ(report.detection->heading_symmetry, 1);
    EXPECT_EQ(report.detection->method, DetectionMethod::kTags);
  }
  EXPECT_GE(found, frames - 1);
}

INSTANTIATE_TEST_SUITE_P(Families, FamilyTest,
                         testing::Values(FamilyCase{"tag36h11", 7, 5}, FamilyCase{"tag16h5", 3, 7},
                                         FamilyCase{"tagStandard41h12", 9, 4},
                                         FamilyCase{"tagCircle21h7", 5, 4},
                                         FamilyCase{"tagCustom48h12", 100, 4},
                                         FamilyCase{"aruco_4x4_50", 7, 7},
                                         FamilyCase{"aruco_6x6_250", 23, 5}),
                         [](const auto& test) { return std::string(test.param.family); });

TEST_F(TagBoardDetectorTest, FindsFractalMarkerUntilOnlyInnerMarkerIsInView) {
  Use(ParseTagBoard(FractalMarkerText(), "fractal.yml", "", 0.6));
  Random random(17);
  for (double height = 5; height > 0.12; height *= 0.8) {
    const RigidTransform pose = RandomBoardBelow(height, 0.1, 0.1, &random);
    const TargetReport report = Detect(Image(pose, random.Bits()));
    ASSERT_TRUE(report.detection) << height;
    EXPECT_LT(ErrorOf(*report.detection, pose).place, 0.03) << height;
    EXPECT_EQ(report.detection->heading_symmetry, 1);
  }
}

TEST_F(TagBoardDetectorTest, RejectsAnotherFractalMarker) {
  const TagBoard other = ParseTagBoard(FractalMarkerText(), "fractal.yml", "", 0.6);
  std::string text = FractalMarkerText();
  for (std::size_t at = text.find("bits:"); at < text.find("corners:"); ++at) {
    if (text[at] == '0' || text[at] == '1') text[at] = text[at] == '0' ? '1' : '0';
  }
  TagBoard board = ParseTagBoard(text, "fractal.yml", "", 0.6);
  board.tags.resize(1);  // both have the same inner marker
  Use(board);
  board_ = other;
  Random random(18);
  for (double height = 4; height > 0.5; height *= 0.8) {
    EXPECT_FALSE(
        Detect(Image(RandomBoardBelow(height, 0.1, 0.1, &random), random.Bits())).detection)
        << height;
  }
}

TEST_F(TagBoardDetectorTest, ErrorsMatchCovariance) {
  Use({{OneTag("tag36h11", 7, 0.5)}});
  Random random(11);
  std::vector<double> squared;
  for (int i = 0; i < 40; ++i) {
    const double height = random.Uniform(0.8, 4);
    const RigidTransform pose = RandomBoardBelow(height, 0.3, 0.1, &random);
    const TargetHint hint = Expected(pose, 0.1, &random);
    const TargetReport report = Detect(Image(pose, random.Bits()), hint);
    if (report.detection) squared.push_back(ErrorOf(*report.detection, pose).squared);
  }
  ASSERT_GE(squared.size(), 39u);
  const double nees = std::accumulate(squared.begin(), squared.end(), 0.0) / (6 * squared.size());
  EXPECT_GT(nees, 0.3);
  EXPECT_LT(nees, 1.5);
}

TEST_F(TagBoardDetectorTest, NeverAcceptsAnotherId) {
  for (const char* family : {"tag36h11", "aruco_4x4_50"}) {
    Use({{OneTag(family, 7, 0.5)}});
    Random random(5);
    for (int i = 0; i < 40; ++i) {
      const double height = random.Uniform(0.7, 4);
      const int id = random.Integer(8, 40 - 12 * (family[0] == 't'));
      const RigidTransform pose = RandomBoardBelow(height, 0.3, 0.1, &random);
      const TagBoard other{{OneTag(family, id, 0.5)}};
      const cv::Mat image = renderer_.Render(other.Printed(), pose, taken_, random.Bits());
      TargetHint hint = Expected(pose, 0.02, &random);
      EXPECT_FALSE(Detect(image).detection) << family << " " << id;
      hint.rotation_in_camera = pose.rotation;
      EXPECT_FALSE(Detect(image, hint).detection) << family << " " << id;
    }
  }
}

// A large tag, a small one in its empty centre, and an inverted one beside it.
TagBoard NestedBoard() {
  BoardTag beside = OneTag("aruco_4x4_50", 4, 0.12);
  beside.inverted = true;
  beside.board_from_tag.translation = {0.62, 0.2, 0};
  return {{OneTag("tagCustom48h12", 0, 0.6), OneTag("tag36h11", 1, 0.15), beside}};
}

TEST_F(TagBoardDetectorTest, FindsNestedBoardFromFarToNearWithoutJump) {
  Use(NestedBoard());
  const Eigen::Vector3d tilt(0.05, -0.03, 0);
  std::optional<RigidTransform> last;
  for (double height = 4; height > 0.12; height *= 0.85) {
    const RigidTransform pose = BoardBelow(height, {0.05 * height, 0.02 * height}, 0.4, tilt);
    TargetHint hint;
    if (last) {
      const double error = std::min(0.01, 0.03 * height);
      hint.center_in_camera = pose.translation + Eigen::Vector3d(error, -error, error);
      hint.center_sigma_m = 2 * error;
      hint.rotation_in_camera = last->rotation;
      hint.up_in_camera = pose.rotation * Eigen::Vector3d::UnitZ();
    }
    const TargetReport report = Detect(Image(pose, 1), hint);
    ASSERT_TRUE(report.detection) << height << " " << report.reason;
    const PoseError error = ErrorOf(*report.detection, pose);
    EXPECT_LT(error.place, 0.01) << height;
    EXPECT_LT(error.angle, 0.05) << height;
    EXPECT_EQ(report.detection->id, 0);
    last = report.detection->camera_from_target;
  }
}

// The place is found to a part of a cell of the large tag, which is many cells of the small ones.
TEST_F(TagBoardDetectorTest, FollowsNestedBoardToCellsOfSmallTags) {
  BoardTag over = OneTag("tag36h11", 2, 0.08);
  over.board_from_tag.translation = {0.25, 0.25, 0};
  over.over = true;
  Use({{OneTag("tagCustom48h12", 0, 1), OneTag("tag36h11", 1, 0.25), over}});
  Random random(23);
  for (const double height : {0.6, 0.8, 1.1}) {
    const RigidTransform pose = RandomBoardBelow(height, 0.2, 0.1, &random);
    const cv::Mat image = Image(pose, random.Bits());
    for (int i = 0; i < 100; ++i) {
      TargetHint hint = Expected(pose, 0.02, &random);
      hint.rotation_in_camera = pose.rotation;
      const TargetReport report = Detect(image, hint);
      ASSERT_TRUE(report.detection) << height << " " << i << " " << report.reason;
      EXPECT_EQ(report.detection->method, DetectionMethod::kFollowed);
      EXPECT_EQ(report.detection->parts.all().size(), board_.tags.size());
      EXPECT_LT(ErrorOf(*report.detection, pose).place, 0.001) << height << " " << i;
    }
  }
}

TEST_F(TagBoardDetectorTest, FollowsQuarterOfTag) {
  Use({{OneTag("tag36h11", 7, 0.5)}});
  Random random(8);
  int found = 0;
  constexpr int kFrames = 20;
  for (int i = 0; i < kFrames; ++i) {
    // One corner of the tag is in view: its middle is near the corner of the image.
    const double heading = random.Uniform(-kPi, kPi);
    const double x = random.Uniform(0.3, 0.42);
    const RigidTransform pose = BoardBelow(0.35, {x, 0.3}, heading, Eigen::Vector3d::Zero());
    TargetHint hint = Expected(pose, 0.01, &random);
    hint.rotation_in_camera = pose.rotation;
    const TargetReport report = Detect(Image(pose, random.Bits()), hint);
    if (!report.detection) {
      continue;
    }
    ++found;
    EXPECT_LT(ErrorOf(*report.detection, pose).place, 0.02);
    EXPECT_EQ(report.detection->method, DetectionMethod::kFollowed);
  }
  EXPECT_GE(found, kFrames - 2);
}

TEST_F(TagBoardDetectorTest, NearTagFarFromHintIsFoundRightOrNotAtAll) {
  Use({{OneTag("tag36h11", 7, 0.5)}});
  Random random(17);
  int found = 0;
  std::vector<double> squared;
  constexpr int kFrames = 60;
  for (int i = 0; i < kFrames; ++i) {
    const double height = random.Uniform(0.3, 0.6);
    const RigidTransform pose = RandomBoardBelow(height, 0.5, 0.2, &random);
    TargetHint hint = Expected(pose, 0.04, &random);
    hint.rotation_in_camera = pose.rotation;
    const TargetReport report = Detect(Image(pose, random.Bits()), hint);
    if (!report.detection) continue;
    ++found;
    const PoseError error = ErrorOf(*report.detection, pose);
    EXPECT_LT(error.place, 0.01) << i;
    EXPECT_LT(error.angle, 0.01) << i;
    squared.push_back(error.squared);
  }
  EXPECT_GE(found, kFrames * 9 / 10);
  const double nees = std::accumulate(squared.begin(), squared.end(), 0.0) / (6 * squared.size());
  EXPECT_GT(nees, 0.1);
  EXPECT_LT(nees, 1.5);
}

TEST_F(TagBoardDetectorTest, FollowsTagThroughBlurAndShadow) {
  Use({{OneTag("tag36h11", 7, 0.5)}});
  Random random(9);
  taken_.motion_px = 5;
  taken_.shadow = true;
  int found = 0;
  constexpr int kFrames = 20;
  for (int i = 0; i < kFrames; ++i) {
    const double height = random.Uniform(1, 2.5);
    const RigidTransform pose = RandomBoardBelow(height, 0.3, 0.1, &random);
    TargetHint hint = Expected(pose, 0.02, &random);
    hint.rotation_in_camera = pose.rotation;
    const TargetReport report = Detect(Image(pose, random.Bits()), hint);
    if (!report.detection) {
      continue;
    }
    ++found;
    EXPECT_LT(ErrorOf(*report.detection, pose).place, 0.03);
  }
  EXPECT_GE(found, kFrames - 2);
}

TEST_F(TagBoardDetectorTest, FindsEachOfTwoPadsOfFamilyAtItsPlace) {
  TagBoard pads{{OneTag("tag36h11", 7, 0.5), OneTag("tag36h11", 8, 0.5)}};
  pads.tags[0].board_from_tag.translation.x() = -0.6;
  pads.tags[1].board_from_tag.translation.x() = 0.6;
  Random random(23);
  for (const std::size_t own : {0, 1}) {
    Use({{OneTag("tag36h11", pads.tags[own].id, 0.5)}});
    const Eigen::Vector3d& place = pads.tags[own].board_from_tag.translation;
    const Eigen::Vector3d& others = pads.tags[1 - own].board_from_tag.translation;
    for (int i = 0; i < 10; ++i) {
      const RigidTransform pose = RandomBoardBelow(random.Uniform(2, 5), 0.2, 0.1, &random);
      const cv::Mat image = renderer_.Render(pads.Printed(), pose, taken_, random.Bits());
      RigidTransform pad = pose;
      pad.translation = pose * place;
      const TargetReport found = Detect(image);
      ASSERT_TRUE(found.detection) << i;
      EXPECT_EQ(found.detection->id, pads.tags[own].id);
      EXPECT_LT(ErrorOf(*found.detection, pad).place, 0.02) << i;
      // A track that has strayed to the other pad does not hold on to it.
      TargetHint strayed;
      strayed.center_in_camera = pose * others;
      strayed.center_sigma_m = 0.05;
      strayed.rotation_in_camera = pose.rotation;
      const TargetReport followed = Detect(image, strayed);
      EXPECT_TRUE(!followed.detection || ErrorOf(*followed.detection, pad).place < 0.02) << i;
    }
  }
}

TEST_F(TagBoardDetectorTest, FindsTagWithoutHintUnderShadowEdge) {
  Use({{OneTag("tag36h11", 7, 0.5)}});
  Random random(19);
  taken_.shadow = true;
  int found = 0;
  constexpr int kFrames = 20;
  for (int i = 0; i < kFrames; ++i) {
    taken_.contrast = random.Uniform(0.85, 1);
    const RigidTransform pose = RandomBoardBelow(random.Uniform(0.8, 5), 0.3, 0.1, &random);
    const TargetReport report = Detect(Image(pose, random.Bits()));
    if (!report.detection) continue;
    ++found;
    EXPECT_LT(ErrorOf(*report.detection, pose).place, 0.03) << i;
  }
  EXPECT_GE(found, kFrames - 2);
}

TEST_F(TagBoardDetectorTest, DotInMiddleOfEachCellHidesNoBit) {
  Use(BoardOfTag("aruco_4x4_50", 7, 0.6));
  const PrintedTag printed = board_.Printed().front();
  Random random(29);
  for (double height = 1; height < 2.5; height *= 1.2) {
    const RigidTransform pose = RandomBoardBelow(height, 0.3, 0.1, &random);
    cv::Mat image = Image(pose, random.Bits());
    for (int row = 0; row < printed.grid.width; ++row) {
      for (int column = 0; column < printed.grid.width; ++column) {
        const Eigen::Vector2d middle = printed.OnBoard(column + 0.5, row + 0.5);
        Eigen::Vector2d pixel;
        ASSERT_EQ(camera_.Project(pose * Eigen::Vector3d(middle.x(), middle.y(), 0), &pixel),
                  ProjectionStatus::kOk);
        const bool is_white = printed.grid.at(column, row) == TagCell::kWhite;
        cv::circle(image, cv::Point(cv::Point2d(pixel.x() + 0.5, pixel.y() + 0.5)), 1,
                   cv::Scalar(is_white ? 30 : 215), cv::FILLED);
      }
    }
    EXPECT_TRUE(Detect(image).detection) << height;
  }
}

// In the logarithms a light cell that blurs into the margin cuts the frame.
TEST_F(TagBoardDetectorTest, FindsTagWithLightCellsBlurredIntoMargin) {
  Use({{OneTag("tag36h11", 7, 0.5)}});
  Random random(31);
  taken_.blur_px = 1;
  taken_.contrast = 1.3;
  int found = 0;
  constexpr int kFrames = 40;
  for (int i = 0; i < kFrames; ++i) {
    const RigidTransform pose = RandomBoardBelow(random.Uniform(7, 9), 0.3, 0.1, &random);
    const TargetReport report = Detect(Image(pose, random.Bits()));
    if (!report.detection) continue;
    ++found;
    EXPECT_LT(ErrorOf(*report.detection, pose).place, 0.05) << i;
  }
  EXPECT_GE(found, kFrames - 2);
}

TEST(WideLensTest, FindsTagBeyondNinetyDegreesFromAxis) {
  // TUM VI's lens: 108 degrees from the axis in the corners of the image.
  const CameraModel camera({512,
                            512,
                            190.978,
                            190.973,
                            254.932,
                            256.897,
                            DistortionModel::kEquidistant,
                            {0.0034824, 0.0007150, -0.0020532, 0.0002029}});
  const TagBoard board{{OneTag("tag36h11", 7, 0.5)}};
  const TagBoardDetector detector(camera, board, {});
  const double angle = Radians(93);
  const double diagonal = std::sin(angle) * M_SQRT1_2;
  const RigidTransform turn{
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(),
                                         Eigen::Vector3d(diagonal, diagonal, std::cos(angle))),
      Eigen::Vector3d::Zero()};
  const RigidTransform pose = turn * BoardBelow(2.6, {0, 0}, 0.3, Eigen::Vector3d::Zero());
  const cv::Mat image = TagRenderer(camera).Render(board.Printed(), pose, {}, 4);
  const TargetReport report = detector.Detect(image, {}, *detector.MakeWorkspace());
  ASSERT_TRUE(report.detection) << report.reason;
  EXPECT_LT(ErrorOf(*report.detection, pose).place, 0.01);
}

CameraModel PinholeOf(cv::Size size) {
  return CameraModel(CameraIntrinsics{.width_px = size.width,
                                      .height_px = size.height,
                                      .fx_px = 400,
                                      .fy_px = 400,
                                      .cx_px = 0.5 * size.width - 0.5,
                                      .cy_px = 0.5 * size.height - 0.5,
                                      .distortion = {}});
}

// A dark square with a light block of cells in it: columns and rows from and to, of 'width' cells.
cv::Mat DarkSquareWithBlock(int width, cv::Point from, cv::Point to, double side_px,
                            std::uint64_t seed) {
  Random random(seed);
  TaglessDrawing drawing(&random);
  drawing.Place(1, side_px, side_px, [&] {
    drawing.Box(0, 0, 1, 1, 35);
    const double cell = 1.0 / width;
    drawing.Box(cell * from.x, cell * from.y, cell * (to.x + 1), cell * (to.y + 1), 235);
  });
  return drawing.Taken();
}

TEST(TagBoardDetectorPictures, RejectsWindowLetterAndButtonThatLookLikeId) {
  struct PlainId {
    const char* family;
    int id, width;
    cv::Point from, to;
  };
  const CameraModel camera = PinholeOf(kTaglessSize);
  for (const PlainId& plain : {PlainId{"aruco_original", 0, 7, {1, 1}, {1, 5}},
                               PlainId{"aruco_original", 1023, 7, {2, 1}, {4, 5}},
                               PlainId{"aruco_4x4_50", 17, 6, {2, 1}, {3, 2}}}) {
    const TagBoardDetector detector(camera, {{OneTag(plain.family, plain.id, 0.5)}}, {});
    const auto workspace = detector.MakeWorkspace();
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const cv::Mat image = DarkSquareWithBlock(plain.width, plain.from, plain.to, 120, seed);
      EXPECT_FALSE(detector.Detect(image, {}, *workspace).detection) << plain.id << " " << seed;
    }
  }
}

TEST(TagBoardDetectorPictures, FindsTagsAndNoneInPicturesWithout) {
  const CameraModel camera = PinholeOf(kTaglessSize);
  const TagRenderer renderer(camera);
  Random random(31);
  std::vector<cv::Mat> without;
  for (int i = 0; i < 3; ++i) {
    for (const TaglessKind& kind : kTaglessKinds) without.push_back(kind.draw(&random));
  }
  int found = 0, rendered = 0;
  for (const BoardTag& tag :
       {OneTag("tag36h11", 7, 0.5), OneTag("tag16h5", 3, 0.5), OneTag("aruco_4x4_50", 3, 0.5),
        OneTag("aruco_4x4_50", 17, 0.5), OneTag("aruco_original", 100, 0.5),
        OneTag("aruco_original", 0, 0.5), OneTag("aruco_5x5_250", 7, 0.5)}) {
    const TagBoardDetector detector(camera, {{tag}}, {});
    const auto workspace = detector.MakeWorkspace();
    for (std::size_t i = 0; i < without.size(); ++i) {
      EXPECT_FALSE(detector.Detect(without[i], {}, *workspace).detection)
          << tag.family << " " << tag.id << " " << kTaglessKinds[i % kTaglessKinds.size()].name;
    }
    for (int i = 0; i < 6; ++i) {
      TagImageOptions taken;
      taken.blur_px = random.Uniform(0.3, 1.2);
      taken.noise = random.Uniform(0.5, 5);
      const RigidTransform pose = RandomBoardBelow(random.Uniform(1.5, 7), 0.3, 0.2, &random);
      const cv::Mat image = renderer.Render(TagBoard{{tag}}.Printed(), pose, taken, random.Bits());
      const bool is_plain = !WarningsOfPlainTags({{tag}}).empty();
      TargetHint hint;
      if (is_plain) {  // expected by a track
        hint.center_in_camera = pose.translation;
        hint.center_sigma_m = 0.05;
        hint.rotation_in_camera = pose.rotation;
      }
      ++rendered;
      found += detector.Detect(image, hint, *workspace).detection.has_value();
    }
  }
  EXPECT_GE(found, rendered - 2);
}

TEST(TagBoardDetectorPictures, FindsTagThatTouchesImageBorder) {
  const cv::Size size(320, 240);
  const CameraModel camera = PinholeOf(size);
  const TagBoard board{{OneTag("tag36h11", 7, 0.5)}};
  const TagBoardDetector detector(camera, board, {});
  const auto workspace = detector.MakeWorkspace();
  const TagRenderer renderer(camera);
  const auto is_found = [&](double height, const Eigen::Vector2d& center_px, double heading) {
    const Eigen::Vector2d place = height / 400 * (center_px - Eigen::Vector2d(159.5, 119.5));
    const RigidTransform pose = BoardBelow(height, place, heading, Eigen::Vector3d::Zero());
    const TargetReport report =
        detector.Detect(renderer.Render(board.Printed(), pose, {}, 5), {}, *workspace);
    if (!report.detection) return false;
    EXPECT_LT(ErrorOf(*report.detection, pose).place, 0.01);
    return true;
  };
  for (const double beyond : {-0.5, 0.5, 2.0}) {  // px that the black border goes past the rim
    const double half = 50;                       // px: 0.5 m at 2 m
    EXPECT_TRUE(is_found(2, {half - 0.5 - beyond, 120}, 0)) << "left " << beyond;
    EXPECT_TRUE(is_found(2, {319.5 - half + beyond, 100}, kPi / 2)) << "right " << beyond;
    EXPECT_TRUE(is_found(2, {150, half - 0.5 - beyond}, kPi)) << "top " << beyond;
    EXPECT_TRUE(is_found(2, {150, 239.5 - half + beyond}, 0)) << "bottom " << beyond;
    EXPECT_TRUE(is_found(2, {half - 0.5 - beyond, half - 0.5 - beyond}, 0)) << "two " << beyond;
    for (const double turn : {0.3, 0.6}) {  // a corner at the rim
      const double reach = half * (std::cos(turn) + std::sin(turn));
      EXPECT_TRUE(is_found(2, {reach - 0.5 - beyond, 120}, turn)) << turn << " " << beyond;
    }
  }
  EXPECT_TRUE(is_found(0.84, {159.5, 119.5}, 0)) << "from rim to rim";
}

TEST_F(TagBoardDetectorTest, UpSelectsOneOfTwoPosesOfFarTag) {
  Use({{OneTag("tag36h11", 7, 0.5)}});
  Random random(21);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform pose = RandomBoardBelow(4, 0.5, 0.1, &random);
    TargetHint hint = Expected(pose, 0.1, &random);
    const TargetReport report = Detect(Image(pose, random.Bits()), hint);
    if (!report.detection) continue;
    EXPECT_LT(ErrorOf(*report.detection, pose).angle, Radians(8));
  }
}

TEST_F(TagBoardDetectorTest, ReportsImageOfAnotherSize) {
  Use({{OneTag("tag36h11", 7, 0.5)}});
  const TargetReport report = Detect(cv::Mat(100, 100, CV_8UC1, cv::Scalar(0)));
  EXPECT_FALSE(report.detection);
  EXPECT_EQ(report.reason, "the image is not CV_8UC1 of the camera's size");
}

TEST_F(TagBoardDetectorTest, ShapeMatchesBoard) {
  Use(NestedBoard());
  const TargetShape& shape = detector_->shape();
  ASSERT_EQ(shape.outlines.size(), 3u);
  EXPECT_NEAR(shape.outlines[0][0].norm(), 0.3 * M_SQRT2, 1e-9);
  EXPECT_GT(shape.diameter_m, 2 * 0.68);
}

TEST_F(TagBoardDetectorTest, RefusesInvalidInput) {
  EXPECT_THROW(TagBoardDetector(camera_, TagBoard(), {}), InputError);
  TagBoardDetectorOptions options;
  options.min_quality = 2;
  EXPECT_THROW(TagBoardDetector(camera_, TagBoard{{BoardTag()}}, options), InputError);
}

}  // namespace
}  // namespace kestrel

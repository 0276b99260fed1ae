// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/detect_tags.h"

#include <cmath>
#include <memory>

#include <apriltag/apriltag.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#if __has_include(<opencv2/objdetect/aruco_detector.hpp>)
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/tags/apriltag_families.h"
#include "kestrel/vision/tags/test_tag_images.h"
#include "kestrel/vision/tags/test_tagless_pictures.h"

namespace kestrel {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;
using TagCorners = std::array<Eigen::Vector2d, 4>;

constexpr double kTagSize = 0.5;  // m

CameraModel Camera() {
  CameraIntrinsics camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = camera.fy_px = 400;
  camera.cx_px = 319.5;
  camera.cy_px = 239.5;
  return CameraModel(camera);
}

cv::Mat ImageOf(const std::string& family, int id, const RigidTransform& pose) {
  return TagRenderer(Camera()).Render(BoardOfTag(family, id, kTagSize).Printed(), pose, {},
                                      /*seed=*/5);
}

// A tag in the middle of the image, turned by 20 degrees, seen aslant.
RigidTransform Tilted(double height) {
  return BoardBelow(height, {-0.2 * height, 0.3 * height}, 0.35, {0.3, 0.2, 0});
}

TagCorners TrueCorners(const RigidTransform& pose) {
  constexpr double kHalf = 0.5 * kTagSize;
  const std::array<Eigen::Vector3d, 4> places{Eigen::Vector3d(-kHalf, kHalf, 0),
                                              {kHalf, kHalf, 0},
                                              {kHalf, -kHalf, 0},
                                              {-kHalf, -kHalf, 0}};
  TagCorners corners;
  for (int k = 0; k < 4; ++k) Camera().Project(pose * places[k], &corners[k]);
  return corners;
}

double Farthest(const TagCorners& a, const TagCorners& b) {
  double farthest = 0;
  for (int k = 0; k < 4; ++k) farthest = std::max(farthest, (a[k] - b[k]).norm());
  return farthest;
}

std::vector<int> IdsOf(const std::vector<TagDetection>& tags) {
  std::vector<int> ids;
  for (const TagDetection& tag : tags) ids.push_back(tag.id);
  return ids;
}

TEST(DetectTags, FindsATagOfEveryFamilyWhereItIs) {
  const RigidTransform pose = Tilted(1.5);
  for (const std::string& family : TagFamilies()) {
    const std::vector<TagDetection> tags = DetectTags(ImageOf(family, 7, pose), {family});
    ASSERT_THAT(IdsOf(tags), ElementsAre(7)) << family;
    EXPECT_EQ(tags[0].family, family);
    EXPECT_LT(Farthest(tags[0].corners_px, TrueCorners(pose)), 0.3) << family;
    EXPECT_GT(tags[0].decision_margin, 40) << family;
  }
}

TEST(DetectTags, FindsNearAndFarTagsToATenthOfAPixel) {
  for (const double height : {1.0, 2.0, 4.0, 6.0}) {
    double squares = 0;
    constexpr int kImages = 10;
    Random random(3);
    for (int i = 0; i < kImages; ++i) {
      const RigidTransform pose = RandomBoardBelow(height, 0.05, 0.05, &random);
      const std::vector<TagDetection> tags = DetectTags(ImageOf("tag36h11", i, pose), {"tag36h11"});
      ASSERT_THAT(IdsOf(tags), ElementsAre(i)) << height << " m";
      squares += std::pow(Farthest(tags[0].corners_px, TrueCorners(pose)), 2);
    }
    EXPECT_LT(std::sqrt(squares / kImages), 0.15) << height << " m";
  }
}

TEST(DetectTags, CornersTurnWithTheImage) {
  const cv::Mat image = ImageOf("tag36h11", 3, Tilted(1.5));
  const TagCorners before = DetectTags(image, {"tag36h11"}).at(0).corners_px;
  cv::Mat turned;
  cv::rotate(image, turned, cv::ROTATE_90_CLOCKWISE);
  const TagCorners after = DetectTags(turned, {"tag36h11"}).at(0).corners_px;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d expected(image.rows - 1 - before[k].y(), before[k].x());
    EXPECT_LT((after[k] - expected).norm(), 0.1) << k;
  }
}

// libapriltag's corners and margin of the only tag in an image.
struct PeerTag {
  TagCorners corners;
  double decision_margin;
};

PeerTag ByLibapriltag(const cv::Mat& image, const std::string& family_name) {
  const AprilTagFamily* const known = FindAprilTagFamily(family_name);
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(known->create(),
                                                                                known->destroy);
  const std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector(
      apriltag_detector_create(), apriltag_detector_destroy);
  apriltag_detector_add_family(detector.get(), family.get());
  detector->quad_decimate = 1;
  detector->decode_sharpening = 0;
  image_u8_t view = {.width = image.cols,
                     .height = image.rows,
                     .stride = static_cast<int>(image.step[0]),
                     .buf = image.data};
  zarray_t* const all = apriltag_detector_detect(detector.get(), &view);
  EXPECT_EQ(zarray_size(all), 1);
  apriltag_detection_t* tag = nullptr;
  zarray_get(all, 0, static_cast<void*>(&tag));
  PeerTag peer{{}, tag->decision_margin};
  // Its pixels have integer borders.
  for (int k = 0; k < 4; ++k) peer.corners[k] = {tag->p[k][0] - 0.5, tag->p[k][1] - 0.5};
  apriltag_detections_destroy(all);
  return peer;
}

TEST(DetectTags, CornersAreThoseOfLibapriltagInReverseAndTheMarginIsItsOwn) {
  for (const char* family : {"tag36h11", "tag25h9", "tagStandard41h12"}) {
    const cv::Mat image = ImageOf(family, 3, Tilted(1.2));
    const TagDetection tag = DetectTags(image, {family}).at(0);
    const PeerTag peer = ByLibapriltag(image, family);
    for (int k = 0; k < 4; ++k) {
      EXPECT_LT((tag.corners_px[k] - peer.corners[3 - k]).norm(), 0.3) << family << " " << k;
    }
    EXPECT_NEAR(tag.decision_margin, peer.decision_margin, 0.03 * peer.decision_margin) << family;
  }
}

TEST(DetectTags, CornersAreInTheOrderOfOpenCv) {
  const cv::Mat image = ImageOf("aruco_4x4_50", 3, Tilted(1.2));
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
#if __has_include(<opencv2/objdetect/aruco_detector.hpp>)
  cv::aruco::ArucoDetector(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50))
      .detectMarkers(image, corners, ids);
#else
  cv::aruco::detectMarkers(image, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50),
                           corners, ids);
#endif
  ASSERT_THAT(ids, ElementsAre(3));
  const TagDetection tag = DetectTags(image, {"aruco_4x4_50"}).at(0);
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d expected(corners[0][k].x, corners[0][k].y);
    EXPECT_LT((tag.corners_px[k] - expected).norm(), 2) << k;
  }
}

TEST(DetectTags, ListsByFamilyAndIdEveryTagOnce) {
  cv::Mat four(960, 1280, CV_8UC1);
  const auto put = [&](const std::string& family, int id, int column, int row) {
    ImageOf(family, id, Tilted(1.5)).copyTo(four(cv::Rect(640 * column, 480 * row, 640, 480)));
  };
  put("tag36h11", 9, 0, 0);
  put("aruco_5x5_100", 4, 1, 0);
  put("tag36h11", 2, 0, 1);
  put("tag36h11", 9, 1, 1);
  const std::vector<TagDetection> tags = DetectTags(four, {"aruco_5x5_100", "tag36h11"});
  EXPECT_THAT(IdsOf(tags), ElementsAre(4, 2, 9, 9));
  EXPECT_EQ(tags.at(0).family, "aruco_5x5_100");
  EXPECT_THAT(DetectTags(four, {"tag25h9"}), IsEmpty());
  EXPECT_THAT(DetectTags(four, {}), IsEmpty());
}

TEST(DetectTags, AColourImageIsReadByItsLuminance) {
  const cv::Mat gray = ImageOf("tag36h11", 3, Tilted(1.5));
  cv::Mat color;
  cv::cvtColor(gray, color, cv::COLOR_GRAY2BGR);
  EXPECT_LT(Farthest(DetectTags(color, {"tag36h11"}).at(0).corners_px,
                     DetectTags(gray, {"tag36h11"}).at(0).corners_px),
            1e-9);
}

TEST(DetectTags, APartOfAnImageIsSearchedInPlace) {
  const cv::Mat image = ImageOf("tag36h11", 3, Tilted(1.5));
  const cv::Point corner(37, 11);
  const TagCorners whole = DetectTags(image, {"tag36h11"}).at(0).corners_px;
  const cv::Mat part = image(cv::Rect(corner, cv::Point(621, 470)));
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d expected = whole[k] - Eigen::Vector2d(corner.x, corner.y);
    EXPECT_LT((DetectTags(part, {"tag36h11"}).at(0).corners_px[k] - expected).norm(), 0.1);
  }
}

TEST(DetectTags, WindowsLettersAndGroundsAreNoTag) {
  Random random(8);
  for (int i = 0; i < 20; ++i) {
    for (const TaglessKind& kind : kTaglessKinds) {
      EXPECT_THAT(DetectTags(kind.draw(&random), {"tag36h11", "tagStandard41h12", "aruco_6x6_250"}),
                  IsEmpty())
          << kind.name;
    }
  }
}

TEST(DetectTags, ImagesOfAnySizeWithoutTagsHaveNone) {
  for (const cv::Size size : {cv::Size(1, 1), {7, 300}, {8, 8}, {33, 9}, {640, 480}}) {
    EXPECT_THAT(DetectTags(cv::Mat(size, CV_8UC1, cv::Scalar(90)), {"tag36h11"}), IsEmpty())
        << size;
  }
}

TEST(DetectTags, RefusesOtherImagesAndFamiliesByName) {
  const cv::Mat image(480, 640, CV_8UC1, cv::Scalar(90));
  const auto detect = [](const cv::Mat& of, const char* family) {
    return [=] { DetectTags(of, {family}); };
  };
  EXPECT_THAT(detect(image, "tag36h12"),
              ThrowsMessage<InputError>(HasSubstr("'tag36h12', did you mean 'tag36h11'?")));
  EXPECT_THAT(detect(cv::Mat(), "tag36h11"), ThrowsMessage<InputError>(HasSubstr("is empty")));
  EXPECT_THAT(detect(cv::Mat(480, 640, CV_32FC1, cv::Scalar(NAN)), "tag36h11"),
              ThrowsMessage<InputError>(HasSubstr("CV_32FC1")));
}

}  // namespace
}  // namespace kestrel

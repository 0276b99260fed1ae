// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/targets/other_tag_finder.h"

#include <string>

#include <gtest/gtest.h>

#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/helipad/test_ground_textures.h"
#include "kestrel/vision/tags/tag_board_detector.h"
#include "kestrel/vision/tags/test_tag_images.h"
#include "kestrel/vision/targets/ring_with_tags_detector.h"

namespace kestrel {
namespace {

TagBoard BoardOf(const std::string& family, int id) {
  BoardTag tag;
  tag.family = family;
  tag.id = id;
  return {{tag}};
}

// Returns the id that the finder for a board reads in an image that a detector of it has searched.
std::optional<int> Read(const TargetDetector& detector, const TagBoard& board,
                        const cv::Mat& image) {
  const auto workspace = detector.MakeWorkspace();
  detector.Detect(image, {}, *workspace);
  return OtherTagFinder(detector.camera(), board).Find(image, workspace.get());
}

cv::Mat ImageOf(const std::string& family, int id) {
  const RigidTransform pose = BoardBelow(2, {0.2, -0.1}, 0.7, {0.1, -0.05, 0});
  return TagRenderer(CameraModel(PaperCamera()))
      .Render(BoardOf(family, id).Printed(), pose, {}, /*seed=*/3);
}

// Returns the id that the finder for tag 8 reads where tag 'id' is.
std::optional<int> Read(const std::string& family, const std::string& printed, int id) {
  const TagBoard board = BoardOf(family, 8);
  return Read(TagBoardDetector(CameraModel(PaperCamera()), board, {}), board, ImageOf(printed, id));
}

TEST(OtherTagFinder, ReadsIdOfAnotherTagOfFamily) {
  for (const char* family : {"tag36h11", "tagStandard41h12", "aruco_4x4_50", "aruco_6x6_250"}) {
    EXPECT_EQ(Read(family, family, 7), 7) << family;
    EXPECT_EQ(Read(family, family, 31), 31) << family;
  }
}

TEST(OtherTagFinder, IgnoresWantedTag) { EXPECT_EQ(Read("tag36h11", "tag36h11", 8), std::nullopt); }

TEST(OtherTagFinder, ReadsOtherTagForRingWithTags) {
  const TagBoard board = BoardOf("tag36h11", 8);
  const RingWithTagsDetector detector(CameraModel(PaperCamera()), {}, board, {});
  EXPECT_EQ(Read(detector, board, ImageOf("tag36h11", 7)), 7);
}

TEST(OtherTagFinder, DoesNotReadAnotherFamily) {
  EXPECT_EQ(Read("tag36h11", "aruco_5x5_250", 7), std::nullopt);
}

TEST(OtherTagFinder, FindsNoTagInGroundsAndWalls) {
  const CameraModel camera(PaperCamera());
  const TagBoard board = BoardOf("tag36h11", 8);
  const TagBoardDetector detector(camera, board, {});
  for (std::size_t kind = 0; kind < GroundTextures::kKinds.size(); ++kind) {
    GroundTextures textures({camera.width_px(), camera.height_px()}, kind);
    EXPECT_EQ(Read(detector, board, textures.Draw(kind)), std::nullopt)
        << GroundTextures::kKinds[kind];
  }
}

}  // namespace
}  // namespace kestrel

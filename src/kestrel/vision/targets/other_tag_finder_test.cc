// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/targets/other_tag_finder.h"

#include <string>

#include <gtest/gtest.h>

#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/helipad/test_ground_textures.h"
#include "kestrel/vision/tags/test_tag_images.h"

namespace kestrel {
namespace {

TagBoard BoardOf(const std::string& family, int id) {
  BoardTag tag;
  tag.family = family;
  tag.id = id;
  return {{tag}};
}

// Returns the id that the finder for tag 8 reads where tag 'id' is.
std::optional<int> Read(const std::string& family, const std::string& printed, int id) {
  const CameraModel camera(PaperCamera());
  const RigidTransform pose = BoardBelow(2, {0.2, -0.1}, 0.7, {0.1, -0.05, 0});
  const cv::Mat image =
      TagRenderer(camera).Render(BoardOf(printed, id).Printed(), pose, {}, /*seed=*/3);
  const OtherTagFinder finder(camera, BoardOf(family, 8));
  OtherTagBuffers buffers = finder.MakeBuffers();
  return finder.Find(image, &buffers);
}

TEST(OtherTagFinder, ReadsTheIdOfAnotherTagOfTheFamily) {
  for (const char* family : {"tag36h11", "tagStandard41h12", "aruco_4x4_50", "aruco_6x6_250"}) {
    EXPECT_EQ(Read(family, family, 7), 7) << family;
    EXPECT_EQ(Read(family, family, 31), 31) << family;
  }
}

TEST(OtherTagFinder, TheTagThatIsLookedForIsNoOther) {
  EXPECT_EQ(Read("tag36h11", "tag36h11", 8), std::nullopt);
}

TEST(OtherTagFinder, AnotherFamilyIsNotRead) {
  EXPECT_EQ(Read("tag36h11", "aruco_5x5_250", 7), std::nullopt);
}

TEST(OtherTagFinder, GroundsAndWallsAreNoTag) {
  const CameraModel camera(PaperCamera());
  const OtherTagFinder finder(camera, BoardOf("tag36h11", 8));
  OtherTagBuffers buffers = finder.MakeBuffers();
  for (std::size_t kind = 0; kind < GroundTextures::kKinds.size(); ++kind) {
    GroundTextures textures({camera.width_px(), camera.height_px()}, kind);
    EXPECT_EQ(finder.Find(textures.Draw(kind), &buffers), std::nullopt)
        << GroundTextures::kKinds[kind];
  }
}

}  // namespace
}  // namespace kestrel

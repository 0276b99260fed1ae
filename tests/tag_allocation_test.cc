// SPDX-License-Identifier: BSD-3-Clause
// TagBoardDetector does not allocate once it has warmed up.
#include <gtest/gtest.h>

#include "count_allocations.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/tags/tag_board_detector.h"
#include "kestrel/vision/tags/test_tag_images.h"

namespace kestrel {
namespace {

TEST(TagAllocationTest, AllocatesNothingAfterFirstFrame) {
  const CameraModel camera(PaperCamera());
  const TagBoard board{{BoardTag()}};
  const TagBoardDetector detector(camera, board, {});
  const TagRenderer renderer(camera);
  const auto workspace = detector.MakeWorkspace();
  Random random(2);
  for (int i = 0; i < 8; ++i) {
    const RigidTransform pose = RandomBoardBelow(0.7 + 0.5 * i, 0.4, 0.1, &random);
    const cv::Mat image = renderer.Render(board.Printed(), pose, {}, random.Bits());
    TargetHint hint;
    if (i % 4 >= 2) hint.center_in_camera = pose.translation;
    if (i % 4 == 3) hint.rotation_in_camera = pose.rotation;
    TargetReport report;
    const int count = CountAllocations([&] { report = detector.Detect(image, hint, *workspace); });
    EXPECT_TRUE(report.detection) << i;
    if (i == 0) {
      EXPECT_GT(count, 0) << "the count does not see the workspace grow";
    } else {
      EXPECT_EQ(count, 0) << "frame " << i;
    }
  }
}

}  // namespace
}  // namespace kestrel

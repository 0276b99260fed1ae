// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/recording/euroc/calibration_output.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/vision/pipeline/test_pattern.h"
#include "kestrel/vision/tags/tag_board.h"
#include "kestrel/vision/tags/test_tag_images.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr char kFloor[] =
    "tags:\n"
    "  - {id: 3, size_m: 0.4}\n"
    "  - {id: 7, size_m: 0.4, x_m: 1.1, y_m: 0.2, yaw_deg: 25}\n"
    "  - {id: 12, size_m: 0.4, x_m: -0.3, y_m: -0.9, yaw_deg: -110}\n";

class CalibratePadsCommandTest : public CommandTest {
 protected:
  CalibratePadsCommandTest() {
    const TagBoard floor = ParseTagBoard(kFloor, "floor", "tag36h11", 0);
    const CameraModel camera(PaperCamera());
    const TagRenderer renderer(camera);
    Random random(5);
    for (std::uint64_t i = 0; i < 24; ++i) {
      const Eigen::Quaterniond turn(
          Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(random.Uniform(-3, 3), Eigen::Vector3d::UnitZ()));
      const Eigen::Vector3d lean(random.Normal(), random.Normal(), 0);
      const RigidTransform camera_from_floor{
          RotationBy(Radians(5) * lean) * turn,
          {random.Uniform(-0.6, 0.6), random.Uniform(-0.5, 0.5), random.Uniform(1.6, 2.6)}};
      WriteTestImage(folder_, fmt::format("floor/{:03}.png", i),
                     renderer.Render(floor.Printed(), camera_from_floor, TagImageOptions(), i));
    }
    CameraCalibration calibration;
    calibration.intrinsics = PaperCamera();
    WriteCalibration(calibration, 30, folder_ / "camera.yaml", false);
  }

  std::string Command(const std::string& ids) const {
    return "calibrate pads " + (folder_ / "floor") + " --camera " + (folder_ / "camera.yaml") +
           " --size 0.4 --ids " + ids;
  }
};

TEST_F(CalibratePadsCommandTest, BoardHasPlacesOfTagsOnFloor) {
  const Outcome outcome = Succeed(Command("3,7,12,99"));
  EXPECT_THAT(outcome.err, HasSubstr("tag 99 is left out"));
  const TagBoard board = ParseTagBoard(outcome.out, "board", "tag36h11", 0);
  const TagBoard floor = ParseTagBoard(kFloor, "floor", "tag36h11", 0);
  ASSERT_THAT(board.tags, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i) {
    const RigidTransform& found = board.tags[i].board_from_tag;
    const RigidTransform& truth = floor.tags[i].board_from_tag;
    EXPECT_LT((found.translation - truth.translation).norm(), 0.005) << i;
    EXPECT_LT(found.rotation.angularDistance(truth.rotation), Radians(0.5)) << i;
  }
}

TEST_F(CalibratePadsCommandTest, ReportsBadInputInOneLine) {
  ExpectInputError(Command("3"), "--ids: expected two tags or more");
  ExpectInputError(Command("3,3"), "--ids");
  ExpectInputError(Command("3,99999"), "99999");
  ExpectInputError(Command("3,99"), "no image shows the first pad beside another one");
  const std::string file = folder_ / "camera.yaml";
  ExpectInputError(Command("3,7") + " --output " + file, "camera.yaml");
}

}  // namespace
}  // namespace kestrel

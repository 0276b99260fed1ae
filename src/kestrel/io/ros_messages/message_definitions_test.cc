// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/message_definitions.h"

#include <string>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// The checksums are those that `rosmsg md5` prints in ROS 1 Noetic.
TEST(MessageChecksum, MatchesRos1) {
  const std::pair<std::string_view, std::string_view> known[] = {
      {"sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743"},
      {"sensor_msgs/CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214"},
      {"sensor_msgs/CompressedImage", "8f7a12909da2c9d3332d540a0977563f"},
      {"geometry_msgs/PoseWithCovarianceStamped", "953b798c0f514ff060a53a3498ce6246"},
      {"geometry_msgs/PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5"},
      {"nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7"},
      {"tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec"},
      {"geometry_msgs/TransformStamped", "b5764a33bfeb3588febc2682852579b0"},
  };
  for (const auto& [type, checksum] : known) EXPECT_EQ(MessageChecksum(type), checksum) << type;
}

// Hashes as in `ros2 topic info -v` and the packages of ROS 2 Jazzy.
TEST(TypeHash, MatchesRos2) {
  const std::pair<std::string_view, std::string_view> known[] = {
      {"sensor_msgs/Image",
       "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47"},
      {"sensor_msgs/CameraInfo",
       "RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275"},
      {"sensor_msgs/CompressedImage",
       "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a"},
      {"geometry_msgs/PoseWithCovarianceStamped",
       "RIHS01_26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e"},
      {"geometry_msgs/PoseStamped",
       "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"},
      {"nav_msgs/Odometry",
       "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"},
      {"tf2_msgs/TFMessage",
       "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
      {"geometry_msgs/TransformStamped",
       "RIHS01_0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206"},
      {"nav_msgs/Path", "RIHS01_1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b"},
      {"visualization_msgs/MarkerArray",
       "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf"},
      {"diagnostic_msgs/DiagnosticArray",
       "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"},
      {"vision_msgs/Detection3DArray",
       "RIHS01_793f5eab9595ac1c0da07873cc859db42eae51f0ee76056db8562515d830e018"},
      {"apriltag_msgs/AprilTagDetectionArray",
       "RIHS01_6016bfe513a7c741ccbdbc6419ed6c4cabfe5f11271a96555fbf26565c6b9826"},
      {"rmw_dds_common/ParticipantEntitiesInfo",
       "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"},
  };
  for (const auto& [type, hash] : known) EXPECT_EQ(TypeHash(type), hash) << type;
}

TEST(MessageDefinition, ListsNestedTypesOnceEach) {
  const std::string line(80, '=');
  EXPECT_EQ(MessageDefinition("tf2_msgs/TFMessage", WireFormat::kRos1),
            "geometry_msgs/TransformStamped[] transforms\n" + line +
                "\nMSG: geometry_msgs/TransformStamped\n"
                "std_msgs/Header header\nstring child_frame_id\n"
                "geometry_msgs/Transform transform\n" +
                line + "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n" + line +
                "\nMSG: geometry_msgs/Transform\n"
                "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n" +
                line + "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n" + line +
                "\nMSG: geometry_msgs/Quaternion\n"
                "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n");
}

TEST(MessageDefinition, UsesFieldNamesOfRosVersionAndHasConstants) {
  const auto has = [](const std::string& definition, const char* lines) {
    return definition.find(lines) != std::string::npos;
  };
  EXPECT_TRUE(has(MessageDefinition("sensor_msgs/CameraInfo", WireFormat::kRos1),
                  "\nfloat64[] D\nfloat64[9] K\n"));
  EXPECT_TRUE(has(MessageDefinition("sensor_msgs/CameraInfo", WireFormat::kCdr),
                  "\nfloat64[] d\nfloat64[9] k\n"));
  EXPECT_TRUE(has(MessageDefinition("diagnostic_msgs/DiagnosticArray", WireFormat::kCdr),
                  "\nbyte STALE=3\nbyte level\n"));
}

TEST(MessageDefinition, RefusesTypesMissingInRos) {
  EXPECT_THROW(MessageDefinition("sensor_msgs/LaserScan", WireFormat::kCdr), InputError);
  EXPECT_THROW(MessageDefinition("nav_msgs/Path", WireFormat::kRos1), InputError);
}

}  // namespace
}  // namespace kestrel

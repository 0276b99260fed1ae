// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/type_hash.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

// Hashes as in `ros2 topic info -v` and the packages of ROS 2 Jazzy.
TEST(TypeHash, IsThatOfRos2) {
  EXPECT_EQ(TypeHash("builtin_interfaces/Time"),
            "RIHS01_b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197");
  EXPECT_EQ(TypeHash("std_msgs/Header"),
            "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01");
  EXPECT_EQ(TypeHash("sensor_msgs/Image"),
            "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47");
  EXPECT_EQ(TypeHash("sensor_msgs/CompressedImage"),
            "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a");
  EXPECT_EQ(TypeHash("sensor_msgs/CameraInfo"),
            "RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275");
  EXPECT_EQ(TypeHash("visualization_msgs/MarkerArray"),
            "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf");
  EXPECT_EQ(TypeHash("vision_msgs/Detection3DArray"),
            "RIHS01_793f5eab9595ac1c0da07873cc859db42eae51f0ee76056db8562515d830e018");
  EXPECT_EQ(TypeHash("rmw_dds_common/ParticipantEntitiesInfo"),
            "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e");
}

}  // namespace
}  // namespace kestrel

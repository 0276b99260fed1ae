// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/message_definitions.h"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

struct Definition {
  std::string_view type;
  std::string_view checksum;  // in ROS 1; empty for types that occur only in others, or in ROS 2
  std::string_view fields;
  std::vector<std::string_view> parts;  // types of its fields
};

// The definitions of the types in bags, in ROS 1; Ros2Definitions has those that differ in ROS 2.
const std::vector<Definition>& Definitions() {
  static const std::vector<Definition> kDefinitions = {
      {"sensor_msgs/Image",
       "060021388200f6f0f447d0fcd9c64743",
       "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
       "uint8 is_bigendian\nuint32 step\nuint8[] data\n",
       {"std_msgs/Header"}},
      {"sensor_msgs/CameraInfo",
       "c9a58c1b0b154e0e6da7578cb991d214",
       "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
       "float64[] D\nfloat64[9] K\nfloat64[9] R\nfloat64[12] P\nuint32 binning_x\n"
       "uint32 binning_y\nsensor_msgs/RegionOfInterest roi\n",
       {"std_msgs/Header", "sensor_msgs/RegionOfInterest"}},
      {"sensor_msgs/CompressedImage",
       "8f7a12909da2c9d3332d540a0977563f",
       "std_msgs/Header header\nstring format\nuint8[] data\n",
       {"std_msgs/Header"}},
      {"geometry_msgs/PoseWithCovarianceStamped",
       "953b798c0f514ff060a53a3498ce6246",
       "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n",
       {"std_msgs/Header", "geometry_msgs/PoseWithCovariance"}},
      {"geometry_msgs/PoseStamped",
       "d3812c3cbc69362b77dc0b19b345f8f5",
       "std_msgs/Header header\ngeometry_msgs/Pose pose\n",
       {"std_msgs/Header", "geometry_msgs/Pose"}},
      {"nav_msgs/Odometry",
       "cd5e73d190d741a2f92e81eda573aca7",
       "std_msgs/Header header\nstring child_frame_id\n"
       "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n",
       {"std_msgs/Header", "geometry_msgs/PoseWithCovariance",
        "geometry_msgs/TwistWithCovariance"}},
      {"tf2_msgs/TFMessage",
       "94810edda583a504dfda3829e70d7eec",
       "geometry_msgs/TransformStamped[] transforms\n",
       {"geometry_msgs/TransformStamped"}},
      {"geometry_msgs/TransformStamped",
       "b5764a33bfeb3588febc2682852579b0",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
       {"std_msgs/Header", "geometry_msgs/Transform"}},
      {"std_msgs/Header", "", "uint32 seq\ntime stamp\nstring frame_id\n", {}},
      {"sensor_msgs/RegionOfInterest",
       "",
       "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n",
       {}},
      {"geometry_msgs/Pose",
       "",
       "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n",
       {"geometry_msgs/Point", "geometry_msgs/Quaternion"}},
      {"geometry_msgs/PoseWithCovariance",
       "",
       "geometry_msgs/Pose pose\nfloat64[36] covariance\n",
       {"geometry_msgs/Pose"}},
      {"geometry_msgs/Twist",
       "",
       "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n",
       {"geometry_msgs/Vector3"}},
      {"geometry_msgs/TwistWithCovariance",
       "",
       "geometry_msgs/Twist twist\nfloat64[36] covariance\n",
       {"geometry_msgs/Twist"}},
      {"geometry_msgs/Transform",
       "",
       "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n",
       {"geometry_msgs/Vector3", "geometry_msgs/Quaternion"}},
      {"geometry_msgs/Point", "", "float64 x\nfloat64 y\nfloat64 z\n", {}},
      {"geometry_msgs/Vector3", "", "float64 x\nfloat64 y\nfloat64 z\n", {}},
      {"geometry_msgs/Quaternion", "", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n", {}},
  };
  return kDefinitions;
}

// The definitions that differ in ROS 2, and those of results.
const std::vector<Definition>& Ros2Definitions() {
  static const std::vector<Definition> kDefinitions = {
      {"sensor_msgs/CameraInfo",
       "",
       "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
       "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\n"
       "uint32 binning_y\nsensor_msgs/RegionOfInterest roi\n",
       {"std_msgs/Header", "sensor_msgs/RegionOfInterest"}},
      {"std_msgs/Header",
       "",
       "builtin_interfaces/Time stamp\nstring frame_id\n",
       {"builtin_interfaces/Time"}},
      {"builtin_interfaces/Time", "", "int32 sec\nuint32 nanosec\n", {}},
      {"builtin_interfaces/Duration", "", "int32 sec\nuint32 nanosec\n", {}},
      {"visualization_msgs/Marker",
       "",
       "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\n"
       "int32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\n"
       "int32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\n"
       "int32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\n"
       "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
       "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
       "builtin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\n"
       "std_msgs/ColorRGBA[] colors\nstring texture_resource\n"
       "sensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\n"
       "string text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\n"
       "bool mesh_use_embedded_materials\n",
       {"std_msgs/Header", "geometry_msgs/Pose", "geometry_msgs/Vector3", "std_msgs/ColorRGBA",
        "builtin_interfaces/Duration", "geometry_msgs/Point", "sensor_msgs/CompressedImage",
        "visualization_msgs/UVCoordinate", "visualization_msgs/MeshFile"}},
      {"visualization_msgs/UVCoordinate", "", "float32 u\nfloat32 v\n", {}},
      {"visualization_msgs/MeshFile", "", "string filename\nuint8[] data\n", {}},
      {"vision_msgs/Detection3D",
       "",
       "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\n"
       "vision_msgs/BoundingBox3D bbox\nstring id\n",
       {"std_msgs/Header", "vision_msgs/ObjectHypothesisWithPose", "vision_msgs/BoundingBox3D"}},
      {"vision_msgs/ObjectHypothesisWithPose",
       "",
       "vision_msgs/ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose\n",
       {"vision_msgs/ObjectHypothesis", "geometry_msgs/PoseWithCovariance"}},
      {"vision_msgs/ObjectHypothesis", "", "string class_id\nfloat64 score\n", {}},
      {"apriltag_msgs/AprilTagDetectionArray",
       "",
       "std_msgs/Header header\napriltag_msgs/AprilTagDetection[] detections\n",
       {"std_msgs/Header", "apriltag_msgs/AprilTagDetection"}},
      {"apriltag_msgs/AprilTagDetection",
       "",
       "string family\nint32 id\nint32 hamming\nfloat32 goodness\nfloat32 decision_margin\n"
       "apriltag_msgs/Point centre\napriltag_msgs/Point[4] corners\nfloat64[9] homography\n",
       {"apriltag_msgs/Point"}},
      {"apriltag_msgs/Point", "", "float64 x\nfloat64 y\n", {}},
      {"nav_msgs/Path",
       "",
       "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n",
       {"std_msgs/Header", "geometry_msgs/PoseStamped"}},
      {"visualization_msgs/MarkerArray",
       "",
       "visualization_msgs/Marker[] markers\n",
       {"visualization_msgs/Marker"}},
      {"diagnostic_msgs/DiagnosticArray",
       "",
       "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n",
       {"std_msgs/Header", "diagnostic_msgs/DiagnosticStatus"}},
      {"diagnostic_msgs/DiagnosticStatus",
       "",
       "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\n"
       "byte level\nstring name\nstring message\nstring hardware_id\n"
       "diagnostic_msgs/KeyValue[] values\n",
       {"diagnostic_msgs/KeyValue"}},
      {"diagnostic_msgs/KeyValue", "", "string key\nstring value\n", {}},
      {"vision_msgs/Detection3DArray",
       "",
       "std_msgs/Header header\nvision_msgs/Detection3D[] detections\n",
       {"std_msgs/Header", "vision_msgs/Detection3D"}},
      {"vision_msgs/BoundingBox3D",
       "",
       "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size\n",
       {"geometry_msgs/Pose", "geometry_msgs/Vector3"}},
      {"std_msgs/ColorRGBA", "", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n", {}},
      // Makes nodes visible to `ros2 node list`, since Iron.
      {"rmw_dds_common/ParticipantEntitiesInfo",
       "",
       "rmw_dds_common/Gid gid\nrmw_dds_common/NodeEntitiesInfo[] node_entities_info_seq\n",
       {"rmw_dds_common/Gid", "rmw_dds_common/NodeEntitiesInfo"}},
      {"rmw_dds_common/NodeEntitiesInfo",
       "",
       "string<=256 node_namespace\nstring<=256 node_name\n"
       "rmw_dds_common/Gid[] reader_gid_seq\nrmw_dds_common/Gid[] writer_gid_seq\n",
       {"rmw_dds_common/Gid"}},
      {"rmw_dds_common/Gid", "", "char[16] data\n", {}},
  };
  return kDefinitions;
}

const Definition* FindDefinition(const std::vector<Definition>& definitions,
                                 std::string_view type) {
  const auto known =
      std::find_if(definitions.begin(), definitions.end(),
                   [&](const Definition& definition) { return definition.type == type; });
  return known == definitions.end() ? nullptr : &*known;
}

const Definition& DefinitionOf(std::string_view type, WireFormat format) {
  const Definition* found =
      format == WireFormat::kCdr ? FindDefinition(Ros2Definitions(), type) : nullptr;
  if (found == nullptr) found = FindDefinition(Definitions(), type);
  if (found == nullptr) throw InputError(fmt::format("the type {} is not written", type));
  return *found;
}

// Adds the types in 'type', each once, in the order of their occurrence.
void AddParts(std::string_view type, WireFormat format, std::vector<std::string_view>* parts) {
  for (const std::string_view part : DefinitionOf(type, format).parts) {
    if (std::find(parts->begin(), parts->end(), part) != parts->end()) continue;
    parts->push_back(part);
    AddParts(part, format, parts);
  }
}

}  // namespace

std::string MessageDefinition(std::string_view type, WireFormat format) {
  std::string text(DefinitionOf(type, format).fields);
  std::vector<std::string_view> parts;
  AddParts(type, format, &parts);
  for (const std::string_view part : parts) {
    text += fmt::format("{:=<80}\nMSG: {}\n{}", "", part, DefinitionOf(part, format).fields);
  }
  return text;
}

std::string_view MessageChecksum(std::string_view type) {
  return DefinitionOf(type, WireFormat::kRos1).checksum;
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/calibration_reader.h"

#include <chrono>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kEuroc = R"(sensor_type: camera
comment: a camera
T_BS:
  cols: 4
  rows: 4
  data: [0, -1, 0, 0.1325,
         -1, 0, 0, 0,
         0, 0, -1, -0.05,
         0, 0, 0, 1]
rate_hz: 20
resolution: [752, 480]
camera_model: pinhole
intrinsics: [458.654, 457.296, 367.215, 248.375]
distortion_model: radial-tangential
distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]
)";

constexpr const char* kKalibr = R"(cam0:
  T_cam_imu:
  - [0.0, -1.0, 0.0, 0.1]
  - [1.0, 0.0, 0.0, 0.2]
  - [0.0, 0.0, 1.0, 0.3]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [0.0034, 0.0007, -0.0020, 0.0002]
  distortion_model: equidistant
  intrinsics: [190.97, 190.96, 254.93, 256.89]
  resolution: [512, 512]
  rostopic: /cam0/image_raw
  timeshift_cam_imu: -0.00012
cam1:
  camera_model: pinhole
  distortion_coeffs: []
  distortion_model: none
  intrinsics: [200, 201, 250, 251]
  resolution: [512, 510]
)";

constexpr const char* kRos = R"(image_width: 640
image_height: 480
camera_name: belly
camera_matrix:
  rows: 3
  cols: 3
  data: [438.783367, 0.000000, 305.593336, 0.000000, 437.302876, 243.738352, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.361976, 0.110510, 0.001014, 0.000505, 0.000000]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
projection_matrix:
  rows: 3
  cols: 4
  data: [393.6, 0, 302.6, 0, 0, 412.2, 244.0, 0, 0, 0, 1, 0]
)";

constexpr const char* kRosMessage = R"(header:
  frame_id: camera
height: 480
width: 752
distortion_model: "equidistant"
D: [-0.0448, 0.0686053, -0.072277, 0.027011955]
K: [261.0, 0.0, 376.0, 0.0, 262.0, 240.0, 0.0, 0.0, 1.0]
R: [1, 0, 0, 0, 1, 0, 0, 0, 1]
P: [261, 0, 376, 0, 0, 262, 240, 0, 0, 0, 1, 0]
---
)";

constexpr const char* kOpenCv = R"(%YAML:1.0
---
calibration_time: "Mon 2 Jan 2017"
image_width: 752
image_height: 480
fisheye_model: 1
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 2.61e+02, 0., 376., 0., 2.62e+02, 240., 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 4
   cols: 1
   dt: d
   data: [ -4.48e-02, 6.86053e-02, -7.2277e-02, 2.7011955e-02 ]
)";

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// Returns the message with which a text is refused.
std::string Refusal(const std::string& text, const std::string& camera = "") {
  try {
    ParseCalibration(text, "lens.yaml", camera);
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    EXPECT_THAT(error.what(), StartsWith("lens.yaml:"));
    return error.what();
  }
  ADD_FAILURE() << "not refused";
  return "";
}

// Returns the message about a text that is read.
std::string WarningsOf(const std::string& text) {
  std::string reported;
  ParseCalibration(text, "lens.yaml", "", [&](const std::string& line) { reported += line; });
  return reported;
}

TEST(CalibrationReader, ReadsEuroc) {
  const CameraCalibration read = ParseCalibration(kEuroc, "sensor.yaml");
  const CameraIntrinsics& c = read.intrinsics;
  EXPECT_EQ(c.width_px, 752);
  EXPECT_EQ(c.height_px, 480);
  EXPECT_EQ(c.fx_px, 458.654);
  EXPECT_EQ(c.fy_px, 457.296);
  EXPECT_EQ(c.cx_px, 367.215);
  EXPECT_EQ(c.cy_px, 248.375);
  EXPECT_EQ(c.distortion_model, DistortionModel::kRadialTangential);
  EXPECT_THAT(c.distortion, ElementsAre(-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05));
  ASSERT_TRUE(read.body_from_camera);
  // The optical axis points down, and the top of the image is the front of the body.
  EXPECT_TRUE((read.body_from_camera->rotation * Eigen::Vector3d::UnitZ())
                  .isApprox(-Eigen::Vector3d::UnitZ(), 1e-12));
  EXPECT_TRUE((*read.body_from_camera * Eigen::Vector3d(0, -1, 0))
                  .isApprox(Eigen::Vector3d(1.1325, 0, -0.05), 1e-12));
  EXPECT_FALSE(read.clock_offset);
}

TEST(CalibrationReader, ReadsFirstCameraOfKalibrChain) {
  const CameraCalibration read = ParseCalibration(kKalibr, "camchain.yaml");
  EXPECT_EQ(read.name, "cam0");
  EXPECT_EQ(read.intrinsics.distortion_model, DistortionModel::kEquidistant);
  EXPECT_EQ(read.intrinsics.cy_px, 256.89);
  ASSERT_TRUE(read.body_from_camera);
  // T_cam_imu maps body coordinates to the camera's: (0, 0, 0) becomes (0.1, 0.2, 0.3).
  EXPECT_LT((*read.body_from_camera * Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-12);
  EXPECT_TRUE((*read.body_from_camera * Eigen::Vector3d(-0.9, 0.2, 0.3))
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  ASSERT_TRUE(read.clock_offset);
  EXPECT_EQ(read.clock_offset->count(), -120000);
}

TEST(CalibrationReader, ReadsNamedCameraOfKalibrChain) {
  const CameraCalibration read = ParseCalibration(kKalibr, "camchain.yaml", "cam1");
  EXPECT_EQ(read.name, "cam1");
  EXPECT_EQ(read.intrinsics.distortion_model, DistortionModel::kNone);
  EXPECT_EQ(read.intrinsics.height_px, 510);
  EXPECT_FALSE(read.body_from_camera);
  EXPECT_FALSE(read.clock_offset);
  EXPECT_EQ(Refusal(kKalibr, "cam2"),
            "lens.yaml:1: the file has no camera 'cam2', expected one of cam0, cam1");
}

TEST(CalibrationReader, ReadsRosCameraInfo) {
  const CameraCalibration read = ParseCalibration(kRos, "belly.yaml");
  EXPECT_EQ(read.name, "belly");
  EXPECT_EQ(read.intrinsics.width_px, 640);
  EXPECT_EQ(read.intrinsics.fy_px, 437.302876);
  EXPECT_EQ(read.intrinsics.cx_px, 305.593336);
  EXPECT_EQ(read.intrinsics.distortion_model, DistortionModel::kRadialTangential);
  EXPECT_EQ(read.intrinsics.distortion.size(), 5u);
}

TEST(CalibrationReader, ReadsEchoedRosMessage) {
  const CameraCalibration read = ParseCalibration(kRosMessage, "camera_info");
  EXPECT_EQ(read.intrinsics.distortion_model, DistortionModel::kEquidistant);
  EXPECT_EQ(read.intrinsics.height_px, 480);
  EXPECT_EQ(read.intrinsics.fy_px, 262);
}

TEST(CalibrationReader, ReadsOpenCv) {
  const CameraCalibration read = ParseCalibration(kOpenCv, "out_camera_data.yml");
  EXPECT_EQ(read.intrinsics.distortion_model, DistortionModel::kEquidistant);
  EXPECT_EQ(read.intrinsics.fy_px, 262);
  EXPECT_EQ(read.intrinsics.cx_px, 376);
  EXPECT_THAT(read.intrinsics.distortion, ElementsAre(-0.0448, 0.0686053, -0.072277, 0.027011955));
}

// The output of OpenCV itself, with the rational model's 14 coefficients of which 8 are used.
TEST(CalibrationReader, ReadsFileWrittenByOpenCv) {
  cv::FileStorage storage("lens.yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  const cv::Mat matrix = (cv::Mat_<double>(3, 3) << 607.6, 0, 637.1, 0, 607.4, 366.9, 0, 0, 1);
  cv::Mat coefficients = cv::Mat::zeros(1, 14, CV_64F);
  coefficients.at<double>(7) = 0.25;
  storage << "Camera_Matrix" << matrix << "Distortion_Coefficients" << coefficients;
  storage << "image_size" << cv::Size(1280, 720);
  const CameraCalibration read = ParseCalibration(storage.releaseAndGetString(), "lens.yml");
  EXPECT_EQ(read.intrinsics.width_px, 1280);
  EXPECT_EQ(read.intrinsics.height_px, 720);
  EXPECT_EQ(read.intrinsics.cy_px, 366.9);
  EXPECT_THAT(read.intrinsics.distortion, ElementsAre(0, 0, 0, 0, 0, 0, 0, 0.25));
}

TEST(CalibrationReader, DeterminesOpenCvLensByFlagOrCoefficientCount) {
  EXPECT_EQ(ParseCalibration(Replaced(kOpenCv, "fisheye_model: 1", "fisheye_model: 0"), "")
                .intrinsics.distortion_model,
            DistortionModel::kRadialTangential);
  EXPECT_EQ(ParseCalibration(Replaced(kOpenCv, "fisheye_model: 1", "distortion_model: KB4"), "")
                .intrinsics.distortion_model,
            DistortionModel::kEquidistant);
  EXPECT_EQ(ParseCalibration(Replaced(kRos, "distortion_model: plumb_bob\n", ""), "")
                .intrinsics.distortion_model,
            DistortionModel::kRadialTangential);
  EXPECT_THAT(Refusal(Replaced(kOpenCv, "fisheye_model: 1\n", "")),
              HasSubstr("'distortion_coefficients' has 4 coefficients, which may be a fisheye's or "
                        "a radial-tangential lens's, expected a key 'fisheye_model'"));
  EXPECT_THAT(Refusal(Replaced(kOpenCv, "fisheye_model: 1", "fisheye_model: 2")),
              HasSubstr("'fisheye_model' is '2', expected 0 or 1"));
}

TEST(CalibrationReader, KnowsEveryNameOfLens) {
  const auto model = [](const std::string& name) {
    return ParseCalibration(Replaced(kEuroc, "radial-tangential", name), "")
        .intrinsics.distortion_model;
  };
  for (const char* name : {"equidistant", "fisheye", "kannala_brandt", "Kannala-Brandt4", "KB4"}) {
    EXPECT_EQ(model(name), DistortionModel::kEquidistant) << name;
  }
  for (const char* name : {"radtan", "radial-tangential", "plumb_bob", "rational_polynomial"}) {
    EXPECT_EQ(model(name), DistortionModel::kRadialTangential) << name;
  }
  const std::string no_coefficients =
      Replaced(kEuroc, "[-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]", "[0, 0, 0, 0]");
  for (const char* name : {"none", "pinhole", "''"}) {
    const CameraIntrinsics read =
        ParseCalibration(Replaced(no_coefficients, "radial-tangential", name), "").intrinsics;
    EXPECT_EQ(read.distortion_model, DistortionModel::kNone) << name;
    EXPECT_TRUE(read.distortion.empty()) << name;
  }
}

TEST(CalibrationReader, ReportsUnsupportedLenses) {
  for (const char* name : {"omni", "eucm", "ds"}) {
    EXPECT_THAT(
        Refusal(Replaced(kEuroc, "camera_model: pinhole", fmt::format("camera_model: {}", name))),
        AllOf(StartsWith(fmt::format("lens.yaml:12: 'camera_model' is '{}', which is not "
                                     "supported, expected pinhole",
                                     name)),
              HasSubstr("equidistant")));
  }
  EXPECT_THAT(Refusal(Replaced(kKalibr, "distortion_model: equidistant", "distortion_model: fov")),
              StartsWith("lens.yaml:10: 'cam0.distortion_model' is 'fov', which is not supported, "
                         "expected equidistant"));
}

struct BadText {
  std::string from;
  std::string to;
  std::string message;
};

void ExpectRefusals(const std::string& good, const std::vector<BadText>& cases) {
  for (const BadText& bad : cases) {
    EXPECT_THAT(Refusal(Replaced(good, bad.from, bad.to)), HasSubstr(bad.message)) << bad.to;
  }
}

TEST(CalibrationReader, RefusesMalformedEurocFiles) {
  ExpectRefusals(
      kEuroc,
      {{"resolution: [752, 480]\n", "",
        "lens.yaml:1: the file has no size of the images in pixels, expected 'image_width' and"},
       {"intrinsics: [458.654,", "intrinsic: [458.654,",
        "has no key 'intrinsics' (EuRoC), 'cam0' (Kalibr), 'camera_matrix' (ROS, OpenCV), "},
       {"distortion_model: radial-tangential\n", "",
        "the file has no key 'distortion_model', expected equidistant"},
       {"distortion_coefficients:", "coefficients:",
        "the file has no key 'distortion_coefficients' or 'distortion_coeffs' or "},
       {"[458.654, 457.296, 367.215, 248.375]", "[458.654, 457.296, 367.215]",
        "lens.yaml:13: 'intrinsics' has 3 numbers, expected 4: fu, fv, cu, cv"},
       {"resolution: [752, 480]\n", "resolution: [752, 480]\nresolution: [640, 480]\n",
        "lens.yaml:1: the file has 'resolution' twice, expected it once"},
       {"[458.654,", "[.nan,", "'intrinsics' holds '.nan', expected a finite number"},
       {"[458.654,", "[nan,", "'intrinsics' holds 'nan', expected a finite number"},
       {"[458.654,", "[wide,", "'intrinsics' holds 'wide', expected a finite number"},
       {"[458.654,", "[\"wide\\nopen\",",
        "'intrinsics' holds 'wide?open', expected a finite number"},
       {"[458.654,", "[1e999,", "'intrinsics' holds '1e999', expected a finite number"},
       {"[458.654,", "[0,", "'intrinsics' has a focal length of 0: the camera is not calibrated"},
       {"[458.654,", "[-458.654,", "lens.yaml: focal length fx is -458.654 px, expected"},
       {"[458.654, 457.296, 367.215, 248.375]", "458",
        "'intrinsics' is not a list of numbers, expected one"},
       {"[752, 480]", "[752.5, 480]", "'resolution' holds 752.5, expected whole pixels"},
       {"[752, 480]", "[1e300, 480]", "'resolution' holds 1e+300, expected whole pixels"},
       {"[752, 480]", "[0, 480]", "lens.yaml: image width is 0 px, expected 1 to 65535"},
       {"[752, 480]", "[752, 480, 3]", "'resolution' has 3 numbers, expected 2: width, height"},
       {"[-0.28340811, ", "[", "has 3 coefficients, expected 4, 5 or 8: k1, k2, p1, p2"},
       {"[-0.28340811, ", "[{a: 1}, ",
        "'distortion_coefficients' holds something else than numbers"},
       {"radial-tangential", "none", "has coefficients that are not zero, expected none"},
       {"radial-tangential", "[1]", "'distortion_model' is not a text, expected one"},
       {"0, 0, -1, -0.05", "0, 0, -1.1, -0.05",
        "lens.yaml:4: 'T_BS' is not a rigid transform, expected a right-handed orthonormal"},
       {"0, 0, -1, -0.05", "0, 0, 1, -0.05", "'T_BS' is not a rigid transform"},
       {"0, 0, 0, 1]", "0, 0, 0, 2]", "expected 0, 0, 0, 1 in the last row"},
       {"0, 0, 0, 1]", "0, 0, 1]", "'T_BS' has 15 numbers, expected 4 rows of 4"},
       {"cols: 4\n  rows: 4\n", "", "'T_BS' has no key 'rows', expected the number of rows"}});
}

TEST(CalibrationReader, RefusesMalformedKalibrFiles) {
  ExpectRefusals(
      kKalibr,
      {{"0.0034, ", "", "'cam0.distortion_coeffs' has 3 coefficients, expected 4: k1, k2, k3, k4"},
       {"-0.00012", "soon", "'cam0.timeshift_cam_imu' holds 'soon', expected a finite number"},
       {"-0.00012", "1e12", "'cam0.timeshift_cam_imu' is 1000000000000 s, expected at most"},
       {"  - [0.0, 0.0, 0.0, 1.0]\n", "",
        "'cam0.T_cam_imu' has 12 numbers, expected 16: a 4x4 matrix"},
       {"  resolution: [512, 512]\n", "", "'cam0' has no size of the images"}});
}

TEST(CalibrationReader, RefusesMalformedMatrixFiles) {
  ExpectRefusals(
      kRos,
      {{"[438.783367,", "[0.0,", "'camera_matrix' has a focal length of 0: the camera is not"},
       {"[438.783367, 0.000000,", "[438.783367, 0.1,",
        "'camera_matrix' is not a camera matrix without skew"},
       {"image_width: 640\n", "",
        "the file has no size of the images in pixels, expected 'image_width' and"},
       {"image_width: 640", "image_width: 640.5", "'image_width' is not an integer"},
       {"image_width: 640", "image_width: 99999999999", "'image_width' is not an integer"},
       {"cols: 5", "cols: 4", "'distortion_coefficients' has 5 numbers, expected 1 rows of 4"},
       {"plumb_bob", "thin_prism", "'distortion_model' is 'thin_prism', which is not supported"},
       {"camera_name: belly", "camera_name: [1]", "'camera_name' is not a text"}});
}

// The same lens in the words of other tools.
constexpr const char* kCamodocal = R"(%YAML:1.0
---
model_type: KANNALA_BRANDT
camera_name: front
image_width: 320
image_height: 240
projection_parameters:
   k2: 0.01
   k3: -0.02
   k4: 0.03
   k5: -0.04
   mu: 300.5
   mv: 301.0
   u0: 159.5
   v0: 119.5
)";

constexpr const char* kVins = R"(%YAML:1.0
imu_topic: /imu0
model_type: PINHOLE
camera_name: camera
image_width: 320
image_height: 240
distortion_parameters:
   k1: -0.1
   k2: 0.02
   p1: 0.001
   p2: -0.001
projection_parameters:
   fx: 300.5
   fy: 301.0
   cx: 159.5
   cy: 119.5
extrinsicRotation: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [0, -1, 0, -1, 0, 0, 0, 0, -1]
extrinsicTranslation: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [0.1, 0.2, -0.05]
td: 0.02
)";

constexpr const char* kOrbSlam = R"(%YAML:1.0
Camera.type: "KannalaBrandt8"
Camera1.fx: 300.5
Camera1.fy: 301.0
Camera1.cx: 159.5
Camera1.cy: 119.5
Camera1.k1: 0.01
Camera1.k2: -0.02
Camera1.k3: 0.03
Camera1.k4: -0.04
Camera.width: 320
Camera.height: 240
Camera.fps: 30
)";

TEST(CalibrationReader, ReadsCamodocal) {
  const CameraCalibration read = ParseCalibration(kCamodocal, "front.yaml");
  EXPECT_EQ(read.name, "front");
  EXPECT_EQ(read.intrinsics.distortion_model, DistortionModel::kEquidistant);
  EXPECT_EQ(read.intrinsics.fx_px, 300.5);
  EXPECT_EQ(read.intrinsics.fy_px, 301);
  EXPECT_EQ(read.intrinsics.cy_px, 119.5);
  EXPECT_THAT(read.intrinsics.distortion, ElementsAre(0.01, -0.02, 0.03, -0.04));
  ExpectRefusals(
      kCamodocal,
      {{"KANNALA_BRANDT", "MEI",
        "lens.yaml:3: 'model_type' is 'MEI', which is not supported, expected PINHOLE or"},
       {"   mu: 300.5\n", "", "has no parameter 'mu', expected it for the lens KANNALA_BRANDT"},
       {"mu: 300.5", "mu: 0", "has a focal length of 0"}});
}

TEST(CalibrationReader, ReadsVins) {
  const CameraCalibration read = ParseCalibration(kVins, "config.yaml");
  EXPECT_EQ(read.intrinsics.distortion_model, DistortionModel::kRadialTangential);
  EXPECT_THAT(read.intrinsics.distortion, ElementsAre(-0.1, 0.02, 0.001, -0.001));
  ASSERT_TRUE(read.body_from_camera && read.clock_offset);
  EXPECT_TRUE((*read.body_from_camera * Eigen::Vector3d(0, -1, 0))
                  .isApprox(Eigen::Vector3d(1.1, 0.2, -0.05), 1e-12));
  EXPECT_EQ(*read.clock_offset, std::chrono::milliseconds(20));
  EXPECT_EQ(WarningsOf(kVins), "lens.yaml: not used, as not known here: 'imu_topic'");
  EXPECT_THAT(ParseCalibration(Replaced(kVins, "p2: -0.001", "p2: -0.001\n   k3: 0.5"), "")
                  .intrinsics.distortion,
              ElementsAre(-0.1, 0.02, 0.001, -0.001, 0.5));
}

TEST(CalibrationReader, ReadsOrbSlam) {
  const CameraIntrinsics read = ParseCalibration(kOrbSlam, "orb.yaml").intrinsics;
  EXPECT_EQ(read.distortion_model, DistortionModel::kEquidistant);
  EXPECT_EQ(read.width_px, 320);
  EXPECT_EQ(read.fy_px, 301);
  EXPECT_THAT(read.distortion, ElementsAre(0.01, -0.02, 0.03, -0.04));
}

TEST(CalibrationReader, ReadsOpenCvXml) {
  cv::FileStorage storage("lens.xml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  storage << "image_width" << 320 << "image_height" << 240;
  storage << "camera_matrix" << (cv::Mat_<double>(3, 3) << 300.1, 0, 159.5, 0, 301, 119.5, 0, 0, 1);
  storage << "distortion_coefficients" << (cv::Mat_<double>(5, 1) << -0.01, 1. / 3, 0, 0, 0);
  storage << "camera_name"
          << "a camera"
          << "image_size" << cv::Size(320, 240);
  const std::string xml = storage.releaseAndGetString();
  const CameraCalibration read = ParseCalibration(xml, "lens.xml");
  EXPECT_EQ(read.name, "a camera");
  EXPECT_EQ(read.intrinsics.width_px, 320);
  EXPECT_EQ(read.intrinsics.fx_px, 300.1);
  EXPECT_THAT(read.intrinsics.distortion, ElementsAre(-0.01, 1. / 3, 0, 0, 0));
  for (std::size_t length = 1; length + 20 < xml.size(); length += 7) {
    EXPECT_THROW(ParseCalibration(xml.substr(0, length), "lens.xml"), InputError) << length;
  }
  EXPECT_THAT(Refusal("<?xml version=\r\r v_s>\n"), HasSubstr("is not OpenCV's XML"));
}

// Files as Python's tutorials write them: nested lists, floating-point sizes, names of the author.
TEST(CalibrationReader, ReadsKeysInEverySpelling) {
  for (const char* matrix : {"camera_matrix", "mtx", "cameraMatrix", "CameraMatrix", "K"}) {
    for (const char* coefficients :
         {"dist_coeff", "dist_coeffs", "distCoeffs", "dist", "distortion_coefficients", "D"}) {
      const std::string text = fmt::format(
          "{{\"image_width\": 320.0, \"image_height\": 2.4e2,\n"
          "\"{}\": [[300.0, 0.0, 159.5], [0.0, 300.0, 119.5], [0.0, 0.0, 1.0]],\n"
          "\"{}\": [[-0.01, 0.002, 0.0, 0.0, 0.0]]}}\n",
          matrix, coefficients);
      const CameraIntrinsics read = ParseCalibration(text, "lens.json").intrinsics;
      EXPECT_EQ(read.width_px, 320);
      EXPECT_EQ(read.height_px, 240);
      EXPECT_THAT(read.distortion, ElementsAre(-0.01, 0.002, 0, 0, 0));
    }
  }
}

TEST(CalibrationReader, ReportsContradictoryKeys) {
  const std::string both = Replaced(kRos, "camera_name", "image_size: [480, 640]\ncamera_name");
  EXPECT_THAT(Refusal(both), AllOf(HasSubstr("'image_size'"), HasSubstr("480x640"),
                                   HasSubstr("'image_width', 'image_height'")));
  EXPECT_EQ(ParseCalibration(Replaced(both, "[480, 640]", "[640, 480]"), "").intrinsics.width_px,
            640);
  EXPECT_THAT(Refusal(std::string(kRos) + "D: [0, 0, 0, 0, 0]\n"),
              HasSubstr("'D' contradicts 'distortion_coefficients', expected one of them"));
  EXPECT_THAT(Refusal(std::string(kRos) + "imageWidth: 641\n"),
              HasSubstr("'imageWidth' contradicts 'image_width'"));
}

TEST(CalibrationReader, RefusesBinningAndRegionsOfInterest) {
  const std::string message = Replaced(kRosMessage, "---\n", "");
  const auto refusal = [&](const std::string& more) { return Refusal(message + more); };
  EXPECT_THAT(refusal("binning_x: 2\n"),
              HasSubstr("'binning_x' is 2: tells of binning or a region of interest"));
  EXPECT_THAT(refusal("binning_x: 1\nbinning_y: 4\n"), HasSubstr("'binning_y' is 4"));
  EXPECT_THAT(refusal("roi: {x_offset: 8, y_offset: 0, width: 0, height: 0}\n"),
              HasSubstr("'roi.x_offset' is 8: tells of binning or a region of interest"));
  EXPECT_THAT(refusal("roi: {x_offset: 0, y_offset: 0, width: 376, height: 480}\n"),
              HasSubstr("'roi.width' is 376"));
  for (const char* whole : {"binning_x: 0\nbinning_y: 1\n",
                            "roi: {x_offset: 0, y_offset: 0, width: 752, height: 480}\n",
                            "roi: {x_offset: 0, y_offset: 0, width: 0, height: 0}\n"}) {
    EXPECT_EQ(ParseCalibration(message + whole, "").intrinsics.width_px, 752) << whole;
  }
}

TEST(CalibrationReader, ReportsUnusedKeys) {
  for (const char* text : {kEuroc, kKalibr, kRos, kRosMessage, kOpenCv, kCamodocal}) {
    EXPECT_EQ(WarningsOf(text), "") << text;
  }
  EXPECT_EQ(WarningsOf(std::string(kEuroc) + "T_BX: 3\nlens_shift: 2\n"),
            "lens.yaml: not used, as not known here: 'T_BX', 'lens_shift'");
  EXPECT_EQ(WarningsOf(std::string(kKalibr) + "T_imu_body: []\n"),
            "lens.yaml: not used, as not known here: 'T_imu_body'");
  std::string many = kRos;
  for (int i = 0; i < 20; ++i) many += fmt::format("key{}: {}\n", i, i);
  EXPECT_THAT(WarningsOf(many), HasSubstr("'key7' and 12 more"));
}

TEST(CalibrationReader, RefusesFileWithoutCalibration) {
  EXPECT_THAT(Refusal(""), HasSubstr("is not a camera calibration, expected EuRoC"));
  EXPECT_THAT(Refusal("just words"), HasSubstr("is not a camera calibration"));
  EXPECT_THAT(Refusal("[1, 2]"), HasSubstr("is not a camera calibration"));
  EXPECT_THAT(Refusal("<?xml version=\"1.0\"?>\n<opencv_storage>\n"),
              HasSubstr("is not OpenCV's XML (<opencv_storage>) or is truncated"));
  EXPECT_THAT(Refusal("<html><body>404</body></html>\n"), HasSubstr("is not OpenCV's XML"));
  EXPECT_THAT(Refusal(std::string("PK\x03\x04\0\0mtx.npy", 13)), HasSubstr("the file is binary"));
  EXPECT_THAT(Refusal("a: [1, 2\nb: 3\n"), HasSubstr("the file is not YAML or is truncated"));
  EXPECT_THAT(Refusal(std::string(2 << 20, ' ')), HasSubstr("has 2097152 bytes, expected"));
}

// A truncated calibration is refused wherever it ends, and never crashes the reader.
TEST(CalibrationReader, RefusesTruncatedFiles) {
  for (const std::string text : {kEuroc, kRos, kOpenCv}) {
    const std::size_t last_number = text.find_last_of("0123456789");
    const std::size_t end = std::min(last_number, text.find("rectification_matrix"));
    for (std::size_t length = 0; length < end; length += 3) {
      EXPECT_THROW(ParseCalibration(text.substr(0, length), "lens.yaml"), InputError) << length;
    }
  }
}

TEST(CalibrationReader, ReadsFilesAndReportsMissingOnes) {
  const TestFolder folder;
  const std::string file = folder.Write("any_name.txt", kEuroc);
  EXPECT_EQ(ReadCalibration(file).intrinsics.fx_px, 458.654);
  const std::string missing = folder / "missing.yaml";
  try {
    ReadCalibration(missing);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(StartsWith(missing), HasSubstr("no such file")));
  }
}

}  // namespace
}  // namespace kestrel

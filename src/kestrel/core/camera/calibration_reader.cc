// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/calibration_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/shown.h"
#include "kestrel/core/base/yaml_reader.h"

namespace kestrel {
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;   // a calibration has a few kilobytes
constexpr double kMaxClockOffset_s = 4e9;    // fits into a Duration and spans two epochs
constexpr double kRotationTolerance = 1e-3;  // of matrices typed with four digits

using Names = std::initializer_list<const char*>;

// A value of the file with the path of its key, so that every message can name both.
class Entry {
 public:
  Entry(const std::string* file, const YAML::Node& node, std::string key)
      : file_(file), node_(node), key_(std::move(key)) {}

  const YAML::Node& node() const { return node_; }
  const std::string& key() const { return key_; }

  // 'what' continues the sentence that begins with the key.
  [[noreturn]] void Fail(const std::string& what) const {
    const std::string line =
        node_.Mark().is_null() ? "" : fmt::format("{}:", node_.Mark().line + 1);
    const std::string subject = key_.empty() ? "the file" : fmt::format("'{}'", key_);
    throw InputError(fmt::format("{}:{} {} {}", *file_, line, subject, what));
  }

  // Returns the first of 'names' that this map has.
  std::optional<Entry> Find(Names names) const {
    if (!node_.IsMap()) Fail("is not a map of keys, expected one");
    for (const char* name : names) {
      const YAML::Node child = node_[name];
      if (child) RequireOnce(name);
      if (child) return Entry(file_, child, key_.empty() ? name : key_ + "." + name);
    }
    return std::nullopt;
  }
  Entry Get(Names names, const std::string& expected) const {
    const std::optional<Entry> child = Find(names);
    if (!child) {
      Fail(fmt::format("has no key '{}', expected {}", fmt::join(names, "' or '"), expected));
    }
    return *child;
  }

  std::string Text() const {
    if (!node_.IsScalar()) Fail("is not a text, expected one");
    return node_.Scalar();
  }
  double Number() const { return NumberOf(node_); }
  int Integer() const {
    const std::optional<int> number =
        node_.IsScalar() ? ParseNumber<int>(node_.Scalar()) : std::nullopt;
    if (!number) Fail("is not an integer, expected one");
    return *number;
  }
  // Reads a list, a list of rows, or a matrix with rows, cols and data: row by row.
  std::vector<double> Numbers() const {
    if (node_.IsMap()) return MatrixNumbers();
    if (!node_.IsSequence()) Fail("is not a list of numbers, expected one");
    std::vector<double> numbers;
    for (const YAML::Node& row : node_) {
      if (!row.IsSequence()) {
        numbers.push_back(NumberOf(row));
        continue;
      }
      for (const YAML::Node& number : row) numbers.push_back(NumberOf(number));
    }
    return numbers;
  }
  std::vector<double> Numbers(std::size_t count, const std::string& expected) const {
    std::vector<double> numbers = Numbers();
    if (numbers.size() != count) {
      Fail(fmt::format("has {} numbers, expected {}: {}", numbers.size(), count, expected));
    }
    return numbers;
  }

 private:
  void RequireOnce(const char* name) const {
    const auto count = std::count_if(node_.begin(), node_.end(), [&](const auto& pair) {
      return pair.first.IsScalar() && pair.first.Scalar() == name;
    });
    if (count > 1) Fail(fmt::format("has '{}' {} times, expected it once", name, count));
  }
  double NumberOf(const YAML::Node& node) const {
    if (!node.IsScalar()) Fail("holds something else than numbers, expected finite numbers");
    const std::optional<double> number = ParseNumber<double>(node.Scalar());
    if (!number) Fail(fmt::format("holds '{}', expected a finite number", Shown(node.Scalar())));
    return *number;
  }
  std::vector<double> MatrixNumbers() const {
    std::vector<double> numbers = Get({"data"}, "the numbers of the matrix").ListNumbers();
    const std::int64_t rows = Get({"rows"}, "the number of rows").Integer();
    const std::int64_t cols = Get({"cols"}, "the number of columns").Integer();
    if (rows * cols != static_cast<std::int64_t>(numbers.size())) {
      Fail(fmt::format("has {} numbers, expected {} rows of {}", numbers.size(), rows, cols));
    }
    return numbers;
  }
  std::vector<double> ListNumbers() const {
    if (!node_.IsSequence()) Fail("is not a list of numbers, expected one");
    return Numbers();
  }

  const std::string* file_;
  YAML::Node node_;
  std::string key_;
};

constexpr const char* kSupportedModels =
    "equidistant (fisheye, kannala_brandt, kb4), radial-tangential (radtan, plumb_bob, "
    "rational_polynomial) or none (pinhole)";

// Returns the lens for a name in any of the tools.
DistortionModel ModelOf(const Entry& entry) {
  static constexpr std::array<std::pair<const char*, DistortionModel>, 15> kNames{{
      {"equidistant", DistortionModel::kEquidistant},
      {"fisheye", DistortionModel::kEquidistant},
      {"kannala_brandt", DistortionModel::kEquidistant},
      {"kannala_brandt4", DistortionModel::kEquidistant},
      {"kb4", DistortionModel::kEquidistant},
      {"radial_tangential", DistortionModel::kRadialTangential},
      {"radtan", DistortionModel::kRadialTangential},
      {"radtan4", DistortionModel::kRadialTangential},
      {"radtan5", DistortionModel::kRadialTangential},
      {"radtan8", DistortionModel::kRadialTangential},
      {"plumb_bob", DistortionModel::kRadialTangential},
      {"rational_polynomial", DistortionModel::kRadialTangential},
      {"none", DistortionModel::kNone},
      {"pinhole", DistortionModel::kNone},
      {"", DistortionModel::kNone},
  }};
  std::string name = entry.Text();
  for (char& c : name) c = c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(c));
  for (const auto& [known, model] : kNames) {
    if (name == known) return model;
  }
  entry.Fail(fmt::format("is '{}', which is not supported, expected {}", Shown(entry.Text()),
                         kSupportedModels));
}

bool IsZero(double number) { return number == 0; }

// Trims the coefficients to those of the model: none for a pinhole with zeros, at most 8 for
// OpenCV's 12 and 14 when those of the prism and of the tilted sensor are zero.
std::vector<double> TrimDistortion(DistortionModel model, std::vector<double> distortion) {
  const std::size_t used = model == DistortionModel::kNone ? 0 : 8;
  if (distortion.size() > used &&
      std::all_of(distortion.begin() + static_cast<std::ptrdiff_t>(used), distortion.end(),
                  IsZero)) {
    distortion.resize(used);
  }
  return distortion;
}

void SetDistortion(DistortionModel model, const Entry& entry, CameraIntrinsics* intrinsics) {
  intrinsics->distortion_model = model;
  intrinsics->distortion = TrimDistortion(model, entry.Numbers());
  const std::size_t count = intrinsics->distortion.size();
  if (model == DistortionModel::kNone && count != 0) {
    entry.Fail("has coefficients that are not zero, expected none as 'distortion_model' says");
  }
  if (model == DistortionModel::kEquidistant && count != 4) {
    entry.Fail(fmt::format("has {} coefficients, expected 4: k1, k2, k3, k4", count));
  }
  if (model == DistortionModel::kRadialTangential && count != 4 && count != 5 && count != 8) {
    entry.Fail(
        fmt::format("has {} coefficients, expected 4, 5 or 8: k1, k2, p1, p2, [k3, "
                    "[k4, k5, k6]]",
                    count));
  }
}

RigidTransform RigidOf(const Entry& entry) {
  const std::vector<double> m = entry.Numbers(16, "a 4x4 matrix, row by row");
  const Eigen::Matrix4d matrix =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(m.data());
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const double error =
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= kRotationTolerance) || rotation.determinant() < 0) {
    entry.Fail("is not a rigid transform, expected a right-handed orthonormal rotation");
  }
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    entry.Fail("is not a rigid transform, expected 0, 0, 0, 1 in the last row");
  }
  const Eigen::Vector3d translation = matrix.topRightCorner<3, 1>();
  return {Eigen::Quaterniond(rotation).normalized(), translation};
}

void SetMount(const Entry& camera, CameraCalibration* calibration) {
  if (const std::optional<Entry> pose = camera.Find({"T_BS"})) {
    calibration->body_from_camera = RigidOf(*pose);
  } else if (const std::optional<Entry> inverse = camera.Find({"T_cam_imu"})) {
    calibration->body_from_camera = RigidOf(*inverse).Inverse();
  }
  const std::optional<Entry> shift = camera.Find({"timeshift_cam_imu"});
  if (!shift) return;
  const double shift_s = shift->Number();
  if (std::abs(shift_s) > kMaxClockOffset_s) {
    shift->Fail(
        fmt::format("is {} s, expected at most {} s either way", shift_s, kMaxClockOffset_s));
  }
  calibration->clock_offset = DurationFromSeconds(shift_s);
}

int PixelCount(const Entry& entry, double number) {
  // Validate() checks the limits of an image; this one only keeps the conversion defined.
  if (number != std::floor(number) || std::abs(number) > 1e9) {
    entry.Fail(fmt::format("holds {}, expected whole pixels", number));
  }
  return static_cast<int>(number);
}

void SetSize(const Entry& entry, CameraIntrinsics* intrinsics) {
  const std::vector<double> size = entry.Numbers(2, "width, height");
  intrinsics->width_px = PixelCount(entry, size[0]);
  intrinsics->height_px = PixelCount(entry, size[1]);
}

void RequireCalibrated(const Entry& entry, const CameraIntrinsics& intrinsics) {
  if (intrinsics.fx_px == 0 || intrinsics.fy_px == 0) {
    entry.Fail("has a focal length of 0: the camera is not calibrated");
  }
}

// The form of EuRoC and Kalibr: a list of four intrinsics.
CameraCalibration ReadListForm(const Entry& camera) {
  if (const std::optional<Entry> model = camera.Find({"camera_model"})) {
    if (model->Text() != "pinhole") {
      model->Fail(
          fmt::format("is '{}', which is not supported, expected pinhole with a "
                      "'distortion_model' of {}",
                      Shown(model->Text()), kSupportedModels));
    }
  }
  CameraCalibration calibration;
  CameraIntrinsics& intrinsics = calibration.intrinsics;
  SetSize(camera.Get({"resolution"}, "[width, height]"), &intrinsics);
  const Entry list = camera.Get({"intrinsics"}, "[fu, fv, cu, cv]");
  const std::vector<double> values = list.Numbers(4, "fu, fv, cu, cv");
  intrinsics.fx_px = values[0];
  intrinsics.fy_px = values[1];
  intrinsics.cx_px = values[2];
  intrinsics.cy_px = values[3];
  RequireCalibrated(list, intrinsics);
  const DistortionModel model = ModelOf(camera.Get({"distortion_model"}, kSupportedModels));
  const Names names{"distortion_coefficients", "distortion_coeffs"};
  if (model != DistortionModel::kNone || camera.Find(names)) {
    SetDistortion(model, camera.Get(names, "the coefficients of the lens"), &intrinsics);
  }
  SetMount(camera, &calibration);
  return calibration;
}

// Returns the lens of a file with a camera matrix: by name, by OpenCV's flag, or by the number of
// coefficients where that suffices.
DistortionModel MatrixFormModel(const Entry& camera, const Entry& coefficients) {
  if (const std::optional<Entry> flag = camera.Find({"fisheye_model"})) {
    const std::string text = flag->Text();
    if (text == "1" || text == "true") return DistortionModel::kEquidistant;
    if (text == "0" || text == "false") return DistortionModel::kRadialTangential;
    flag->Fail(fmt::format("is '{}', expected 0 or 1", Shown(text)));
  }
  if (const std::optional<Entry> name = camera.Find({"distortion_model"})) return ModelOf(*name);
  const std::size_t count = coefficients.Numbers().size();
  if (const std::optional<Entry> name = camera.Find({"model", "camera_model", "camera_type"})) {
    // "pinhole" as the kind of camera leaves the distortion open.
    const DistortionModel model = ModelOf(*name);
    if (model != DistortionModel::kNone || count == 0) return model;
  }
  if (count == 4) {
    coefficients.Fail(
        "has 4 coefficients, which may be a fisheye's or a radial-tangential lens's, expected a "
        "key 'fisheye_model' (0 or 1) or 'distortion_model' to tell");
  }
  return count == 0 ? DistortionModel::kNone : DistortionModel::kRadialTangential;
}

void SetMatrixFormSize(const Entry& camera, CameraIntrinsics* intrinsics) {
  if (const std::optional<Entry> size = camera.Find({"image_size"})) {
    SetSize(*size, intrinsics);
    return;
  }
  intrinsics->width_px =
      camera.Get({"image_width", "image_Width", "width"}, "the image's width in pixels").Integer();
  intrinsics->height_px =
      camera.Get({"image_height", "image_Height", "height"}, "the image's height in pixels")
          .Integer();
}

const Names kMatrixNames{"camera_matrix", "Camera_Matrix", "cameraMatrix", "K", "k"};
const Names kCoefficientNames{
    "distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "dist_coeffs", "D", "d"};

// The form of ROS and OpenCV: a 3x3 camera matrix.
CameraCalibration ReadMatrixForm(const Entry& camera) {
  CameraCalibration calibration;
  CameraIntrinsics& intrinsics = calibration.intrinsics;
  SetMatrixFormSize(camera, &intrinsics);
  const Entry matrix = camera.Get(kMatrixNames, "a 3x3 matrix");
  const std::vector<double> k = matrix.Numbers(9, "a 3x3 matrix, row by row");
  intrinsics.fx_px = k[0];
  intrinsics.cx_px = k[2];
  intrinsics.fy_px = k[4];
  intrinsics.cy_px = k[5];
  RequireCalibrated(matrix, intrinsics);
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    matrix.Fail("is not a camera matrix without skew, expected fx, 0, cx, 0, fy, cy, 0, 0, 1");
  }
  const Entry coefficients = camera.Get(kCoefficientNames, "the coefficients of the lens");
  SetDistortion(MatrixFormModel(camera, coefficients), coefficients, &intrinsics);
  SetMount(camera, &calibration);
  if (const std::optional<Entry> name = camera.Find({"camera_name"})) {
    calibration.name = name->Text();
  }
  return calibration;
}

bool IsCameraKey(const std::string& key) {
  return key.size() > 3 && key.starts_with("cam") &&
         std::all_of(key.begin() + 3, key.end(), [](unsigned char c) { return std::isdigit(c); });
}

// Returns the names of a Kalibr chain's cameras, in the order of the file.
std::vector<std::string> ChainCameras(const Entry& root) {
  std::vector<std::string> names;
  for (const auto& item : root.node()) {
    if (item.first.IsScalar() && IsCameraKey(item.first.Scalar()) && item.second.IsMap()) {
      names.push_back(item.first.Scalar());
    }
  }
  return names;
}

CameraCalibration ReadChain(const Entry& root, const std::vector<std::string>& names,
                            const std::string& camera) {
  const std::string& name = camera.empty() ? names.front() : camera;
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    root.Fail(fmt::format("has no camera '{}', expected one of {}", name, fmt::join(names, ", ")));
  }
  CameraCalibration calibration =
      ReadListForm(root.Get({name.c_str()}, "the camera's calibration"));
  calibration.name = name;
  return calibration;
}

CameraCalibration ReadRoot(const Entry& root, const std::string& camera) {
  if (!root.node().IsMap()) {
    root.Fail(
        "is not a camera calibration, expected EuRoC sensor.yaml, Kalibr camchain.yaml, ROS "
        "camera_info or OpenCV YAML");
  }
  const std::vector<std::string> chain = ChainCameras(root);
  if (!chain.empty()) return ReadChain(root, chain, camera);
  if (root.Find({"intrinsics"})) return ReadListForm(root);
  if (root.Find(kMatrixNames)) return ReadMatrixForm(root);
  root.Fail(
      "has no key 'intrinsics' (EuRoC), 'cam0' (Kalibr) or 'camera_matrix' (ROS, OpenCV), expected "
      "one of them");
}

void RequireSmall(std::string_view text, const std::string& file) {
  if (text.size() <= kMaxBytes) return;
  throw InputError(
      fmt::format("{}: the file has {} bytes, expected a camera calibration of at most {}", file,
                  text.size(), kMaxBytes));
}

}  // namespace

CameraCalibration ReadCalibration(const std::filesystem::path& file, const std::string& camera) {
  return ParseCalibration(ReadFile(file.string()), file.string(), camera);
}

CameraCalibration ParseCalibration(std::string_view text, const std::string& file,
                                   const std::string& camera) {
  RequireSmall(text, file);
  CameraCalibration calibration;
  try {
    calibration = ReadRoot(Entry(&file, YAML::Load(WithoutYamlDirective(text)), ""), camera);
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}: the file is not YAML or is truncated: {}", file,
                                 error.mark.line + 1, Shown(error.msg)));
  }
  const std::vector<std::string> violations = calibration.intrinsics.Validate();
  if (!violations.empty()) {
    throw InputError(fmt::format("{}: {}", file, fmt::join(violations, "; ")));
  }
  return calibration;
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/calibration_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/shown.h"
#include "kestrel/core/camera/calibration_entry.h"
#include "kestrel/core/camera/calibration_mount.h"
#include "kestrel/core/camera/opencv_xml.h"

namespace kestrel {
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;  // a calibration has a few kilobytes

using Entry = CalibrationEntry;
using Names = CalibrationEntry::Names;

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

int PixelCount(const Entry& entry, double number) {
  // Validate() checks the limits of an image; this one only keeps the conversion defined.
  if (number != std::floor(number) || std::abs(number) > 1e9) {
    entry.Fail(fmt::format("holds {}, expected whole pixels", number));
  }
  return static_cast<int>(number);
}

// Returns width and height; nothing where the file has no list of both.
std::optional<std::pair<int, int>> ListedSize(const Entry& camera) {
  const std::optional<Entry> size = camera.Find({"resolution", "image_size", "image_resolution"});
  if (!size) return std::nullopt;
  const std::vector<double> numbers = size->Numbers(2, "width, height");
  return std::pair(PixelCount(*size, numbers[0]), PixelCount(*size, numbers[1]));
}

void SetSize(const Entry& camera, CameraIntrinsics* intrinsics) {
  const auto listed = ListedSize(camera);
  const std::optional<Entry> width = camera.Find({"image_width", "width", "Camera.width"});
  const std::optional<Entry> height = camera.Find({"image_height", "height", "Camera.height"});
  if (listed) std::tie(intrinsics->width_px, intrinsics->height_px) = *listed;
  if (listed && !width && !height) return;
  if (!width || !height) {
    camera.Fail(
        "has no size of the images in pixels, expected 'image_width' and 'image_height', or "
        "'resolution: [width, height]'");
  }
  intrinsics->width_px = width->Integer();
  intrinsics->height_px = height->Integer();
  if (listed && *listed != std::pair(intrinsics->width_px, intrinsics->height_px)) {
    camera.Fail(fmt::format(
        "has images of {}x{} px ('image_size' or 'resolution') and of {}x{} px ('{}', '{}'), "
        "expected one size",
        listed->first, listed->second, intrinsics->width_px, intrinsics->height_px, width->key(),
        height->key()));
  }
}

void RequireCalibrated(const Entry& entry, const CameraIntrinsics& intrinsics) {
  if (intrinsics.fx_px == 0 || intrinsics.fy_px == 0) {
    entry.Fail("has a focal length of 0: the camera is not calibrated");
  }
}

constexpr Names kMatrixNames{"camera_matrix", "K", "mtx", "intrinsic_matrix"};
constexpr Names kCoefficientNames{
    "distortion_coefficients", "distortion_coeffs", "dist_coeffs", "dist_coeff", "dist", "D"};

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
  SetSize(camera, &intrinsics);
  const Entry list = camera.Get({"intrinsics"}, "[fu, fv, cu, cv]");
  const std::vector<double> values = list.Numbers(4, "fu, fv, cu, cv");
  intrinsics.fx_px = values[0];
  intrinsics.fy_px = values[1];
  intrinsics.cx_px = values[2];
  intrinsics.cy_px = values[3];
  RequireCalibrated(list, intrinsics);
  const DistortionModel model = ModelOf(camera.Get({"distortion_model"}, kSupportedModels));
  if (model != DistortionModel::kNone || camera.Find(kCoefficientNames)) {
    SetDistortion(model, camera.Get(kCoefficientNames, "the coefficients of the lens"),
                  &intrinsics);
  }
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
  for (const char* key : {"model", "camera_model", "camera_type"}) {
    const std::optional<Entry> name = camera.Find({key});
    if (!name) continue;
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

// The form of ROS and OpenCV: a 3x3 camera matrix.
CameraCalibration ReadMatrixForm(const Entry& camera) {
  CameraCalibration calibration;
  CameraIntrinsics& intrinsics = calibration.intrinsics;
  SetSize(camera, &intrinsics);
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
  return calibration;
}

// A lens whose parameters have a key each.
struct NamedLens {
  const char* type;
  DistortionModel model;
  std::array<const char*, 4> pinhole;  // keys of fx, fy, cx, cy
  std::vector<const char*> coefficients;
};

// Returns the value of a parameter.
using Parameter = std::function<std::optional<Entry>(const char* name)>;

CameraCalibration ReadNamedForm(const Entry& camera, const Entry& type,
                                const std::vector<NamedLens>& lenses, const Parameter& find) {
  const auto lens = std::find_if(lenses.begin(), lenses.end(), [&](const NamedLens& each) {
    return PlainKey(each.type) == PlainKey(type.Text());
  });
  if (lens == lenses.end()) {
    std::vector<std::string> types;
    for (const NamedLens& each : lenses) types.emplace_back(each.type);
    type.Fail(fmt::format("is '{}', which is not supported, expected {}", Shown(type.Text()),
                          fmt::join(types, " or ")));
  }
  const auto number = [&](const char* name) {
    const std::optional<Entry> entry = find(name);
    if (!entry) {
      camera.Fail(
          fmt::format("has no parameter '{}', expected it for the lens {}", name, lens->type));
    }
    return entry->Number();
  };
  CameraCalibration calibration;
  CameraIntrinsics& intrinsics = calibration.intrinsics;
  SetSize(camera, &intrinsics);
  intrinsics.fx_px = number(lens->pinhole[0]);
  intrinsics.fy_px = number(lens->pinhole[1]);
  intrinsics.cx_px = number(lens->pinhole[2]);
  intrinsics.cy_px = number(lens->pinhole[3]);
  RequireCalibrated(type, intrinsics);
  intrinsics.distortion_model = lens->model;
  for (const char* name : lens->coefficients) intrinsics.distortion.push_back(number(name));
  const bool may_have_k3 = lens->model == DistortionModel::kRadialTangential &&
                           lens->coefficients.size() == 4 && find("k3").has_value();
  if (may_have_k3) intrinsics.distortion.push_back(number("k3"));
  return calibration;
}

// The form of camodocal and VINS.
CameraCalibration ReadCamodocalForm(const Entry& camera, const Entry& type) {
  static const std::vector<NamedLens> kLenses{{"PINHOLE",
                                               DistortionModel::kRadialTangential,
                                               {"fx", "fy", "cx", "cy"},
                                               {"k1", "k2", "p1", "p2"}},
                                              {"PINHOLE_FULL",
                                               DistortionModel::kRadialTangential,
                                               {"fx", "fy", "cx", "cy"},
                                               {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}},
                                              {"KANNALA_BRANDT",
                                               DistortionModel::kEquidistant,
                                               {"mu", "mv", "u0", "v0"},
                                               {"k2", "k3", "k4", "k5"}}};
  return ReadNamedForm(camera, type, kLenses, [&](const char* name) -> std::optional<Entry> {
    for (const char* group : {"projection_parameters", "distortion_parameters"}) {
      const std::optional<Entry> parameters = camera.Find({group});
      if (!parameters) continue;
      if (std::optional<Entry> entry = parameters->Find({name})) return entry;
    }
    return std::nullopt;
  });
}

// The form of ORB-SLAM: "Camera.fx", since version 3 also "Camera1.fx".
CameraCalibration ReadOrbSlamForm(const Entry& camera, const Entry& type) {
  static const std::vector<NamedLens> kLenses{{"PinHole",
                                               DistortionModel::kRadialTangential,
                                               {"fx", "fy", "cx", "cy"},
                                               {"k1", "k2", "p1", "p2"}},
                                              {"KannalaBrandt8",
                                               DistortionModel::kEquidistant,
                                               {"fx", "fy", "cx", "cy"},
                                               {"k1", "k2", "k3", "k4"}}};
  return ReadNamedForm(camera, type, kLenses, [&](const std::string& name) {
    return camera.Find({("Camera." + name).c_str(), ("Camera1." + name).c_str()});
  });
}

// A calibration holds for whole images. That of a driver which bins or crops is of other images
// than it sends.
void RequireWholeImages(const Entry& camera, const CameraIntrinsics& intrinsics) {
  const auto require = [](const Entry& map, const char* name, int most, int whole) {
    const std::optional<Entry> entry = map.Find({name});
    if (!entry || entry->Integer() <= most || entry->Integer() == whole) return;
    entry->Fail(fmt::format(
        "is {}: tells of binning or a region of interest, expected whole images, or a calibration "
        "of the images as they are, without this key",
        entry->Integer()));
  };
  require(camera, "binning_x", 1, 1);
  require(camera, "binning_y", 1, 1);
  const std::optional<Entry> roi = camera.Find({"roi"});
  if (!roi) return;
  require(*roi, "x_offset", 0, 0);
  require(*roi, "y_offset", 0, 0);
  require(*roi, "width", 0, intrinsics.width_px);
  require(*roi, "height", 0, intrinsics.height_px);
}

// Returns the lens of a map that is of any of the forms; nothing when it is of none.
std::optional<CameraCalibration> ReadLens(const Entry& camera) {
  if (camera.Find({"intrinsics"})) return ReadListForm(camera);
  if (camera.Find(kMatrixNames)) return ReadMatrixForm(camera);
  if (const auto type = camera.Find({"model_type"})) return ReadCamodocalForm(camera, *type);
  if (const auto type = camera.Find({"Camera.type"})) return ReadOrbSlamForm(camera, *type);
  return std::nullopt;
}

// Keys unrelated to lens, mount and clock, as PlainKey has them.
bool IsIrrelevant(const std::string& key) {
  static const std::set<std::string> kKeys{
      // Kestrel, EuRoC
      "sensortype", "comment", "ratehz", "sensorname", "sensorid",
      // Kalibr
      "cameramodel", "camoverlaps", "rostopic", "tcncnm1", "linedelay",
      // ROS; the rectified image's matrices are not the camera's
      "header", "r", "p", "rectificationmatrix", "projectionmatrix", "cameraname", "seq",
      // OpenCV
      "calibrationtime", "nrofframes", "nframes", "boardwidth", "boardheight", "squaresize",
      "markersize", "fixaspectratio", "aspectratio", "flags", "calibrationflags", "fisheyemodel",
      "avgreprojectionerror", "perviewreprojectionerrors", "extrinsicparameters", "gridpoints",
      "imagepoints", "reprojectionerror", "rms", "model", "cameratype", "patterntype",
      "calibrationpattern"};
  return kKeys.contains(PlainKey(key));
}

// Returns which keys of a map were not used.
std::vector<std::string> UnusedKeys(const Entry& map) {
  std::vector<std::string> unused;
  for (const std::string& key : map.Keys()) {
    if (!map.IsUsed(key) && !IsIrrelevant(key)) unused.push_back(fmt::format("'{}'", Shown(key)));
  }
  return unused;
}

// The file that is read, and the function that gets the lines for the user.
struct Teller {
  const std::string& file;
  const std::function<void(const std::string&)>& notify;
};

void ReportUnusedKeys(const Entry& map, const Teller& reporter) {
  constexpr std::size_t kMost = 8;
  std::vector<std::string> unused = UnusedKeys(map);
  if (unused.empty() || !reporter.notify) return;
  const std::size_t more = unused.size() - std::min(unused.size(), kMost);
  unused.resize(unused.size() - more);
  reporter.notify(fmt::format("{}: not used, as not known here: {}{}", reporter.file,
                              fmt::join(unused, ", "),
                              more == 0 ? "" : fmt::format(" and {} more", more)));
}

CameraCalibration ReadCamera(const Entry& camera, const Teller& reporter) {
  std::optional<CameraCalibration> calibration = ReadLens(camera);
  if (!calibration) {
    camera.Fail(
        "has no key 'intrinsics' (EuRoC), 'cam0' (Kalibr), 'camera_matrix' (ROS, OpenCV), "
        "'model_type' (camodocal, VINS) or 'Camera.type' (ORB-SLAM), expected one of them");
  }
  RequireWholeImages(camera, calibration->intrinsics);
  ReadMountAndClock(camera, &*calibration);
  if (const std::optional<Entry> name = camera.Find({"camera_name"})) {
    calibration->name = name->Text();
  }
  ReportUnusedKeys(camera, reporter);
  return *calibration;
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
                            const std::string& camera, const Teller& reporter) {
  const std::string& name = camera.empty() ? names.front() : camera;
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    root.Fail(fmt::format("has no camera '{}', expected one of {}", name, fmt::join(names, ", ")));
  }
  CameraCalibration calibration =
      ReadCamera(root.Get({name.c_str()}, "the camera's calibration"), reporter);
  calibration.name = name;
  // The other cameras' keys count as used.
  for (const std::string& other : names) root.Find({other.c_str()});
  ReportUnusedKeys(root, reporter);
  return calibration;
}

CameraCalibration ReadRoot(const Entry& root, const std::string& camera, const Teller& reporter) {
  if (!root.node().IsMap()) {
    root.Fail(
        "is not a camera calibration, expected EuRoC sensor.yaml, Kalibr camchain.yaml, ROS "
        "camera_info, OpenCV YAML or XML, or that of camodocal, VINS or ORB-SLAM");
  }
  const std::vector<std::string> chain = ChainCameras(root);
  return chain.empty() ? ReadCamera(root, reporter) : ReadChain(root, chain, camera, reporter);
}

void RequireSmall(std::string_view text, const std::string& file) {
  if (text.size() <= kMaxBytes) return;
  throw InputError(
      fmt::format("{}: the file has {} bytes, expected a camera calibration of at most {}", file,
                  text.size(), kMaxBytes));
}

}  // namespace

CameraCalibration ReadCalibration(const std::filesystem::path& file, const std::string& camera,
                                  const std::function<void(const std::string&)>& notify) {
  return ParseCalibration(ReadFile(file.string()), file.string(), camera, notify);
}

CameraCalibration ParseCalibration(std::string_view text, const std::string& file,
                                   const std::string& camera,
                                   const std::function<void(const std::string&)>& notify) {
  RequireSmall(text, file);
  const YAML::Node root = IsXml(text) ? LoadOpenCvXml(text, file) : LoadYaml(text, file);
  CameraCalibration calibration = ReadRoot(Entry(root, file), camera, {file, notify});
  const std::vector<std::string> violations = calibration.intrinsics.Validate();
  if (!violations.empty()) {
    throw InputError(fmt::format("{}: {}", file, fmt::join(violations, "; ")));
  }
  return calibration;
}

}  // namespace kestrel

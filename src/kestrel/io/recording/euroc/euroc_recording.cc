// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/euroc_recording.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/shown.h"
#include "kestrel/core/camera/calibration_entry.h"
#include "kestrel/io/recording/euroc/recording_place.h"
#include "kestrel/io/recording/tables/csv_columns.h"
#include "kestrel/io/recording/tables/csv_table.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

YawFrame ReadYawFrame(const std::string& file) {
  const CalibrationEntry sensor(LoadYaml(ReadFile(file), file), file);
  const CalibrationEntry entry = sensor.Get({"yaw_frame"}, "earth or vehicle");
  for (const YawFrame frame : {YawFrame::kEarth, YawFrame::kVehicle}) {
    if (entry.Text() == ToString(frame)) return frame;
  }
  entry.Fail(fmt::format("is '{}', expected earth or vehicle", Shown(entry.Text())));
}

// True for mav0/cam0, mav0/cam1, ...: what is in it decides, not what is around it.
bool IsCameraFolder(const std::string& folder) {
  const fs::path camera = PlaceOfRecording(folder);
  const std::string name = camera.filename().string();
  std::error_code ignored;
  return name.size() > 3 && name.starts_with("cam") &&
         std::all_of(name.begin() + 3, name.end(),
                     [](unsigned char c) { return std::isdigit(c); }) &&
         fs::exists(camera / "data.csv", ignored);
}

std::vector<GimbalSample> ReadGimbal(const fs::path& folder) {
  const std::string rows = (folder / "data.csv").string();
  if (!fs::exists(rows)) return {};
  return ParseGimbalRows(ReadFile(rows), rows, ReadYawFrame((folder / "sensor.yaml").string()));
}

std::vector<ZoomSample> ReadZoom(const fs::path& folder) {
  const std::string rows = (folder / "data.csv").string();
  if (!fs::exists(rows)) return {};
  return ParseZoomRows(ReadFile(rows), rows);
}

}  // namespace

std::vector<ImageRow> ParseImageRows(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp [ns]");
  const std::size_t filename = table.Column("filename");
  std::vector<ImageRow> rows;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    rows.push_back({times[row], std::string(table.Text(row, filename))});
  }
  return rows;
}

std::vector<PoseSample> ParsePoseRows(std::string_view text, const std::string& file,
                                      const std::string& frames) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp [ns]");
  const PoseColumns columns(table, frames);
  std::vector<PoseSample> samples;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    samples.push_back({times[row], columns.Parse(row)});
  }
  return samples;
}

std::vector<GimbalSample> ParseGimbalRows(std::string_view text, const std::string& file,
                                          YawFrame yaw_frame) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp [ns]");
  const QuaternionColumns attitude(table, "q_WG");
  std::vector<GimbalSample> samples;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    samples.push_back({times[row], attitude.Parse(row), yaw_frame});
  }
  return samples;
}

std::vector<ZoomSample> ParseZoomRows(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp [ns]");
  const std::size_t view = table.Column("hfov [rad]");
  std::vector<ZoomSample> samples;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    samples.push_back({times[row], table.Number(row, view)});
  }
  return samples;
}

std::optional<std::string> FindEurocRoot(const std::string& folder) {
  for (const fs::path& root : {fs::path(folder), fs::path(folder) / "mav0"}) {
    std::error_code ignored;
    if (fs::is_directory(root / "cam0", ignored)) return root.string();
  }
  if (!IsCameraFolder(folder)) return std::nullopt;
  return PlaceOfRecording(folder).parent_path().string();
}

std::vector<std::string> EurocCameras(const std::string& folder) {
  if (IsCameraFolder(folder)) return {PlaceOfRecording(folder).filename().string()};
  const std::optional<std::string> root = FindEurocRoot(folder);
  std::vector<std::string> names;
  for (int i = 0; root; ++i) {
    names.push_back(fmt::format("cam{}", i));
    std::error_code ignored;
    if (fs::is_directory(fs::path(*root) / names.back(), ignored)) continue;
    names.pop_back();
    break;
  }
  return names;
}

ImageSequence OpenEurocRecording(const std::string& folder, const std::string& camera_name) {
  const std::optional<std::string> root = FindEurocRoot(folder);
  if (!root) throw InputError(folder + ": no recording, expected a folder cam0 or mav0/cam0 in it");
  const std::string name = camera_name.empty() ? EurocCameras(folder).front() : camera_name;
  const fs::path camera = fs::path(*root) / name;
  const std::string list = (camera / "data.csv").string();
  std::vector<ImageSequence::Item> items;
  for (const ImageRow& row : ParseImageRows(ReadFile(list), list)) {
    const fs::path path = camera / "data" / row.filename;
    items.push_back({path.lexically_relative(folder).string(), path.string(), row.time});
  }
  if (items.empty()) throw InputError(list + ": no rows, expected one for every image");

  const fs::path calibration = camera / "sensor.yaml";
  const std::string navigation = (fs::path(*root) / "nav0" / "data.csv").string();
  std::vector<PoseSample> poses;
  if (fs::exists(navigation)) poses = ParsePoseRows(ReadFile(navigation), navigation);
  return ImageSequence(std::move(items), fs::exists(calibration) ? calibration.string() : "",
                       std::move(poses), ReadGimbal(fs::path(*root) / "gimbal0"),
                       ReadZoom(fs::path(*root) / "zoom0"));
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/euroc_writer.h"

#include <array>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/write_file.h"
#include "kestrel/io/recording/euroc/euroc_layout.h"
#include "kestrel/io/recording/euroc/euroc_text.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr char kRoot[] = "mav0";

// The file's path in a recording and its first row.
RecordedFiles::File FileOf(EurocTable table) {
  const fs::path root = kRoot;
  switch (table) {
    case EurocTable::kImages:
      return {root / euroc::kImages, "#timestamp [ns],filename\n"};
    case EurocTable::kExposures:
      return {root / euroc::kExposures, "#timestamp [ns],exposure [s]\n"};
    case EurocTable::kDroppedImages:
      return {root / euroc::kDroppedImages, "#timestamp [ns],reason\n"};
    case EurocTable::kPoses:
      return {root / euroc::kPoses, EurocPoseColumns("WB") + "\n"};
    case EurocTable::kGimbal:
      return {root / euroc::kGimbal, EurocGimbalColumns() + "\n"};
    case EurocTable::kZoom:
      return {root / euroc::kZoom, EurocZoomColumns() + "\n"};
    case EurocTable::kTruePoses:
      return {root / euroc::kTruePoses, TrueStateHeader()};
    case EurocTable::kTruePatterns:
      return {root / euroc::kTruePatterns, LandingTruthHeader()};
    case EurocTable::kPackets:
      return {"mavlink.tlog", ""};
  }
  return {};
}

// The tables that further cameras have, too.
constexpr std::array kOfCameras = {EurocTable::kImages, EurocTable::kDroppedImages};

// A path of the first camera, for another one.
fs::path OfCamera(const fs::path& first, std::size_t camera) {
  return kRoot / fs::path(fmt::format("cam{}", camera)) / first.filename();
}

// The files of all tables, in their order, then those of further cameras; one without rows is never
// made.
std::vector<RecordedFiles::File> FilesIn(const fs::path& folder, std::size_t cameras) {
  std::vector<RecordedFiles::File> files;
  for (const EurocTable table : kEurocTables) {
    files.push_back(FileOf(table));
    files.back().path = folder / files.back().path;
  }
  for (std::size_t camera = 1; camera < cameras; ++camera) {
    for (const EurocTable table : kOfCameras) {
      files.push_back(FileOf(table));
      files.back().path = folder / OfCamera(files.back().path, camera);
    }
  }
  return files;
}

// Returns the folder with the folders of the tables in it.
fs::path WithFolders(const fs::path& folder, std::span<const EurocTable> tables,
                     std::size_t cameras) {
  std::error_code error;
  for (const EurocTable table : tables) {
    const bool is_images = table == EurocTable::kImages;
    const fs::path parent = PathOf(table).parent_path();
    if (!error)
      fs::create_directories(folder / (is_images ? kRoot / fs::path(euroc::kImageFolder) : parent),
                             error);
  }
  for (std::size_t camera = 1; camera < cameras && !error; ++camera) {
    fs::create_directories(folder / OfCamera(euroc::kImageFolder, camera), error);
  }
  if (!error) return folder;
  throw InputError(fmt::format("{}: cannot be written: {}", folder.string(), error.message()));
}

}  // namespace

fs::path RecordedImagePath(Time time, std::string_view extension, std::size_t camera) {
  return fs::path(kRoot) / fmt::format("cam{}/data/{}.{}", camera, ToNanoseconds(time), extension);
}

fs::path PathOf(EurocTable table) { return FileOf(table).path; }

EurocWriter::EurocWriter(const fs::path& folder, std::span<const EurocTable> tables,
                         std::size_t cameras)
    : folder_(WithFolders(folder, tables, cameras)), files_(folder_, FilesIn(folder_, cameras)) {}

EurocWriter::~EurocWriter() { Commit(); }

void EurocWriter::WriteCamera(const CameraCalibration& calibration, double rate_hz,
                              std::size_t camera) const {
  WriteFile(folder_ / OfCamera(euroc::kCamera, camera),
            EurocCalibrationText(calibration, rate_hz, SensorPlace::kFolder));
}

void EurocWriter::WritePoseSensor(double rate_hz) const {
  WriteFile(folder_ / kRoot / euroc::kPoseSensor, EurocPoseSensorText(rate_hz));
}

void EurocWriter::WriteGimbalSensor(const GimbalMount& gimbal, YawFrame yaw_frame,
                                    double rate_hz) const {
  WriteFile(folder_ / kRoot / euroc::kGimbalSensor,
            EurocGimbalSensorText(gimbal, yaw_frame, rate_hz));
}

void EurocWriter::WriteZoomSensor(const ZoomLens& zoom, double rate_hz) const {
  WriteFile(folder_ / kRoot / euroc::kZoomSensor, EurocZoomSensorText(zoom, rate_hz));
}

void EurocWriter::WriteImage(Time time, std::string_view extension, std::string_view bytes,
                             std::size_t camera) const {
  ReplaceFile(folder_ / RecordedImagePath(time, extension, camera), bytes);
}

void EurocWriter::ListImage(Time time, std::string_view extension, std::size_t camera) {
  Add(EurocTable::kImages, fmt::format("{0},{0}.{1}\n", ToNanoseconds(time), extension), camera);
}

void EurocWriter::AddExposure(Time from, double exposure_s) {
  Add(EurocTable::kExposures, fmt::format("{},{:.7f}\n", ToNanoseconds(from), exposure_s));
}

void EurocWriter::AddDroppedImage(Time time, std::string_view reason, std::size_t camera) {
  Add(EurocTable::kDroppedImages, fmt::format("{},{}\n", ToNanoseconds(time), reason), camera);
}

void EurocWriter::AddPose(const PoseSample& pose) {
  Add(EurocTable::kPoses, EurocPoseCells(pose.time, pose.world_from_body) + "\n");
}

void EurocWriter::AddGimbal(const GimbalSample& report) {
  Add(EurocTable::kGimbal, EurocGimbalCells(report) + "\n");
}

void EurocWriter::AddZoom(const ZoomSample& report) {
  Add(EurocTable::kZoom, EurocZoomCells(report) + "\n");
}

void EurocWriter::AddTruePose(const PoseSample& pose) {
  Add(EurocTable::kTruePoses, TrueStateRow(pose.time, pose.world_from_body,
                                           pose.motion.value_or(BodyMotion()).velocity_in_world));
}

void EurocWriter::AddTruePattern(const TruePattern& pattern) {
  Add(EurocTable::kTruePatterns, LandingTruthRow(pattern));
}

// A .tlog is a sequence of times (us of UTC, big endian) and packets.
void EurocWriter::AddPacket(std::int64_t utc_us, std::span<const std::uint8_t> bytes) {
  constexpr int kTimeBytes = 8;
  std::string row;
  for (int shift = 8 * (kTimeBytes - 1); shift >= 0; shift -= 8) {
    row += static_cast<char>(static_cast<std::uint64_t>(utc_us) >> shift);
  }
  row.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  Add(EurocTable::kPackets, row);
}

void EurocWriter::CommitOrThrow() {
  const std::string failure = Commit();
  if (!failure.empty()) throw InputError(failure);
}

void EurocWriter::CommitMany() {
  constexpr std::size_t kMany = std::size_t{32} << 10;
  if (files_.waiting_bytes() >= kMany) CommitOrThrow();
}

void EurocWriter::Add(EurocTable table, std::string_view rows, std::size_t camera) {
  if (camera == 0) return files_.Add(static_cast<std::size_t>(table), rows);
  const std::size_t of_camera = table == kOfCameras[0] ? 0 : 1;
  files_.Add(kEurocTables.size() + kOfCameras.size() * (camera - 1) + of_camera, rows);
}

}  // namespace kestrel

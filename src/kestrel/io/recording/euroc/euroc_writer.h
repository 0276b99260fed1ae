// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/core/poses/zoom_history.h"
#include "kestrel/io/recording/euroc/recorded_files.h"
#include "kestrel/io/recording/euroc/truth_rows.h"

namespace kestrel {

// Returns an image's path in a recording: "mav0/cam0/data/<ns>.<extension>"; 'camera': the number
// of the camera.
std::filesystem::path RecordedImagePath(Time time, std::string_view extension = "png",
                                        std::size_t camera = 0);

// Files of a recording that grow with it.
enum class EurocTable {
  kImages,
  kExposures,
  kDroppedImages,
  kPoses,
  kGimbal,
  kZoom,
  kTruePoses,
  kTruePatterns,
  kPackets
};

inline constexpr std::array kEurocTables{
    EurocTable::kImages,    EurocTable::kExposures,    EurocTable::kDroppedImages,
    EurocTable::kPoses,     EurocTable::kGimbal,       EurocTable::kZoom,
    EurocTable::kTruePoses, EurocTable::kTruePatterns, EurocTable::kPackets};

// Returns the table's path in a recording.
std::filesystem::path PathOf(EurocTable table);

// Writes the files of a recording in the EuRoC layout (docs/recording.md) into a folder. A program
// or a computer that ends at any time leaves a recording that can be opened: an image has its name
// when it is complete, and a row is in its table when all that it is about is on the disk.
//
// Rows wait in memory for Commit; no function but Commit waits for the disk. Every table may be
// given rows by one thread, while another one commits.
class EurocWriter {
 public:
  // Makes the folders of 'tables', the only ones that may be given rows, and those of the images of
  // further cameras: cam1, cam2 and so on. Throws InputError when 'folder' cannot be written.
  EurocWriter(const std::filesystem::path& folder, std::span<const EurocTable> tables,
              std::size_t cameras = 1);
  // Commits.
  ~EurocWriter();
  EurocWriter(const EurocWriter&) = delete;
  EurocWriter& operator=(const EurocWriter&) = delete;

  // Write the sensor.yaml of a camera, of the poses, of the gimbal and of the zoom. Throw
  // InputError when they cannot.
  void WriteCamera(const CameraCalibration& calibration, double rate_hz,
                   std::size_t camera = 0) const;
  void WritePoseSensor(double rate_hz) const;
  void WriteGimbalSensor(const GimbalMount& gimbal, YawFrame yaw_frame, double rate_hz) const;
  void WriteZoomSensor(const ZoomLens& zoom, double rate_hz) const;

  // Writes the file of an encoded image, which is not listed yet. Several threads may write
  // different images. Throws InputError when it cannot be written; then no part of it is there.
  void WriteImage(Time time, std::string_view extension, std::string_view bytes,
                  std::size_t camera = 0) const;
  // Lists an image that is written.
  void ListImage(Time time, std::string_view extension, std::size_t camera = 0);

  void AddExposure(Time from, double exposure_s);
  void AddDroppedImage(Time time, std::string_view reason, std::size_t camera = 0);
  void AddPose(const PoseSample& pose);
  void AddGimbal(const GimbalSample& report);
  void AddZoom(const ZoomSample& report);
  void AddTruePose(const PoseSample& pose);  // without motion: at rest
  void AddTruePattern(const TruePattern& pattern);
  void AddPacket(std::int64_t utc_us, std::span<const std::uint8_t> bytes);

  // Writes all rows and waits for the disk. Returns an empty text or why some rows could not be
  // written; these are tried again. One thread at a time.
  std::string Commit() { return files_.Commit(); }
  // The same for those who can wait; throw InputError when rows cannot be written. The second one
  // does nothing as long as few rows wait.
  void CommitOrThrow();
  void CommitMany();

 private:
  // 'camera' is not 0 for tables that further cameras have, too.
  void Add(EurocTable table, std::string_view rows, std::size_t camera = 0);

  std::filesystem::path folder_;
  RecordedFiles files_;
};

}  // namespace kestrel

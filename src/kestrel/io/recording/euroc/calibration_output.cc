// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/calibration_output.h"

#include <filesystem>
#include <iostream>

#include "kestrel/io/recording/euroc/euroc_text.h"
#include "kestrel/io/recording/output_folder.h"

namespace kestrel {

namespace {

OutputFolder FolderOf(const std::filesystem::path& file, bool force) {
  return OutputFolder(file.has_parent_path() ? file.parent_path() : ".", force);
}

}  // namespace

void RequireFreeForCalibration(const std::string& file, bool force) {
  const std::filesystem::path path(file);
  if (!file.empty()) FolderOf(path, force).NewFile(path.filename());
}

void WriteCalibration(const CameraCalibration& calibration, double rate_hz, const std::string& file,
                      bool force) {
  WriteCalibrationText(EurocCalibrationText(calibration, rate_hz), file, force);
}

void WriteCalibrationText(const std::string& text, const std::string& file, bool force) {
  if (file.empty()) {
    std::cout << text << std::flush;
    return;
  }
  const std::filesystem::path path(file);
  FolderOf(path, force).OpenText(path.filename()) << text;
}

}  // namespace kestrel

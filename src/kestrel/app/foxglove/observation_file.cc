// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/observation_file.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// Removes a file, but not a device.
void RemoveFile(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) std::filesystem::remove(path, ignored);
}

}  // namespace

ObservationFile::ObservationFile(const std::string& path, bool replace,
                                 const CameraIntrinsics& camera, TaskView view)
    : path_(path), file_(path, replace), writer_(&file_, camera, std::move(view)) {}

ObservationFile::~ObservationFile() {
  try {
    if (!file_.empty()) Close();
  } catch (const InputError&) {  // the file can be read all the same
  }
  if (file_.empty()) RemoveFile(path_);
}

void ObservationFile::Close() {
  if (std::exchange(is_closed_, true)) return;
  file_.Close();
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/recording_place.h"

#include <system_error>

#include "kestrel/core/base/error.h"

namespace kestrel {

namespace fs = std::filesystem;

void RequireFreeForRecording(const fs::path& output, bool replace) {
  if (!fs::exists(output)) return;
  if (!fs::is_directory(output)) {
    throw InputError(output.string() + ": is a file, not a folder");
  }
  if (fs::is_empty(output)) return;
  if (!fs::exists(output / "mav0" / "cam0")) {
    throw InputError(output.string() + ": is no recording, and not empty");
  }
  if (!replace) throw InputError(output.string() + ": exists already; --force replaces it");
}

fs::path PlaceOfRecording(const fs::path& output) {
  const fs::path path = fs::absolute(output).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

fs::path PartOfRecording(const fs::path& output) {
  return PlaceOfRecording(output).string() + ".part";
}

void PublishRecording(const fs::path& part, const fs::path& output) {
  std::error_code error;
  fs::remove_all(output, error);
  if (!error) fs::rename(part, output, error);
  if (error) throw InputError(output.string() + ": cannot be replaced: " + error.message());
}

}  // namespace kestrel

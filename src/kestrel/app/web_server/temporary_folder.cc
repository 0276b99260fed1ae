// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/temporary_folder.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "kestrel/core/base/error.h"

namespace kestrel {

namespace {

namespace fs = std::filesystem;

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  path_ = (fs::temp_directory_path(error) / "kestrel-XXXXXX").string();
  if (error || mkdtemp(path_.data()) == nullptr) {
    throw InputError(path_ + ": cannot be made, expected a folder for temporary files (TMPDIR)");
  }
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace kestrel

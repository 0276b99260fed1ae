// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/output_folder.h"

#include <utility>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be made: " + error.message());
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": is a file, not a folder");
}

fs::path KeptBelow(const fs::path& name) {
  fs::path kept;
  for (const fs::path& part : name.relative_path()) {
    if (part != ".." && part != ".") kept /= part;
  }
  return kept;
}

}  // namespace

OutputFolder::OutputFolder(fs::path folder, bool replace_files, std::string allowance)
    : folder_(std::move(folder)), replace_files_(replace_files), allowance_(std::move(allowance)) {
  MakeFolder(folder_);
}

fs::path OutputFolder::NewFile(const fs::path& name) const {
  fs::path path = folder_ / KeptBelow(name);
  MakeFolder(path.parent_path());
  if (!replace_files_ && fs::exists(path)) {
    throw InputError(path.string() + ": exists already; " + allowance_ + " replaces it");
  }
  return path;
}

std::ofstream OutputFolder::OpenText(const fs::path& name) const {
  const fs::path path = NewFile(name);
  std::ofstream file(path, std::ios::binary);
  if (!file) throw InputError(path.string() + ": cannot be written");
  return file;
}

void WriteAtOnce(const std::string& text, const char* name, std::ostream* file) {
  if (*file << text << std::flush) return;
  throw InputError(std::string(name) + ": cannot be written, is the disk full?");
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/bags/growing_file.h"

#include <filesystem>
#include <system_error>

#include "kestrel/base/error.h"

namespace kestrel {

void RequireNew(const std::string& path, bool replace) {
  std::error_code ignored;
  if (!replace && std::filesystem::exists(path, ignored)) {
    throw InputError(path + ": is there already; --force replaces it");
  }
}

GrowingFile::GrowingFile(const std::string& path, bool replace) : path_(path) {
  RequireNew(path, replace);
  file_.open(PartOf(path), std::ios::binary | std::ios::trunc);
  if (!file_) Fail();
}

GrowingFile::~GrowingFile() {
  if (is_finished_) return;
  file_.close();
  std::error_code ignored;
  std::filesystem::remove(PartOf(path_), ignored);
}

void GrowingFile::Fail() const { throw InputError(path_ + ": cannot be written"); }

void GrowingFile::Append(std::string_view bytes) {
  if (!file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) Fail();
  size_ += bytes.size();
}

void GrowingFile::Overwrite(std::uint64_t offset, std::string_view bytes) {
  file_.seekp(static_cast<std::streamoff>(offset));
  if (!file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) Fail();
  file_.seekp(0, std::ios::end);
}

void GrowingFile::Finish() {
  file_.close();
  if (!file_) Fail();
  std::error_code error;
  std::filesystem::rename(PartOf(path_), path_, error);
  if (error) Fail();
  is_finished_ = true;
}

}  // namespace kestrel

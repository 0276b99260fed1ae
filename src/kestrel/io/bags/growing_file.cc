// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/growing_file.h"

#include <filesystem>
#include <system_error>

#include "kestrel/core/base/error.h"

namespace kestrel {

void RequireNew(const std::string& path, bool replace) {
  std::error_code ignored;
  if (!replace && std::filesystem::exists(path, ignored)) {
    throw InputError(path + ": is there already; --force replaces it");
  }
}

GrowingFile::GrowingFile(const std::string& path, bool replace, UnfinishedName name)
    : path_(path), name_(name) {
  RequireNew(path, replace);
  file_.open(name == UnfinishedName::kPart ? PartOf(path) : path,
             std::ios::binary | std::ios::trunc);
  if (!file_) Fail();
}

GrowingFile::~GrowingFile() {
  if (is_finished_ || name_ == UnfinishedName::kOwn) return;
  file_.close();
  std::error_code ignored;
  std::filesystem::remove(PartOf(path_), ignored);
}

void GrowingFile::Fail() const { throw InputError(path_ + ": cannot be written"); }

void GrowingFile::Append(std::string_view bytes) {
  if (!file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) Fail();
  size_ += bytes.size();
}

void GrowingFile::Flush() {
  if (!file_.flush()) Fail();
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
  if (name_ == UnfinishedName::kPart) std::filesystem::rename(PartOf(path_), path_, error);
  if (error) Fail();
  is_finished_ = true;
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/recorded_files.h"

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// Appends the whole text, or nothing. Returns 0 or the system's error number.
int AppendWhole(int descriptor, std::int64_t size, std::string_view text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = pwrite(descriptor, text.data() + done, text.size() - done,
                                   size + static_cast<std::int64_t>(done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int error = written == 0 ? ENOSPC : errno;
      return ftruncate(descriptor, size) == 0 ? error : EIO;
    }
    done += static_cast<std::size_t>(written);
  }
  return 0;
}

}  // namespace

RecordedFiles::RecordedFiles(const std::filesystem::path& folder, std::vector<File> files)
    : folder_descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (folder_descriptor_ < 0) throw InputError(folder.string() + ": cannot be opened");
  for (File& file : files) files_.push_back({std::move(file), {}, {}});
}

RecordedFiles::~RecordedFiles() {
  for (const Growing& file : files_) {
    if (file.descriptor >= 0) close(file.descriptor);
  }
  close(folder_descriptor_);
}

void RecordedFiles::Add(std::size_t index, std::string_view rows) {
  constexpr std::size_t kMost = std::size_t{4} << 20;
  const std::lock_guard lock(mutex_);
  std::string& added = files_[index].added;
  if (added.size() + rows.size() <= kMost) added += rows;
}

std::size_t RecordedFiles::waiting_bytes() const {
  const std::lock_guard lock(mutex_);
  std::size_t bytes = 0;
  for (const Growing& file : files_) bytes += file.added.size();
  return bytes;
}

std::string RecordedFiles::Commit() {
  bool has_rows = false;
  {
    const std::lock_guard lock(mutex_);
    for (Growing& file : files_) {
      if (file.committed.empty()) std::swap(file.committed, file.added);
      has_rows = has_rows || !file.committed.empty();
    }
  }
  if (!has_rows) return "";
  syncfs(folder_descriptor_);
  std::string failure;
  for (Growing& file : files_) {
    if (file.committed.empty()) continue;
    const std::string error = Write(&file);
    if (failure.empty()) failure = error;
  }
  return failure;
}

std::string RecordedFiles::Write(Growing* file) {
  const std::string path = file->file.path.string();
  const int error = file->descriptor < 0 ? Begin(file) : Append(file->committed, file);
  if (error == 0) {
    file->committed.clear();
    return "";
  }
  return fmt::format("{}: cannot be written: {}", path, std::generic_category().message(error));
}

// Writes header and first rows under another name until they are on the disk: an empty file never
// exists.
int RecordedFiles::Begin(Growing* file) {
  constexpr int kMode = 0666;  // less the user's mask
  const std::string draft = file->file.path.string() + ".part";
  file->descriptor = open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode);
  if (file->descriptor < 0) return errno;
  int error = Append(file->file.header + file->committed, file);
  if (error == 0 && rename(draft.c_str(), file->file.path.c_str()) != 0) error = errno;
  if (error == 0) return 0;
  close(file->descriptor);
  unlink(draft.c_str());
  file->descriptor = -1;
  file->size = 0;
  return error;
}

int RecordedFiles::Append(const std::string& text, Growing* file) {
  const int error = AppendWhole(file->descriptor, file->size, text);
  if (error != 0) return error;
  if (fdatasync(file->descriptor) != 0) return errno;  // the next attempt overwrites it
  file->size += static_cast<std::int64_t>(text.size());
  return 0;
}

}  // namespace kestrel

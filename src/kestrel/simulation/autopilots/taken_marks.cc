// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/taken_marks.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

static_assert(std::atomic<bool>::is_always_lock_free && sizeof(std::atomic<bool>) == 1);

[[noreturn]] void ThrowUnusable(const std::string& file) {
  throw InputError(fmt::format("field.shared_file {}: {}", file, std::strerror(errno)));
}

// Memory of a file is zero where nothing was written.
int Open(const std::string& file, std::size_t bytes) {
  if (file.empty()) return -1;
  const int descriptor = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor < 0) ThrowUnusable(file);
  const auto size = static_cast<off_t>(bytes);
  struct stat found;
  const bool is_known = fstat(descriptor, &found) == 0;
  if (is_known && found.st_size != 0 && found.st_size != size) {
    close(descriptor);
    throw InputError(fmt::format(
        "field.shared_file {}: has {} bytes, expected a new file or one of this field, of {}", file,
        found.st_size, size));
  }
  if (is_known && ftruncate(descriptor, size) == 0) return descriptor;
  const int error = errno;
  close(descriptor);
  errno = error;
  ThrowUnusable(file);
}

}  // namespace

TakenMarks::TakenMarks(const std::string& file, std::size_t objects)
    : bytes_(std::max<std::size_t>(objects, 1)) {
  const int descriptor = Open(file, bytes_);
  const int flags = MAP_SHARED | (descriptor < 0 ? MAP_ANONYMOUS : 0);
  void* const memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, flags, descriptor, 0);
  if (descriptor >= 0) close(descriptor);
  if (memory == MAP_FAILED) ThrowUnusable(file);
  marks_ = static_cast<std::atomic<bool>*>(memory);
}

TakenMarks::~TakenMarks() { munmap(marks_, bytes_); }

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/folder_lock.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>

#include "kestrel/core/base/error.h"

namespace kestrel {

FolderLock::FolderLock(const std::string& folder)
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const int error = errno;
  if (descriptor_ >= 0) close(descriptor_);
  if (error == EWOULDBLOCK) throw InputError(folder + ": another program is writing into it");
  throw InputError(folder + ": cannot be locked: " + std::generic_category().message(error));
}

FolderLock::~FolderLock() { close(descriptor_); }

}  // namespace kestrel

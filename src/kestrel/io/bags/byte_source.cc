// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/byte_source.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// Smallest piece to read: the heads of records lie close together, and a call costs more than they.
constexpr std::uint64_t kReadAhead = 4096;
// Limit of the size of a message, a chunk or a summary.
constexpr std::uint64_t kMaxPiece = 1 << 30;

// Returns how many of 'size' bytes from 'offset' exist in a source of 'total' bytes.
std::uint64_t BytesThere(std::uint64_t offset, std::uint64_t size, std::uint64_t total) {
  return offset < total ? std::min(size, total - offset) : 0;
}

}  // namespace

std::string_view MemoryBytes::View(std::uint64_t offset, std::uint64_t size) {
  const std::uint64_t there = BytesThere(offset, size, bytes_.size());
  return there == 0 ? std::string_view() : bytes_.substr(offset, there);
}

FileBytes::FileBytes(const std::string& path)
    : path_(path), descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat status {};
  if (descriptor_ < 0 || fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    const std::string reason = descriptor_ < 0 ? std::strerror(errno) : "is no regular file";
    if (descriptor_ >= 0) close(descriptor_);
    throw InputError(path + ": cannot be read: " + reason);
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

FileBytes::~FileBytes() { close(descriptor_); }

std::string_view FileBytes::View(std::uint64_t offset, std::uint64_t size) {
  size = BytesThere(offset, size, size_);
  const bool is_buffered = offset >= buffer_offset_ && offset + size <= buffer_offset_ + buffered_;
  if (!is_buffered) Fill(offset, std::max(size, BytesThere(offset, kReadAhead, size_)));
  return {buffer_.get() + (offset - buffer_offset_), size};
}

void FileBytes::Fill(std::uint64_t offset, std::uint64_t size) {
  if (size > kMaxPiece) {
    throw InputError(fmt::format("{}: byte {}: a record claims {} bytes, expected at most {}",
                                 path_, offset, size, kMaxPiece));
  }
  if (size > capacity_) {
    capacity_ = size;
    buffer_ = std::make_unique_for_overwrite<char[]>(size);
  }
  buffer_offset_ = offset;
  buffered_ = 0;
  std::uint64_t filled = 0;
  while (filled < size) {
    const ssize_t count = pread(descriptor_, buffer_.get() + filled, size - filled,
                                static_cast<off_t>(offset + filled));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const std::string reason = count < 0 ? std::strerror(errno) : "it became shorter";
      throw InputError(path_ + ": cannot be read: " + reason);
    }
    filled += static_cast<std::uint64_t>(count);
  }
  buffered_ = size;
}

BytesPart::BytesPart(ByteSource* source, std::uint64_t offset, std::uint64_t size)
    : source_(source), offset_(offset), size_(BytesThere(offset, size, source->size())) {}

std::string_view BytesPart::View(std::uint64_t offset, std::uint64_t size) {
  const std::uint64_t there = BytesThere(offset, size, size_);
  return there == 0 ? std::string_view() : source_->View(offset_ + offset, there);
}

}  // namespace kestrel

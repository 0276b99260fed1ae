// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace kestrel {

// Random access to bytes that are not all in memory.
class ByteSource {
 public:
  virtual ~ByteSource() = default;

  virtual std::uint64_t size() const = 0;

  // Returns 'size' bytes from 'offset', fewer at the end of the source. Valid until the next call.
  virtual std::string_view View(std::uint64_t offset, std::uint64_t size) = 0;
};

// Bytes in memory, which must outlive this.
class MemoryBytes : public ByteSource {
 public:
  explicit MemoryBytes(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t size() const override { return bytes_.size(); }
  std::string_view View(std::uint64_t offset, std::uint64_t size) override;

 private:
  std::string_view bytes_;
};

// The bytes of a file, with its size at the time of opening.
class FileBytes : public ByteSource {
 public:
  // Throws InputError when the file cannot be opened.
  explicit FileBytes(const std::string& path);
  ~FileBytes() override;
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  std::uint64_t size() const override { return size_; }
  // Throws InputError when the disk fails, and for more than 1 GiB.
  std::string_view View(std::uint64_t offset, std::uint64_t size) override;

 private:
  void Fill(std::uint64_t offset, std::uint64_t size);

  std::string path_;
  int descriptor_;
  std::uint64_t size_ = 0;
  // A part of the file. It is not a string, which would be filled with zeros before it is read.
  std::unique_ptr<char[]> buffer_;
  std::uint64_t capacity_ = 0;
  std::uint64_t buffer_offset_ = 0;
  std::uint64_t buffered_ = 0;
};

// A part of another source, which must outlive this; it ends with the source at the latest.
class BytesPart : public ByteSource {
 public:
  BytesPart(ByteSource* source, std::uint64_t offset, std::uint64_t size);

  std::uint64_t size() const override { return size_; }
  std::string_view View(std::uint64_t offset, std::uint64_t size) override;

 private:
  ByteSource* source_;
  std::uint64_t offset_;
  std::uint64_t size_;
};

}  // namespace kestrel

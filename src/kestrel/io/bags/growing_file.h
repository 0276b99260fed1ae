// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace kestrel {

// Name of a file that is not complete yet.
enum class UnfinishedName {
  kPart,  // "<path>.part", removed without Finish
  kOwn,   // its final name: it can be read, and stays without Finish
};

// A file that is written from beginning to end. All functions throw InputError with the path when
// they fail.
class GrowingFile {
 public:
  // The file must not exist unless 'replace' is set.
  GrowingFile(const std::string& path, bool replace, UnfinishedName name = UnfinishedName::kPart);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  void Append(std::string_view bytes);
  std::uint64_t size() const { return size_; }
  // Passes all appended bytes to the system, so that the end of this program does not lose them.
  void Flush();

  // Replaces bytes that have been written.
  void Overwrite(std::uint64_t offset, std::string_view bytes);

  void Finish();

  // Returns the name of an unfinished file with UnfinishedName::kPart.
  static std::string PartOf(const std::string& path) { return path + ".part"; }

 private:
  [[noreturn]] void Fail() const;

  std::string path_;
  UnfinishedName name_;
  std::ofstream file_;
  std::uint64_t size_ = 0;
  bool is_finished_ = false;
};

// Throws InputError when the file exists and 'replace' is false.
void RequireNew(const std::string& path, bool replace);

}  // namespace kestrel

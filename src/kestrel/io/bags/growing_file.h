// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace kestrel {

// The name of a file that is not whole yet.
enum class UnfinishedName {
  kPart,  // "<path>.part"; without Finish it is removed
  kOwn,   // its own: what is there can be read, and stays without Finish
};

// A file that is written from its begin to its end. All calls throw InputError, with the path, when
// they cannot do what they are to.
class GrowingFile {
 public:
  // The file must not be there unless 'replace' is set.
  GrowingFile(const std::string& path, bool replace, UnfinishedName name = UnfinishedName::kPart);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  void Append(std::string_view bytes);
  std::uint64_t size() const { return size_; }
  // Gives the system all that was appended: the end of this program does not lose it.
  void Flush();

  // Writes over bytes that are there.
  void Overwrite(std::uint64_t offset, std::string_view bytes);

  void Finish();

  // The name until then, of UnfinishedName::kPart.
  static std::string PartOf(const std::string& path) { return path + ".part"; }

 private:
  [[noreturn]] void Fail() const;

  std::string path_;
  UnfinishedName name_;
  std::ofstream file_;
  std::uint64_t size_ = 0;
  bool is_finished_ = false;
};

// Throws InputError when there is such a file and 'replace' is not set.
void RequireNew(const std::string& path, bool replace);

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <string>

namespace kestrel {

// Marks of objects that were taken, in memory that several programs may share. Thread-safe.
class TakenMarks {
 public:
  // 'file': by which programs share the marks; none is set in a new one. Empty: for this program
  // alone. Throws InputError when the file cannot be used.
  TakenMarks(const std::string& file, std::size_t objects);
  ~TakenMarks();
  TakenMarks(const TakenMarks&) = delete;
  TakenMarks& operator=(const TakenMarks&) = delete;

  // Stays where it is.
  const std::atomic<bool>& operator[](std::size_t object) const { return marks_[object]; }
  // False when it was taken before.
  bool Take(std::size_t object) { return !marks_[object].exchange(true); }

 private:
  std::size_t bytes_;
  std::atomic<bool>* marks_;
};

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kestrel {

// Writes numbers as bytes: integers seven bits at a time, the lowest first; other numbers as IEEE
// 754, little endian.
class ByteWriter {
 public:
  void Byte(std::uint8_t value) { bytes_.push_back(value); }
  void Whole(std::uint64_t value) {
    for (; value >= kMore; value >>= kBits) Byte(static_cast<std::uint8_t>(value | kMore));
    Byte(static_cast<std::uint8_t>(value));
  }
  void Single(double value) { Fixed(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }
  void Double(double value) { Fixed(std::bit_cast<std::uint64_t>(value)); }
  template <class T>
  void Fixed(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) Byte(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  void Text(const std::string& text) {
    Whole(text.size());
    bytes_.insert(bytes_.end(), text.begin(), text.end());
  }

  static constexpr int kBits = 7;
  static constexpr std::uint64_t kMore = 1U << kBits;

  std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

// Reads the numbers again. After the first invalid one nothing is read any more: all numbers are 0,
// and has_failed() is true.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint8_t Byte() { return Fixed<std::uint8_t>(); }
  // Fails for a number above 'max'.
  std::uint64_t Whole(std::uint64_t max) {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += ByteWriter::kBits) {
      const std::uint64_t byte = Byte();
      value |= (byte & (ByteWriter::kMore - 1)) << shift;
      if (byte < ByteWriter::kMore) return Require(value <= max) ? value : 0;
    }
    Require(false);
    return 0;
  }
  double Single() { return std::bit_cast<float>(Fixed<std::uint32_t>()); }
  double Double() { return std::bit_cast<double>(Fixed<std::uint64_t>()); }
  template <class T>
  T Fixed() {
    if (!Require(bytes_.size() >= sizeof(T))) return 0;
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      value = static_cast<T>(value | static_cast<T>(bytes_[i]) << (8 * i));
    }
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }
  std::string Text(std::size_t max) {
    const std::size_t size = Whole(max);
    if (!Require(size <= bytes_.size())) return "";
    std::string text(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size));
    bytes_ = bytes_.subspan(size);
    return text;
  }

  // Fails unless 'holds'.
  bool Require(bool holds) {
    if (!holds) has_failed_ = true;
    if (has_failed_) bytes_ = {};
    return !has_failed_;
  }
  bool has_failed() const { return has_failed_; }
  bool is_at_end() const { return bytes_.empty(); }

 private:
  std::span<const std::uint8_t> bytes_;
  bool has_failed_ = false;
};

}  // namespace kestrel

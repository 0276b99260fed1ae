// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "kestrel/core/base/error.h"

namespace kestrel {

// Numbers and texts as bytes of files and messages: fixed numbers are little-endian, as Kestrel's
// computers are; a varint is a whole number with seven bits per byte, the lowest first, and the
// eighth bit set in all bytes but the last.

static_assert(std::endian::native == std::endian::little, "Kestrel is little-endian");

inline constexpr int kVarintBits = 7;
inline constexpr std::uint64_t kMoreOfVarint = 1U << kVarintBits;

// Reads numbers and texts off the front of some bytes. After the first that is not there or not
// valid nothing is read any more: all numbers are 0, and has_failed() is true.
class ByteReader {
 public:
  // 'bytes' must outlive what is read.
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  explicit ByteReader(std::span<const std::uint8_t> bytes)
      : bytes_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

  template <class Number>
  requires std::is_arithmetic_v<Number> Number Fixed() {
    Number number{};
    const std::string_view taken = Bytes(sizeof(Number));
    if (!has_failed_) std::memcpy(&number, taken.data(), sizeof(Number));
    return number;
  }
  // Fails for a number above 'max'.
  std::uint64_t Varint(std::uint64_t max = std::numeric_limits<std::uint64_t>::max()) {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += kVarintBits) {
      const auto byte = std::uint64_t{Fixed<std::uint8_t>()};
      value |= (byte & (kMoreOfVarint - 1)) << shift;
      if (byte < kMoreOfVarint) return Require(value <= max) ? value : 0;
    }
    Require(false);
    return 0;
  }
  std::string_view Bytes(std::uint64_t count) {
    if (!Require(count <= bytes_.size())) return {};
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  // Fails unless 'holds'.
  bool Require(bool holds) {
    if (!holds) has_failed_ = true;
    if (has_failed_) bytes_ = {};
    return !has_failed_;
  }
  bool has_failed() const { return has_failed_; }
  std::size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
  bool has_failed_ = false;
};

// The same, but throws InputError, "<name>: ends too early", when there are not enough bytes.
class ByteCursor {
 public:
  // 'name' describes the bytes in the error message; it must outlive this.
  ByteCursor(std::string_view bytes, const std::string& name) : reader_(bytes), name_(&name) {}

  std::size_t left() const { return reader_.left(); }

  template <class Number>
  Number Take() {
    return Checked(reader_.Fixed<Number>());
  }
  std::string_view Bytes(std::uint64_t count) { return Checked(reader_.Bytes(count)); }
  // Takes a text that follows its length in 32 bits.
  std::string_view Text() { return Bytes(Take<std::uint32_t>()); }
  std::uint64_t Varint() { return Checked(reader_.Varint()); }

 private:
  template <class Value>
  Value Checked(Value value) const {
    if (reader_.has_failed()) throw InputError(*name_ + ": ends too early");
    return value;
  }

  ByteReader reader_;
  const std::string* name_;
};

// Append to 'bytes', a std::string or a vector of bytes.
template <class Number, class Bytes>
requires std::is_arithmetic_v<Number>
void Put(Number number, Bytes* bytes) {
  bytes->resize(bytes->size() + sizeof(number));
  std::memcpy(bytes->data() + bytes->size() - sizeof(number), &number, sizeof(number));
}
template <class Bytes>
void PutVarint(std::uint64_t value, Bytes* bytes) {
  for (; value >= kMoreOfVarint; value >>= kVarintBits) {
    Put(static_cast<std::uint8_t>(value | kMoreOfVarint), bytes);
  }
  Put(static_cast<std::uint8_t>(value), bytes);
}
// The text follows its length in 32 bits.
inline void PutText(std::string_view text, std::string* bytes) {
  Put(static_cast<std::uint32_t>(text.size()), bytes);
  bytes->append(text);
}

}  // namespace kestrel

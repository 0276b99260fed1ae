// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "kestrel/core/base/error.h"

namespace kestrel {

static_assert(std::endian::native == std::endian::little, "bags are little-endian, as Kestrel is");

// Takes little-endian numbers and texts off the front of some bytes. All functions throw
// InputError, "<name>: ends too early", when there are not enough bytes.
class ByteCursor {
 public:
  // 'name' says what the bytes are, for the message; it must outlive this.
  ByteCursor(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(&name) {}

  std::size_t left() const { return bytes_.size(); }

  template <std::integral Number>
  Number Take() {
    Number number;
    std::memcpy(&number, Bytes(sizeof(Number)).data(), sizeof(Number));
    return number;
  }

  std::string_view Bytes(std::uint64_t count) {
    if (count > bytes_.size()) throw InputError(*name_ + ": ends too early");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  // Takes a text that follows its length in 32 bits.
  std::string_view Text() { return Bytes(Take<std::uint32_t>()); }

 private:
  std::string_view bytes_;
  const std::string* name_;
};

// Appends little-endian numbers and texts to 'bytes'.
template <std::integral Number>
void Put(Number number, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&number), sizeof(number));
}
inline void PutText(std::string_view text, std::string* bytes) {
  Put(static_cast<std::uint32_t>(text.size()), bytes);
  bytes->append(text);
}

}  // namespace kestrel

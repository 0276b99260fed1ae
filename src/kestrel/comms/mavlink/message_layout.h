// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

#include "kestrel/comms/mavlink/crc.h"

// Layout of a message of messages.h in its payload, and its CRC_EXTRA, by the rules of
// mavlink.io/en/guide/serialization, computed at compile time.
namespace kestrel::mavlink {

static_assert(std::endian::native == std::endian::little, "the wire is little-endian");

inline constexpr std::size_t kMaxPayload = 255;

struct FieldLayout {
  std::string_view name;
  std::string_view type;  // type name of an element in the XML
  std::string_view unit;  // empty: none, or an enum
  std::size_t element_size = 0;
  std::size_t count = 0;  // number of elements of an array; 0: not an array
  bool is_extension = false;
  std::size_t offset = 0;  // in the payload

  constexpr std::size_t size() const { return element_size * (count == 0 ? 1 : count); }
};

template <class Type>
struct ElementOf {
  using type = Type;
  static constexpr std::size_t kCount = 0;
};
template <class Element, std::size_t count>
struct ElementOf<std::array<Element, count>> {
  using type = Element;
  static constexpr std::size_t kCount = count;
};

template <class Type>
constexpr std::string_view TypeName() {
  if constexpr (std::same_as<Type, char>) return "char";
  if constexpr (std::same_as<Type, std::uint8_t>) return "uint8_t";
  if constexpr (std::same_as<Type, std::int8_t>) return "int8_t";
  if constexpr (std::same_as<Type, std::uint16_t>) return "uint16_t";
  if constexpr (std::same_as<Type, std::int16_t>) return "int16_t";
  if constexpr (std::same_as<Type, std::uint32_t>) return "uint32_t";
  if constexpr (std::same_as<Type, std::int32_t>) return "int32_t";
  if constexpr (std::same_as<Type, std::uint64_t>) return "uint64_t";
  if constexpr (std::same_as<Type, std::int64_t>) return "int64_t";
  if constexpr (std::same_as<Type, float>) return "float";
}

struct MessageLayout {
  static constexpr std::size_t kMaxFields = 24;

  std::array<FieldLayout, kMaxFields> fields{};  // in the order of Visit
  std::size_t field_count = 0;
  std::size_t base_length = 0;  // without extensions: the part that MAVLink 1 has
  std::size_t full_length = 0;
  std::uint8_t crc_extra = 0;
};

// Visitor that lists the fields of a message.
class FieldCollector {
 public:
  constexpr explicit FieldCollector(MessageLayout* layout) : layout_(layout) {}

  template <class Value>
  constexpr void operator()(std::string_view name, const Value& /*value*/, std::string_view unit) {
    using Element = ElementOf<Value>;
    layout_->fields[layout_->field_count++] = {name,
                                               TypeName<typename Element::type>(),
                                               unit,
                                               sizeof(typename Element::type),
                                               Element::kCount,
                                               in_extensions_};
  }
  constexpr void Extensions() { in_extensions_ = true; }

 private:
  MessageLayout* layout_;
  bool in_extensions_ = false;
};

// On the wire the fields are sorted by the size of their elements, the largest first; extensions
// follow in their order. CRC_EXTRA covers the message's name and all fields before the extensions.
template <class Message>
constexpr MessageLayout MakeLayout() {
  MessageLayout layout;
  const Message message;
  Message::Visit(message, FieldCollector(&layout));
  const std::span<FieldLayout> fields(layout.fields.data(), layout.field_count);
  Crc crc;
  crc.Add(Message::kName);
  crc.Add(std::string_view(" "));
  for (std::size_t size = sizeof(std::uint64_t); size > 0; size /= 2) {
    for (FieldLayout& field : fields) {
      if (field.is_extension || field.element_size != size) continue;
      field.offset = layout.base_length;
      layout.base_length += field.size();
      crc.Add(field.type);
      crc.Add(std::string_view(" "));
      crc.Add(field.name);
      crc.Add(std::string_view(" "));
      if (field.count > 0) crc.Add(static_cast<std::uint8_t>(field.count));
    }
  }
  layout.full_length = layout.base_length;
  for (FieldLayout& field : fields) {
    if (!field.is_extension) continue;
    field.offset = layout.full_length;
    layout.full_length += field.size();
  }
  layout.crc_extra = static_cast<std::uint8_t>((crc.value() & 0xff) ^ (crc.value() >> 8));
  return layout;
}

template <class Message>
inline constexpr MessageLayout kLayout = MakeLayout<Message>();

// Visitor that copies the fields of a message into a payload.
class PayloadWriter {
 public:
  PayloadWriter(const MessageLayout& layout, std::uint8_t* payload)
      : field_(layout.fields.data()), payload_(payload) {}

  template <class Value>
  void operator()(std::string_view /*name*/, const Value& value, std::string_view /*unit*/) {
    std::memcpy(payload_ + (field_++)->offset, &value, sizeof(Value));
  }
  void Extensions() {}

 private:
  const FieldLayout* field_;
  std::uint8_t* payload_;
};

// Visitor that copies the fields of a message out of a payload.
class PayloadReader {
 public:
  PayloadReader(const MessageLayout& layout, const std::uint8_t* payload)
      : field_(layout.fields.data()), payload_(payload) {}

  template <class Value>
  void operator()(std::string_view /*name*/, Value& value, std::string_view /*unit*/) {
    std::memcpy(&value, payload_ + (field_++)->offset, sizeof(Value));
  }
  void Extensions() {}

 private:
  const FieldLayout* field_;
  const std::uint8_t* payload_;
};

// Writes the payload and returns its length: without trailing zeros, but at least one byte.
template <class Message>
std::size_t WritePayload(const Message& message, std::span<std::uint8_t, kMaxPayload> payload) {
  Message::Visit(message, PayloadWriter(kLayout<Message>, payload.data()));
  std::size_t length = kLayout<Message>.full_length;
  while (length > 1 && payload[length - 1] == 0) --length;
  return length;
}

// Reads a message from a payload: a missing end is zero, and bytes beyond the description are
// ignored.
template <class Message>
Message ReadPayload(std::span<const std::uint8_t> payload) {
  constexpr std::size_t kLength = kLayout<Message>.full_length;
  std::array<std::uint8_t, kLength> padded{};
  std::memcpy(padded.data(), payload.data(), std::min(kLength, payload.size()));
  Message message;
  Message::Visit(message, PayloadReader(kLayout<Message>, padded.data()));
  return message;
}

}  // namespace kestrel::mavlink

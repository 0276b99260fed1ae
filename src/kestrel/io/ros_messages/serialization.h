// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "kestrel/core/base/bytes.h"
#include "kestrel/core/base/time.h"
#include "kestrel/io/ros_messages/foxglove_message.h"
#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/topic.h"

namespace kestrel {

// The rules of both formats. ROS 1: little-endian, no alignment, texts after their length. ROS 2
// (XCDR1): four bytes that name the byte order, then numbers aligned to their size from there on,
// and texts that end with a zero, which is part of their length. In both, lists follow their length
// in 32 bits.

// Reads the fields of a message from its bytes. All functions throw InputError with 'name' when
// there are not enough bytes.
class WireReader {
 public:
  // 'bytes' must outlive the message, as lists of bytes point into them. 'name' outlives this.
  // Throws InputError for bytes of ROS 2 in another representation than plain CDR.
  WireReader(std::string_view bytes, WireFormat format, const std::string& name);

  template <class Field>
  void operator()(FieldName, Field& field) {
    Read(field);
  }
  // Reads a field that the type has in ROS 1 only.
  template <class Field>
  void OfRos1(FieldName, Field& field) {
    if (format_ == WireFormat::kRos1) Read(field);
  }

 private:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void Read(Number& number) {
    Align(sizeof(Number));
    std::array<char, sizeof(Number)> bytes;
    std::copy_n(Take(sizeof(Number)).begin(), sizeof(Number), bytes.begin());
    if (is_big_endian_) std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&number, bytes.data(), sizeof(Number));
  }
  void Read(bool& value);
  template <class Enum>
  requires std::is_enum_v<Enum>
  void Read(Enum& value) {
    std::underlying_type_t<Enum> number{};
    Read(number);
    value = static_cast<Enum>(number);
  }
  void Read(Time& time);
  void Read(std::string& text);
  void Read(std::string_view& bytes) { bytes = Take(Count()); }
  template <RosMessage Message>
  void Read(Message& message) {
    Message::Fields(message, *this);
  }
  template <class Element, std::size_t kSize>
  void Read(std::array<Element, kSize>& array) {
    for (Element& element : array) Read(element);
  }
  // The list grows with the bytes that exist, whatever length they claim.
  template <class Element>
  void Read(std::vector<Element>& list) {
    list.clear();
    for (std::uint32_t left = Count(); left > 0; --left) Read(list.emplace_back());
  }

  std::uint32_t Count();
  void Align(std::size_t size);
  std::string_view Take(std::size_t count);

  ByteReader reader_;
  std::size_t size_;
  WireFormat format_;
  const std::string* name_;
  bool is_big_endian_ = false;
};

// Writes the fields of a message as bytes.
class WireWriter {
 public:
  // 'format': kRos1 or kCdr (little-endian).
  explicit WireWriter(WireFormat format);

  template <class Field>
  void operator()(FieldName, const Field& field) {
    Write(field);
  }
  template <class Field>
  void OfRos1(FieldName, const Field& field) {
    if (format_ == WireFormat::kRos1) Write(field);
  }

  std::string Take() { return std::move(bytes_); }

 private:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void Write(const Number& number) {
    Align(sizeof(Number));
    Put(number, &bytes_);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void Write(const Enum& value) { Write(static_cast<std::underlying_type_t<Enum>>(value)); }
  void Write(const Time& time);
  void Write(const std::string& text);
  void Write(const std::string_view& bytes);
  template <RosMessage Message>
  void Write(const Message& message) {
    Message::Fields(message, *this);
  }
  template <class Element, std::size_t kSize>
  void Write(const std::array<Element, kSize>& array) {
    for (const Element& element : array) Write(element);
  }
  template <class Element>
  void Write(const std::vector<Element>& list) {
    Write(static_cast<std::uint32_t>(list.size()));
    for (const Element& element : list) Write(element);
  }

  void Align(std::size_t size);

  WireFormat format_;
  std::string bytes_;
};

// Returns the message in 'bytes'; its lists of bytes point into them. Throws InputError with 'name'
// when they are not such a message.
template <RosMessage Message>
Message ParseMessage(std::string_view bytes, WireFormat format, const std::string& name) {
  Message message;
  if constexpr (HasFoxgloveForm<Message>) {
    if (format == WireFormat::kProtobuf) {
      ParseFoxglove(bytes, name, &message);
      return message;
    }
  }
  WireReader reader(bytes, format, name);
  Message::Fields(message, reader);
  return message;
}

// Returns the bytes of a message.
template <RosMessage Message>
std::string SerializeMessage(const Message& message, WireFormat format) {
  WireWriter writer(format);
  Message::Fields(message, writer);
  return writer.Take();
}

}  // namespace kestrel

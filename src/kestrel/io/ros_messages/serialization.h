// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

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

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(Number& number) {
    Align(sizeof(Number));
    char bytes[sizeof(Number)];
    std::memcpy(bytes, Take(sizeof(Number)).data(), sizeof(Number));
    if (is_big_endian_) std::reverse(bytes, bytes + sizeof(Number));
    std::memcpy(&number, bytes, sizeof(Number));
  }
  void operator()(Time& time);
  void operator()(std::string& text);
  template <class Message>
  requires std::is_class_v<Message>
  void operator()(Message& message) { Message::Fields(message, *this); }

  // Reads a field that the type has in ROS 1 only.
  template <class Field>
  void OfRos1(Field& field) {
    if (format_ == WireFormat::kRos1) (*this)(field);
  }
  void ByteList(std::string_view& bytes) { bytes = Take(Count()); }
  // The list grows with the bytes that exist, whatever length they claim.
  template <class Element>
  void List(std::vector<Element>& list) {
    list.clear();
    for (std::uint32_t left = Count(); left > 0; --left) (*this)(list.emplace_back());
  }

 private:
  std::uint32_t Count();
  void Align(std::size_t size);
  std::string_view Take(std::size_t count);

  std::string_view bytes_;
  WireFormat format_;
  const std::string* name_;
  std::size_t offset_ = 0;
  bool is_big_endian_ = false;
};

// Writes the fields of a message as bytes.
class WireWriter {
 public:
  // 'format': kRos1 or kCdr (little-endian).
  explicit WireWriter(WireFormat format);

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(const Number& number) {
    Align(sizeof(Number));
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof(Number));
  }
  void operator()(const Time& time);
  void operator()(const std::string& text);
  template <class Message>
  requires std::is_class_v<Message>
  void operator()(const Message& message) { Message::Fields(message, *this); }

  template <class Field>
  void OfRos1(const Field& field) {
    if (format_ == WireFormat::kRos1) (*this)(field);
  }
  void ByteList(const std::string_view& bytes) {
    (*this)(static_cast<std::uint32_t>(bytes.size()));
    bytes_.append(bytes);
  }
  template <class Element>
  void List(const std::vector<Element>& list) {
    (*this)(static_cast<std::uint32_t>(list.size()));
    for (const Element& element : list) (*this)(element);
  }

  std::string Take() { return std::move(bytes_); }

 private:
  void Align(std::size_t size);

  WireFormat format_;
  std::string bytes_;
};

// Returns the message in 'bytes'; its lists of bytes point into them. Throws InputError with 'name'
// when they are not such a message.
template <class Message>
Message ParseMessage(std::string_view bytes, WireFormat format, const std::string& name) {
  Message message;
  if constexpr (HasFoxgloveForm<Message>) {
    if (format == WireFormat::kProtobuf) {
      ParseFoxglove(bytes, name, &message);
      return message;
    }
  }
  WireReader reader(bytes, format, name);
  reader(message);
  return message;
}

// Returns the bytes of a message.
template <class Message>
std::string SerializeMessage(const Message& message, WireFormat format) {
  WireWriter writer(format);
  writer(message);
  return writer.Take();
}

}  // namespace kestrel

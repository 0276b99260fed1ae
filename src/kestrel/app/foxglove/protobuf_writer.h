// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "kestrel/core/base/bytes.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Writes messages in protobuf's wire format (protobuf.dev/programming-guides/encoding). A message
// lists its fields once, with their numbers, by
//
//   static constexpr std::string_view kType = "package.Name";
//   static void Fields(auto& self, auto& visit) {
//     visit(1, "x", self.x);
//   }
//
// This gives the bytes here and the schema in protobuf_schema.h. A field is a double, bool, int
// (int32), std::int64_t, std::uint32_t (fixed32), text, ProtobufBytes, Time or Duration (those of
// google.protobuf), an enumeration, a message (which may be optional), or a list of these.

struct ProtobufBytes {
  std::string bytes;
};

// google.protobuf.Timestamp and Duration. In a negative duration both parts are negative.
struct TimestampMessage {
  static constexpr std::string_view kType = "google.protobuf.Timestamp";
  std::int64_t seconds = 0;
  int nanos = 0;  // 0 to 999,999,999

  static void Fields(auto& self, auto& visit) {
    visit(1, "seconds", self.seconds);
    visit(2, "nanos", self.nanos);
  }
};
struct DurationMessage {
  static constexpr std::string_view kType = "google.protobuf.Duration";
  std::int64_t seconds = 0;
  int nanos = 0;

  static void Fields(auto& self, auto& visit) {
    visit(1, "seconds", self.seconds);
    visit(2, "nanos", self.nanos);
  }
};
TimestampMessage TimestampOf(Time time);
DurationMessage DurationOf(Duration duration);

template <class Type>
concept ProtobufMessage = requires {
  Type::kType;
};

// Appends the fields of a message to 'bytes'. Numbers are written even when they are 0; empty texts
// and lists are not.
class ProtobufWriter {
 public:
  explicit ProtobufWriter(std::string* bytes) : bytes_(bytes) {}

  void operator()(int number, const char*, double value) {
    PutTag(number, kFixed64);
    Put(value, bytes_);
  }
  void operator()(int number, const char*, std::uint32_t value) {
    PutTag(number, kFixed32);
    Put(value, bytes_);
  }
  void operator()(int number, const char*, std::int64_t value) {
    PutTag(number, kVarint);
    PutVarint(static_cast<std::uint64_t>(value), bytes_);
  }
  void operator()(int number, const char* name, int value) {
    (*this)(number, name, static_cast<std::int64_t>(value));
  }
  void operator()(int number, const char* name, bool value) {
    (*this)(number, name, static_cast<std::int64_t>(value));
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(int number, const char* name, Enum value) {
    (*this)(number, name, static_cast<std::int64_t>(value));
  }
  void operator()(int number, const char*, const std::string& text) {
    if (!text.empty()) PutBlock(number, text);
  }
  void operator()(int number, const char*, const ProtobufBytes& data) {
    PutBlock(number, data.bytes);
  }
  void operator()(int number, const char* name, Time time) {
    (*this)(number, name, TimestampOf(time));
  }
  void operator()(int number, const char* name, Duration duration) {
    (*this)(number, name, DurationOf(duration));
  }
  template <ProtobufMessage Message>
  void operator()(int number, const char*, const Message& message) {
    std::string content;
    ProtobufWriter writer(&content);
    Message::Fields(message, writer);
    PutBlock(number, content);
  }
  template <class Value>
  void operator()(int number, const char* name, const std::optional<Value>& value) {
    if (value) (*this)(number, name, *value);
  }
  template <class Value>
  void operator()(int number, const char* name, const std::vector<Value>& list) {
    for (const Value& value : list) (*this)(number, name, value);
  }
  // Packed numbers, as is the rule in proto3.
  void operator()(int number, const char*, const std::vector<double>& list) {
    PutDoubles(number, list.data(), list.size());
  }
  template <std::size_t kSize>
  void operator()(int number, const char*, const std::array<double, kSize>& list) {
    PutDoubles(number, list.data(), kSize);
  }

 private:
  enum WireType : std::uint32_t { kVarint = 0, kFixed64 = 1, kBlock = 2, kFixed32 = 5 };

  void PutTag(int number, WireType type) {
    PutVarint((static_cast<std::uint32_t>(number) << 3) | type, bytes_);
  }
  void PutBlock(int number, std::string_view content);
  void PutDoubles(int number, const double* values, std::size_t count);

  std::string* bytes_;
};

template <ProtobufMessage Message>
std::string ProtobufBytesOf(const Message& message) {
  std::string bytes;
  ProtobufWriter writer(&bytes);
  Message::Fields(message, writer);
  return bytes;
}

}  // namespace kestrel

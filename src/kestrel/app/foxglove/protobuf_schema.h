// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "kestrel/app/foxglove/protobuf_writer.h"

namespace kestrel {

// Names of an enumeration in the schema, within the message that has a field of this type:
//
//   template <> struct ProtobufEnum<Level> {
//     static constexpr const char* kName = "Level";
//     static constexpr std::array kValues{"UNKNOWN", "DEBUG"};  // 0, 1, ...
//   };
template <class Enum>
struct ProtobufEnum;

// The schema of messages, in protobuf's own messages (google/protobuf/descriptor.proto), for
// readers that do not know the messages. It has one file per message, after the files of the
// messages that it uses.
class ProtobufSchema {
 public:
  // Adds the message and all messages in its fields, unless they are in the schema.
  template <ProtobufMessage Message>
  void Add() {
    if (IsKnown(Message::kType)) return;
    Description description(this, Message::kType);
    Message message;
    Message::Fields(message, description);
    AddFile(description);
  }

  // Returns a serialized FileDescriptorSet.
  std::string Bytes() const;

 private:
  // Types of google.protobuf.FieldDescriptorProto.
  enum class FieldType {
    kDouble = 1,
    kInt64 = 3,
    kInt32 = 5,
    kFixed32 = 7,
    kBool = 8,
    kText = 9,
    kMessage = 11,
    kBytes = 12,
    kEnum = 14
  };
  enum class Label { kOptional = 1, kRepeated = 3 };
  struct Field {
    std::string name;
    int number = 0;
    Label label = Label::kOptional;
    FieldType type = FieldType::kDouble;
    std::string type_name;  // ".package.Name", for messages and enumerations

    static void Fields(auto& self, auto& visit);
    static constexpr std::string_view kType = "google.protobuf.FieldDescriptorProto";
  };
  struct EnumValue;
  struct EnumDescription;
  struct MessageDescription;
  struct FileDescription;
  struct FileSet;

  struct Enumeration {
    std::string name;
    std::vector<std::string> values;
  };

  // Records the fields of a message.
  class Description {
   public:
    Description(ProtobufSchema* schema, std::string_view type) : schema_(schema), type_(type) {}

    void operator()(int number, const char* name, double) {
      Take(number, name, FieldType::kDouble);
    }
    void operator()(int number, const char* name, std::uint32_t) {
      Take(number, name, FieldType::kFixed32);
    }
    void operator()(int number, const char* name, std::int64_t) {
      Take(number, name, FieldType::kInt64);
    }
    void operator()(int number, const char* name, int) { Take(number, name, FieldType::kInt32); }
    void operator()(int number, const char* name, bool) { Take(number, name, FieldType::kBool); }
    void operator()(int number, const char* name, const std::string&) {
      Take(number, name, FieldType::kText);
    }
    void operator()(int number, const char* name, const ProtobufBytes&) {
      Take(number, name, FieldType::kBytes);
    }
    void operator()(int number, const char* name, Time) {
      (*this)(number, name, TimestampMessage());
    }
    void operator()(int number, const char* name, Duration) {
      (*this)(number, name, DurationMessage());
    }
    template <class Enum>
    requires std::is_enum_v<Enum>
    void operator()(int number, const char* name, Enum) {
      using Names = ProtobufEnum<Enum>;
      TakeEnum(number, name, Names::kName, Names::kValues);
    }
    template <ProtobufMessage Message>
    void operator()(int number, const char* name, const Message&) {
      schema_->Add<Message>();
      TakeMessage(number, name, Message::kType);
    }
    template <class Value>
    void operator()(int number, const char* name, const std::optional<Value>&) {
      (*this)(number, name, Value());
    }
    template <class Value>
    void operator()(int number, const char* name, const std::vector<Value>&) {
      (*this)(number, name, Value());
      fields_.back().label = Label::kRepeated;
    }
    template <std::size_t kSize>
    void operator()(int number, const char* name, const std::array<double, kSize>&) {
      (*this)(number, name, std::vector<double>());
    }

   private:
    friend class ProtobufSchema;
    void Take(int number, const char* name, FieldType type);
    void TakeMessage(int number, const char* name, std::string_view type);
    void TakeEnum(int number, const char* name, const char* enum_name,
                  std::span<const char* const> values);

    ProtobufSchema* schema_;
    std::string_view type_;
    std::vector<Field> fields_;
    std::vector<Enumeration> enums_;
    std::vector<std::string> needed_files_;
  };

  bool IsKnown(std::string_view type) const;
  void AddFile(const Description& description);

  std::vector<std::string> types_;
  std::vector<ProtobufBytes> files_;  // FileDescriptorProto
};

template <ProtobufMessage Message>
std::string ProtobufSchemaOf() {
  ProtobufSchema schema;
  schema.Add<Message>();
  return schema.Bytes();
}

}  // namespace kestrel

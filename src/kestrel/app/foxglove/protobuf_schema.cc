// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/protobuf_schema.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr std::string_view kGoogle = "google.protobuf";

std::string PackageOf(std::string_view type) {
  return std::string(type.substr(0, type.rfind('.')));
}

std::string NameOf(std::string_view type) { return std::string(type.substr(type.rfind('.') + 1)); }

// Returns for example "foxglove/Color.proto"; protobuf's own files have names in lower case.
std::string FileOf(std::string_view type) {
  std::string name = NameOf(type);
  if (PackageOf(type) == kGoogle) {
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char letter) { return std::tolower(letter); });
  }
  std::string folder = PackageOf(type);
  std::replace(folder.begin(), folder.end(), '.', '/');
  return fmt::format("{}/{}.proto", folder, name);
}

}  // namespace

void ProtobufSchema::Field::Fields(auto& self, auto& visit) {
  visit(1, "name", self.name);
  visit(3, "number", self.number);
  visit(4, "label", self.label);
  visit(5, "type", self.type);
  visit(6, "type_name", self.type_name);
}

struct ProtobufSchema::EnumValue {
  static constexpr std::string_view kType = "google.protobuf.EnumValueDescriptorProto";
  std::string name;
  int number = 0;

  static void Fields(auto& self, auto& visit) {
    visit(1, "name", self.name);
    visit(2, "number", self.number);
  }
};

struct ProtobufSchema::EnumDescription {
  static constexpr std::string_view kType = "google.protobuf.EnumDescriptorProto";
  std::string name;
  std::vector<EnumValue> values;

  static void Fields(auto& self, auto& visit) {
    visit(1, "name", self.name);
    visit(2, "value", self.values);
  }
};

struct ProtobufSchema::MessageDescription {
  static constexpr std::string_view kType = "google.protobuf.DescriptorProto";
  std::string name;
  std::vector<Field> fields;
  std::vector<EnumDescription> enums;

  static void Fields(auto& self, auto& visit) {
    visit(1, "name", self.name);
    visit(2, "field", self.fields);
    visit(4, "enum_type", self.enums);
  }
};

struct ProtobufSchema::FileDescription {
  static constexpr std::string_view kType = "google.protobuf.FileDescriptorProto";
  std::string name;
  std::string package;
  std::vector<std::string> needed_files;
  MessageDescription message;
  std::string syntax;

  static void Fields(auto& self, auto& visit) {
    visit(1, "name", self.name);
    visit(2, "package", self.package);
    visit(3, "dependency", self.needed_files);
    visit(4, "message_type", self.message);
    visit(12, "syntax", self.syntax);
  }
};

struct ProtobufSchema::FileSet {
  static constexpr std::string_view kType = "google.protobuf.FileDescriptorSet";
  std::vector<ProtobufBytes> files;

  static void Fields(auto& self, auto& visit) { visit(1, "file", self.files); }
};

void ProtobufSchema::Description::Take(int number, const char* name, FieldType type) {
  fields_.push_back(
      {.name = name, .number = number, .label = Label::kOptional, .type = type, .type_name = {}});
}

void ProtobufSchema::Description::TakeMessage(int number, const char* name, std::string_view type) {
  Take(number, name, FieldType::kMessage);
  fields_.back().type_name = fmt::format(".{}", type);
  const std::string file = FileOf(type);
  const bool is_new =
      std::find(needed_files_.begin(), needed_files_.end(), file) == needed_files_.end();
  if (is_new) needed_files_.push_back(file);
}

void ProtobufSchema::Description::TakeEnum(int number, const char* name, const char* enum_name,
                                           std::span<const char* const> values) {
  Take(number, name, FieldType::kEnum);
  fields_.back().type_name = fmt::format(".{}.{}", type_, enum_name);
  enums_.push_back({enum_name, {values.begin(), values.end()}});
}

bool ProtobufSchema::IsKnown(std::string_view type) const {
  return std::find(types_.begin(), types_.end(), type) != types_.end();
}

void ProtobufSchema::AddFile(const Description& description) {
  MessageDescription message{NameOf(description.type_), description.fields_, {}};
  for (const Enumeration& enumeration : description.enums_) {
    EnumDescription& described = message.enums.emplace_back();
    described.name = enumeration.name;
    for (const std::string& value : enumeration.values) {
      described.values.push_back({value, static_cast<int>(described.values.size())});
    }
  }
  const FileDescription file{.name = FileOf(description.type_),
                             .package = PackageOf(description.type_),
                             .needed_files = description.needed_files_,
                             .message = std::move(message),
                             .syntax = "proto3"};
  files_.push_back({ProtobufBytesOf(file)});
  types_.emplace_back(description.type_);
}

std::string ProtobufSchema::Bytes() const { return ProtobufBytesOf(FileSet{files_}); }

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
// Writes the types of ROS 2 (Humble to Kilted) that Kestrel uses as IDL, by their names on DDS.
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/io/ros_messages/type_description.h"

namespace kestrel {
namespace {

// A char of ROS is a byte here, as there.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kPrimitives{
    {{"uint8", "octet"},
     {"char", "octet"},
     {"byte", "octet"},
     {"bool", "boolean"},
     {"int32", "long"},
     {"uint32", "unsigned long"},
     {"float32", "float"},
     {"float64", "double"}}};

// Returns "sensor_msgs::msg::dds_::Image_" for "sensor_msgs/Image", and "string<256>" for
// "string<=256".
std::string IdlTypeOf(std::string_view type) {
  for (const auto& [ros, idl] : kPrimitives) {
    if (ros == type) return std::string(idl);
  }
  if (const std::size_t slash = type.find('/'); slash != std::string_view::npos) {
    return fmt::format("{}::msg::dds_::{}_", type.substr(0, slash), type.substr(slash + 1));
  }
  const std::size_t bound = type.find("<=");
  if (bound == std::string_view::npos) return std::string(type);
  return fmt::format("{}<{}>", type.substr(0, bound), type.substr(bound + 2));
}

std::string MemberOf(const FieldDescription& field) {
  const std::string_view type = field.type;
  const std::size_t bracket = type.find('[');
  const std::string element = IdlTypeOf(type.substr(0, bracket));
  if (bracket == std::string_view::npos) return fmt::format("{} {}", element, field.name);
  const std::string_view size = type.substr(bracket);
  if (size == "[]") return fmt::format("sequence<{}> {}", element, field.name);
  return fmt::format("{} {}{}", element, field.name, size);
}

void WriteStruct(const TypeDescription& description) {
  const std::size_t slash = description.type.find('/');
  fmt::print("module {} {{ module msg {{ module dds_ {{\n  @final struct {}_ {{\n",
             description.type.substr(0, slash), description.type.substr(slash + 1));
  for (const FieldDescription& field : description.fields) {
    fmt::print("    {};\n", MemberOf(field));
  }
  fmt::print("  }};\n}}; }}; }};\n");
}

// Writes a type of 'types' after the types in it, unless it is among the written ones.
void WriteType(std::string_view name, const std::vector<TypeDescription>& types,
               std::vector<std::string_view>* written) {
  if (std::find(written->begin(), written->end(), name) != written->end()) return;
  const auto type = std::find_if(types.begin(), types.end(),
                                 [&](const TypeDescription& each) { return each.type == name; });
  if (type == types.end()) return;  // a primitive
  for (const FieldDescription& field : type->fields) {
    WriteType(std::string_view(field.type).substr(0, field.type.find('[')), types, written);
  }
  WriteStruct(*type);
  written->push_back(type->type);
}

}  // namespace
}  // namespace kestrel

int main() {
  std::vector<std::string_view> written;
  for (const std::string_view type : kestrel::Ros2Types()) {
    kestrel::WriteType(type, kestrel::DescribeType(type, kestrel::WireFormat::kCdr), &written);
  }
}

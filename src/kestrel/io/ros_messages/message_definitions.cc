// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/message_definitions.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <nettle/nettle-meta.h>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/io/ros_messages/type_description.h"

namespace kestrel {
namespace {

// Codes of type_description_interfaces/FieldType: kind of a field, and offsets for arrays of it.
constexpr int kNested = 1;
constexpr int kString = 17;
constexpr int kBoundedString = 21;
constexpr int kArray = 48;
constexpr int kUnboundedSequence = 144;

constexpr std::array<std::pair<std::string_view, int>, 9> kPrimitives{{{"uint8", 3},
                                                                       {"int32", 6},
                                                                       {"uint32", 7},
                                                                       {"float32", 10},
                                                                       {"float64", 11},
                                                                       {"char", 3},  // as in ROS 2
                                                                       {"bool", 15},
                                                                       {"byte", 16},
                                                                       {"string", kString}}};

int PrimitiveOf(std::string_view type) {
  const auto* const known = std::find_if(kPrimitives.begin(), kPrimitives.end(),
                                         [&](const auto& each) { return each.first == type; });
  return known->second;
}

bool IsNested(std::string_view type) { return type.find('/') != std::string_view::npos; }

std::string LinesOf(const TypeDescription& description) {
  std::string lines(description.constants);
  for (const auto& [type, name] : description.fields) lines += fmt::format("{} {}\n", type, name);
  return lines;
}

std::string HashInHex(const nettle_hash& hash, const std::string& text) {
  std::vector<std::max_align_t> context(hash.context_size / sizeof(std::max_align_t) + 1);
  hash.init(context.data());
  hash.update(context.data(), text.size(), reinterpret_cast<const std::uint8_t*>(text.data()));
  std::vector<std::uint8_t> digest(hash.digest_size);
  hash.digest(context.data(), digest.size(), digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

// The checksum of ROS 1 is that of the lines, in which the checksums of types stand for the types.
std::string ChecksumOf(const std::vector<TypeDescription>& types, std::string_view type) {
  const auto description =
      std::find_if(types.begin(), types.end(), [&](const auto& each) { return each.type == type; });
  std::string lines(description->constants);
  for (const FieldDescription& field : description->fields) {
    const std::string_view element = std::string_view(field.type).substr(0, field.type.find('['));
    lines += fmt::format("{} {}\n", IsNested(element) ? ChecksumOf(types, element) : field.type,
                         field.name);
  }
  if (!lines.empty()) lines.pop_back();
  return HashInHex(nettle_md5, lines);
}

// Returns the JSON of a field's type.
std::string TypeInJson(std::string_view type) {
  constexpr std::string_view kBound = "<=";
  int id = 0;
  std::string_view capacity = "0";
  std::string_view string_capacity = "0";
  std::string nested;
  if (type.ends_with(']')) {
    const std::size_t bracket = type.find('[');
    const std::string_view size = type.substr(bracket + 1, type.size() - bracket - 2);
    id += size.empty() ? kUnboundedSequence : kArray;
    if (!size.empty()) capacity = size;
    type = type.substr(0, bracket);
  }
  if (const std::size_t bound = type.find(kBound); bound != std::string_view::npos) {
    id += kBoundedString;
    string_capacity = type.substr(bound + kBound.size());
  } else if (IsNested(type)) {
    id += kNested;
    nested = Ros2TypeName(type);
  } else {
    id += PrimitiveOf(type);
  }
  return fmt::format(
      R"({{"type_id": {}, "capacity": {}, "string_capacity": {}, "nested_type_name": "{}"}})", id,
      capacity, string_capacity, nested);
}

std::string DescriptionInJson(const TypeDescription& description) {
  std::vector<std::string> fields;
  for (const auto& [type, name] : description.fields) {
    fields.push_back(fmt::format(R"({{"name": "{}", "type": {}}})", name, TypeInJson(type)));
  }
  return fmt::format(R"({{"type_name": "{}", "fields": [{}]}})", Ros2TypeName(description.type),
                     fmt::join(fields, ", "));
}

}  // namespace

std::string MessageDefinition(std::string_view type, WireFormat format) {
  const std::vector<TypeDescription> types = DescribeType(type, format);
  std::string text = LinesOf(types.front());
  for (auto part = types.begin() + 1; part != types.end(); ++part) {
    text += fmt::format("{:=<80}\nMSG: {}\n{}", "", part->type, LinesOf(*part));
  }
  return text;
}

std::string MessageChecksum(std::string_view type) {
  return ChecksumOf(DescribeType(type, WireFormat::kRos1), type);
}

std::string TypeHash(std::string_view type) {
  std::vector<TypeDescription> types = DescribeType(type, WireFormat::kCdr);
  const std::string own = DescriptionInJson(types.front());
  std::sort(types.begin() + 1, types.end(), [](const auto& a, const auto& b) {
    return Ros2TypeName(a.type) < Ros2TypeName(b.type);
  });
  std::vector<std::string> others;
  for (auto part = types.begin() + 1; part != types.end(); ++part) {
    others.push_back(DescriptionInJson(*part));
  }
  return "RIHS01_" +
         HashInHex(
             nettle_sha256,
             fmt::format(R"({{"type_description": {}, "referenced_type_descriptions": [{}]}})", own,
                         fmt::join(others, ", ")));
}

}  // namespace kestrel

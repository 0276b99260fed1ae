// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/type_hash.h"

#include <array>
#include <cstdint>
#include <map>
#include <nettle/sha2.h>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/io/ros_messages/message_definitions.h"

namespace kestrel {
namespace {

// Codes of type_description_interfaces/FieldType: kind of a field, and offsets for arrays of it.
constexpr int kNested = 1;
constexpr int kString = 17;
constexpr int kBoundedString = 21;
constexpr int kArray = 48;
constexpr int kUnboundedSequence = 144;

constexpr std::array<std::pair<std::string_view, int>, 14> kPrimitives{{{"int8", 2},
                                                                        {"uint8", 3},
                                                                        {"int16", 4},
                                                                        {"uint16", 5},
                                                                        {"int32", 6},
                                                                        {"uint32", 7},
                                                                        {"int64", 8},
                                                                        {"uint64", 9},
                                                                        {"float32", 10},
                                                                        {"float64", 11},
                                                                        {"char", 3},  // as in ROS 2
                                                                        {"bool", 15},
                                                                        {"byte", 16},
                                                                        {"string", kString}}};

std::optional<int> PrimitiveOf(std::string_view type) {
  for (const auto& [name, id] : kPrimitives) {
    if (name == type) return id;
  }
  return std::nullopt;
}

unsigned SizeIn(std::string_view digits) {
  const auto size = ParseNumber<unsigned>(std::string(digits));
  if (!size) throw InputError(fmt::format("the size {} of a field is no number", digits));
  return *size;
}

// Returns the JSON of a field's type, as "uint8[]", "float64[9]", "string<=256", "std_msgs/Header".
std::string TypeInJson(std::string_view type) {
  constexpr std::string_view kBound = "<=";
  int id = 0;
  unsigned capacity = 0;
  unsigned string_capacity = 0;
  std::string nested;
  if (type.ends_with(']')) {
    const std::size_t bracket = type.find('[');
    const std::string_view digits = type.substr(bracket + 1, type.size() - bracket - 2);
    id += digits.empty() ? kUnboundedSequence : kArray;
    if (!digits.empty()) capacity = SizeIn(digits);
    type = type.substr(0, bracket);
  }
  if (const std::size_t bound = type.find(kBound); bound != std::string_view::npos) {
    id += kBoundedString;
    string_capacity = SizeIn(type.substr(bound + kBound.size()));
  } else if (const auto primitive = PrimitiveOf(type)) {
    id += *primitive;
  } else {
    id += kNested;
    nested = Ros2TypeName(type);
  }
  return fmt::format(
      R"({{"type_id": {}, "capacity": {}, "string_capacity": {}, "nested_type_name": "{}"}})", id,
      capacity, string_capacity, nested);
}

// The lines of a definition are "type name"; constants ("uint8 ADD=0") are not fields.
std::string DescriptionInJson(std::string_view type, std::string_view lines) {
  std::vector<std::string> fields;
  while (!lines.empty()) {
    const std::string_view line = lines.substr(0, lines.find('\n'));
    lines.remove_prefix(line.size() + 1);
    const std::size_t blank = line.find(' ');
    const std::string_view name = line.substr(blank + 1);
    if (name.find('=') != std::string_view::npos) continue;
    fields.push_back(
        fmt::format(R"({{"name": "{}", "type": {}}})", name, TypeInJson(line.substr(0, blank))));
  }
  return fmt::format(R"({{"type_name": "{}", "fields": [{}]}})", Ros2TypeName(type),
                     fmt::join(fields, ", "));
}

std::string Sha256InHex(const std::string& text) {
  sha256_ctx context;
  sha256_init(&context);
  sha256_update(&context, text.size(), reinterpret_cast<const std::uint8_t*>(text.data()));
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
  sha256_digest(&context, digest.size(), digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace

std::string TypeHash(std::string_view type) {
  constexpr std::string_view kPart = "\nMSG: ";
  const std::string definition = MessageDefinition(type, WireFormat::kCdr);
  // Each part begins with a line of equals signs and "MSG: type".
  std::string_view rest = definition;
  std::string own;
  std::map<std::string, std::string> referenced;  // by name
  for (std::string_view name = type;;) {
    const std::size_t part = rest.find(kPart);
    std::string_view lines = rest.substr(0, part);
    if (part != std::string_view::npos) lines = lines.substr(0, lines.find("==="));
    std::string description = DescriptionInJson(name, lines);
    (name == type ? own : referenced[Ros2TypeName(name)]) = std::move(description);
    if (part == std::string_view::npos) break;
    rest.remove_prefix(part + kPart.size());
    name = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(name.size() + 1);
  }
  std::vector<std::string> others;
  others.reserve(referenced.size());
  for (auto& [name, description] : referenced) others.push_back(std::move(description));
  return "RIHS01_" + Sha256InHex(fmt::format(
                         R"({{"type_description": {}, "referenced_type_descriptions": [{}]}})", own,
                         fmt::join(others, ", ")));
}

}  // namespace kestrel

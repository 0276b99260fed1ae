// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/time.h"
#include "kestrel/io/bags/mcap_reader.h"

namespace kestrel {

// The fields of a serialized message. For each field number it has, in order, the bytes of the
// blocks or numbers; a varint has 64 bits.
class ProtobufFields {
 public:
  explicit ProtobufFields(std::string_view bytes) {
    while (!bytes.empty()) {
      const std::uint64_t tag = TakeVarint(&bytes);
      fields_[static_cast<int>(tag >> 3)].push_back(TakeValue(tag & 7, &bytes));
    }
  }

  std::size_t count(int number) const {
    const auto found = fields_.find(number);
    return found == fields_.end() ? 0 : found->second.size();
  }
  std::string bytes(int number, std::size_t index = 0) const {
    return fields_.at(number).at(index);
  }
  ProtobufFields message(int number, std::size_t index = 0) const {
    return ProtobufFields(bytes(number, index));
  }
  template <class Number>
  Number number(int number_of_field) const {
    Number value;
    std::memcpy(&value, bytes(number_of_field).data(), sizeof(value));
    return value;
  }
  std::vector<double> doubles(int number) const {
    const std::string block = bytes(number);
    std::vector<double> values(block.size() / sizeof(double));
    std::memcpy(values.data(), block.data(), block.size());
    return values;
  }
  Time time(int number_of_field) const {
    const ProtobufFields parts = message(number_of_field);
    return TimeFromNanoseconds(parts.number<std::int64_t>(1) * 1'000'000'000 +
                               parts.number<std::int64_t>(2));
  }

 private:
  static std::uint64_t TakeVarint(std::string_view* bytes) {
    std::uint64_t value = 0;
    for (int shift = 0; !bytes->empty(); shift += 7) {
      const auto byte = static_cast<std::uint8_t>(bytes->front());
      bytes->remove_prefix(1);
      value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) break;
    }
    return value;
  }
  static std::string TakeValue(std::uint64_t wire_type, std::string_view* bytes) {
    if (wire_type == 0) {
      const std::uint64_t value = TakeVarint(bytes);
      return {reinterpret_cast<const char*>(&value), sizeof(value)};
    }
    std::size_t size = wire_type == 1 ? 8 : 4;
    if (wire_type == 2) size = TakeVarint(bytes);
    EXPECT_LE(size, bytes->size());
    const std::string value(bytes->substr(0, size));
    bytes->remove_prefix(std::min(size, bytes->size()));
    return value;
  }

  std::map<int, std::vector<std::string>> fields_;
};

// The messages of an MCAP file by topic, each with its time in the file.
struct StoredMessage {
  Time time;
  ProtobufFields fields;
};
inline std::map<std::string, std::vector<StoredMessage>> ReadMessages(const std::string& path) {
  McapReader reader(path);
  EXPECT_EQ(reader.remark(), "");
  std::vector<std::size_t> topics(reader.topics().size());
  for (std::size_t i = 0; i < topics.size(); ++i) topics[i] = i;
  reader.Select(topics);
  std::map<std::string, std::vector<StoredMessage>> messages;
  for (BagMessage message; reader.Next(&message);) {
    messages[reader.topics()[message.topic].name].push_back(
        {message.arrival, ProtobufFields(message.data)});
  }
  return messages;
}

}  // namespace kestrel

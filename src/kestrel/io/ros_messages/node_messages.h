// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "kestrel/io/ros_messages/messages.h"

namespace kestrel {

// The messages by which nodes of ROS 2 list each other, by the same rules as in messages.h. Gids
// have 16 bytes since Iron, and had 24 bytes up to Humble, under the same name.

inline constexpr std::size_t kGidSize = 16;
inline constexpr std::size_t kHumbleGidSize = 24;

template <std::size_t kSize>
struct GidMessage {
  static constexpr std::string_view kType =
      kSize == kGidSize ? "rmw_dds_common/Gid" : "rmw_dds_common_humble/Gid";
  std::array<char, kSize> data{};

  static void Fields(auto& self, auto& wire) { wire("data", self.data); }
};

template <std::size_t kSize>
struct NodeEntitiesMessage {
  static constexpr std::string_view kType = kSize == kGidSize
                                                ? "rmw_dds_common/NodeEntitiesInfo"
                                                : "rmw_dds_common_humble/NodeEntitiesInfo";
  BoundedText<256> name_space;
  BoundedText<256> name;
  std::vector<GidMessage<kSize>> readers;
  std::vector<GidMessage<kSize>> writers;

  static void Fields(auto& self, auto& wire) {
    wire("node_namespace", self.name_space);
    wire("node_name", self.name);
    wire("reader_gid_seq", self.readers);
    wire("writer_gid_seq", self.writers);
  }
};

template <std::size_t kSize>
struct ParticipantEntitiesMessage {
  static constexpr std::string_view kType = kSize == kGidSize
                                                ? "rmw_dds_common/ParticipantEntitiesInfo"
                                                : "rmw_dds_common_humble/ParticipantEntitiesInfo";
  GidMessage<kSize> participant;
  std::vector<NodeEntitiesMessage<kSize>> nodes;

  static void Fields(auto& self, auto& wire) {
    wire("gid", self.participant);
    wire("node_entities_info_seq", self.nodes);
  }
};

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// A UAV from its start to its end. One that starts again, and another one of the same name, has
// another 'boot' and a map of its own.
struct UavKey {
  std::string name;        // see IsUavName
  std::uint32_t boot = 0;  // random

  // NOLINTNEXTLINE(modernize-use-nullptr): it takes the generated comparison with 0 for one
  friend auto operator<=>(const UavKey&, const UavKey&) = default;
};

// 1 to 32 letters, digits, '_', '-' and '.'.
bool IsUavName(const std::string& name);

// An object of a UAV's map.
struct ObjectRef {
  UavKey uav;
  std::int64_t id = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr)
  friend auto operator<=>(const ObjectRef&, const ObjectRef&) = default;
};

// A UAV goes for an object; of two that do, the one with the higher bid.
struct Claim {
  ObjectRef object;
  double bid = 0;  // finite; rounded to a float on its way

  bool operator==(const Claim&) const = default;
};

// What a UAV's map consists of: an object that is not listed is not in it any more.
struct Contents {
  std::uint64_t version = 0;  // grows with every change; 0: nothing was told yet
  Time now;                   // of the map, on the UAV's clock; no object is later
  std::map<std::int64_t, std::uint64_t> objects;  // id, and the version that changed it last
};

// Of the map of 'uav', which need not be the sender: its contents, and some of its objects in the
// state that the contents list.
struct PartMessage {
  UavKey uav;
  Duration age{};  // since the contents were told first, as far as the sender knows
  Contents contents;
  std::vector<MappedObject> objects;
};

// What the sender has heard of a UAV; one of the lines is its own.
struct DigestLine {
  UavKey uav;
  std::uint32_t beat = 0;     // digests that the UAV had sent, modulo 2^32: who lives counts on
  std::uint64_t version = 0;  // of its contents
  bool is_done = false;       // the UAV's map is its last: it has seen all that it will see
  std::optional<Claim> claim;
  std::vector<std::int64_t> missing;  // objects that the contents list and the sender lacks
  int tries = 0;                      // digests since the sender knows that it lacks something
};
using Digest = std::vector<DigestLine>;

struct TeamMessage {
  UavKey sender;
  std::variant<Digest, PartMessage> body;
};

// Bounds of what is told and taken.
inline constexpr std::size_t kMaxTeamMessage = 16384;  // bytes
inline constexpr std::size_t kMaxUavs = 128;
inline constexpr std::size_t kMaxToldObjects = 512;  // of one UAV
inline constexpr std::size_t kMaxMissing = 1024;     // in one digest
inline constexpr std::uint64_t kMaxVersion = std::uint64_t{1} << 48;
inline constexpr int kMaxTries = 255;

std::vector<std::uint8_t> EncodeMessage(const TeamMessage& message);

// Nothing for bytes that no EncodeMessage makes: of another format, cut off, too many, with numbers
// that are not finite or have no meaning, with objects seen later than the map's own time.
std::optional<TeamMessage> ParseMessage(std::span<const std::uint8_t> bytes);

// Bytes that the object takes in a message whose contents are of 'now'; two are the same when these
// are.
std::vector<std::uint8_t> EncodeObject(const MappedObject& object, Time now);

// The object as others will hear it: rounded. Nothing when it cannot be told.
std::optional<MappedObject> AsTold(const MappedObject& object, Time now);

}  // namespace kestrel

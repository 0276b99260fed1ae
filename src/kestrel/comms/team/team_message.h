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

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// Identifies a UAV from its start to its end. After a restart it has another 'boot' and a map of
// its own, and so has another UAV of the same name.
struct UavKey {
  std::string name;        // see IsUavName
  std::uint32_t boot = 0;  // random

  // NOLINTNEXTLINE(modernize-use-nullptr): it takes the generated comparison with 0 for one
  friend auto operator<=>(const UavKey&, const UavKey&) = default;
};

// True for 1 to 32 letters, digits, '_', '-' and '.'.
bool IsUavName(const std::string& name);

// An object of a UAV's map.
struct ObjectRef {
  UavKey uav;
  std::int64_t id = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr)
  friend auto operator<=>(const ObjectRef&, const ObjectRef&) = default;
};

// A UAV claims an object; of two claims, the one with the higher bid counts.
struct Claim {
  ObjectRef object;
  double bid = 0;  // finite; sent as a float

  bool operator==(const Claim&) const = default;
};

// Place and velocity of a UAV in flight, in its own world (m, m/s).
struct UavFlight {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  bool is_at_work = false;  // near an object or the box: the others keep away

  bool operator==(const UavFlight&) const = default;
};

// Contents of a UAV's map: an object that is not listed is not in it any more.
struct Contents {
  std::uint64_t version = 0;  // grows with every change; 0: nothing was sent yet
  Time now;                   // time of the map, on the UAV's clock; no object is later
  std::map<std::int64_t, std::uint64_t> objects;  // id, and the version in which it last changed
};

// A part of the map of 'uav', which need not be the sender: its contents, and some of its objects
// in the state that the contents list.
struct PartMessage {
  UavKey uav;
  Duration age{};  // time since the contents were first sent, as far as the sender knows
  Contents contents;
  std::vector<MappedObject> objects;
};

// The sender's knowledge of a UAV; one of the lines is about itself.
struct DigestLine {
  UavKey uav;
  std::uint32_t beat = 0;     // number of digests that the UAV had sent, modulo 2^32: it grows
                              // while the UAV lives
  std::uint64_t version = 0;  // version of the UAV's contents
  bool is_done = false;       // the UAV's map is its last one
  std::optional<Claim> claim;
  std::vector<std::int64_t> missing;  // objects that the contents list and the sender lacks
  int tries = 0;                      // number of digests since the sender knows that it lacks
                                      // something
  std::optional<UavFlight> flight = {};
  std::vector<std::int64_t> gone = {};  // objects that the contents list and somebody has taken
};
using Digest = std::vector<DigestLine>;

struct TeamMessage {
  UavKey sender;
  std::variant<Digest, PartMessage> body;
};

// Limits of what is sent and accepted.
inline constexpr std::size_t kMaxTeamMessage = 16384;  // bytes
inline constexpr std::size_t kMaxUavs = 128;
inline constexpr std::size_t kMaxSentObjects = 512;  // per UAV
inline constexpr std::size_t kMaxMissing = 1024;     // in one digest
inline constexpr std::size_t kMaxGone = 512;         // the same
inline constexpr double kMaxSpeed_mps = 50;          // on each axis
inline constexpr std::uint64_t kMaxVersion = std::uint64_t{1} << 48;
inline constexpr int kMaxTries = 255;

std::vector<std::uint8_t> EncodeMessage(const TeamMessage& message);

// Returns nothing for bytes that EncodeMessage never makes: another format, truncated, too many,
// numbers that are not finite or have no meaning, objects seen later than the map's own time.
std::optional<TeamMessage> ParseMessage(std::span<const std::uint8_t> bytes);

// Returns the object's bytes in a message whose contents have the time 'now'. Two objects are sent
// as the same when their bytes are.
std::vector<std::uint8_t> EncodeObject(const MappedObject& object, Time now);

// Returns the object as others will hear it: rounded. Nothing when it cannot be sent.
std::optional<MappedObject> AsReported(const MappedObject& object, Time now);

}  // namespace kestrel

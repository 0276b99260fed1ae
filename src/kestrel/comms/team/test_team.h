// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/team/team_member.h"
#include "kestrel/core/base/random.h"

namespace kestrel {

// A standing disc of one of five colours, seen at 'time'.
inline MappedObject TestDisc(std::int64_t id, const Eigen::Vector3d& position, Time time,
                             double sigma_m = 0.05) {
  MappedObject object;
  object.id = id;
  object.first_seen = object.last_seen = object.time = time;
  object.state.head<3>() = position;
  object.covariance.topLeftCorner<3, 3>() = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
  object.detections = 10;
  object.log_odds = 3;
  object.color_log_likelihoods[static_cast<std::size_t>(id) % 5] = 5;
  return object;
}

// 'count' discs over 100 m, no two within 3 m; the same field for the same seed.
inline std::vector<MappedObject> TestField(int count, Random* random, Time time = Time()) {
  std::vector<MappedObject> objects;
  while (static_cast<int>(objects.size()) < count) {
    // Braces: every compiler draws in this order.
    const Eigen::Vector3d position{random->Uniform(0, 100), random->Uniform(0, 100), 0};
    const bool is_free = std::all_of(objects.begin(), objects.end(), [&](const auto& other) {
      return (other.position() - position).norm() > 3;
    });
    if (is_free) objects.push_back(TestDisc(1 + std::ssize(objects), position, time));
  }
  return objects;
}

// Returns as text all that must be equal at UAVs that hold the same.
inline std::string TextOf(const TeamMap& map) {
  std::string text;
  for (const auto& [uav, part] : map.parts()) {
    text += uav.name + std::to_string(uav.boot) + ':' + std::to_string(part.contents.version);
    for (const auto& [id, entry] : part.objects) {
      const auto bytes = EncodeObject(entry.object, part.contents.now);
      text.append(bytes.begin(), bytes.end());
    }
  }
  return text;
}

// A team over a radio that loses, delays and interrupts, in simulated time.
class SimulatedTeam {
 public:
  struct Uav {
    std::unique_ptr<TeamMember> member;
    Duration clock_offset{};
    std::size_t sent_bytes = 0;
    std::size_t largest = 0;
    std::vector<std::string> warnings;
  };

  explicit SimulatedTeam(std::uint64_t seed) : random_(seed) {}

  // Adds a UAV, and returns its index; each has another clock.
  std::size_t Add(const UavKey& key, const std::optional<TeamKey>& secret = {}) {
    const auto offset = std::chrono::seconds(10 * std::ssize(uavs));
    uavs.push_back({std::make_unique<TeamMember>(key, TeamOptions(), secret), offset, 0, 0, {}});
    return uavs.size() - 1;
  }

  Time LocalTime(std::size_t i) const { return now + uavs[i].clock_offset; }

  void Run(double seconds) {
    const Time end = now + DurationFromSeconds(seconds);
    for (; now < end; now += std::chrono::milliseconds(10)) Step();
  }

  // Returns the time (s) until 'holds'; at most 'limit_s'.
  double RunUntil(const std::function<bool()>& holds, double limit_s) {
    const Time start = now;
    while (!holds() && ToSeconds(now - start) < limit_s) {
      Step();
      now += std::chrono::milliseconds(10);
    }
    return ToSeconds(now - start);
  }

  // True when all running UAVs hold the same, and nobody lacks anything.
  bool AreEqual() const {
    std::optional<std::string> text;
    for (const Uav& uav : uavs) {
      if (uav.member == nullptr) continue;
      if (!uav.member->IsWhole()) return false;
      const std::string own = TextOf(uav.member->map());
      if (text.value_or(own) != own) return false;
      text = own;
    }
    return true;
  }

  // Sends to all that hear the sender; strangers may send, too.
  void Broadcast(std::optional<std::size_t> from, std::span<const std::uint8_t> bytes) {
    for (std::size_t to = 0; to < uavs.size(); ++to) {
      if (from == to || (from && is_cut(*from, to)) || random_.Chance(loss)) continue;
      on_the_way_.emplace(now + delay, Letter{to, {bytes.begin(), bytes.end()}});
    }
  }

  std::vector<Uav> uavs;
  Time now = TimeFromNanoseconds(1'000'000'000);
  double loss = 0;
  Duration delay = std::chrono::milliseconds(20);
  std::function<bool(std::size_t from, std::size_t to)> is_cut = [](auto, auto) { return false; };

 private:
  struct Letter {
    std::size_t to;
    std::vector<std::uint8_t> bytes;
  };

  void Step() {
    while (!on_the_way_.empty() && on_the_way_.begin()->first <= now) {
      const Letter letter = std::move(on_the_way_.begin()->second);
      on_the_way_.erase(on_the_way_.begin());
      Uav& uav = uavs[letter.to];
      if (uav.member != nullptr) uav.member->Hear(letter.bytes, LocalTime(letter.to));
    }
    for (std::size_t i = 0; i < uavs.size(); ++i) {
      Uav& uav = uavs[i];
      if (uav.member == nullptr) continue;
      uav.member->Tick(LocalTime(i), [&](std::span<const std::uint8_t> bytes) {
        uav.sent_bytes += bytes.size();
        uav.largest = std::max(uav.largest, bytes.size());
        Broadcast(i, bytes);
      });
      const auto warnings = uav.member->TakeWarnings();
      uav.warnings.insert(uav.warnings.end(), warnings.begin(), warnings.end());
    }
  }

  Random random_;
  std::multimap<Time, Letter> on_the_way_;
};

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "kestrel/comms/team/message_signature.h"
#include "kestrel/comms/team/team_map.h"
#include "kestrel/comms/team/team_message.h"
#include "kestrel/comms/team/team_options.h"
#include "kestrel/core/base/time.h"
#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// A UAV in its team, whatever carries the messages: each may come late, twice, out of order or not
// at all. It tells its own map, and every digest_period_s what it has heard of all: who hears that
// the sender lacks something sends it. The UAV itself answers at once; where it is gone or not
// heard the others do, by their names one more with every digest that still lacks it, so that one
// is enough. Times named 'local' are on this computer's clock and never go back; clocks of
// different UAVs have nothing to do with each other. One thread at a time.
class TeamMember {
 public:
  // With a key, all is signed and what is not signed by it is refused. Throws InputError when the
  // options are not valid or the name is none.
  TeamMember(const UavKey& self, const TeamOptions& options, std::optional<TeamKey> key = {});

  // The own map at its time 'now', which does not decrease: of more than kMaxToldObjects those seen
  // most. It is told with the next Tick.
  void Tell(std::vector<MappedObject> objects, Time now);

  // What this UAV goes for, with the bid as others will hear it; told with the next Tick where that
  // is news.
  void SetClaim(const std::optional<Claim>& claim);

  // The map told last is this UAV's last; told with the next Tick.
  void SetDone();

  // A message from anyone. What is malformed changes nothing.
  void Hear(std::span<const std::uint8_t> bytes, Time local);

  // Gives 'send' what is to be told to all; call it often.
  using Send = std::function<void(std::span<const std::uint8_t>)>;
  void Tick(Time local, const Send& send);

  const UavKey& self() const { return self_; }
  const TeamOptions& options() const { return options_; }
  const TeamMap& map() const { return map_; }

  // Whether all that is known to have been told is here, and nothing waits to be told.
  bool IsWhole() const;
  // When another UAV was heard last to lack what is here.
  const std::optional<Time>& lacked() const { return lacked_; }
  // The UAV itself, and those that were heard of within silence_s, by whomever.
  bool IsAlive(const UavKey& uav, Time local) const;
  // All that were ever heard of, and the UAV itself.
  std::vector<UavKey> Known() const;
  // Whether every UAV that is alive, and this one, has said that its map is its last.
  bool AreAllDone(Time local) const;
  // What a UAV that is alive goes for.
  std::optional<Claim> ClaimOf(const UavKey& uav, Time local) const;

  std::size_t refused() const { return refused_; }  // messages
  // What the user should know, since the last call.
  std::vector<std::string> TakeWarnings();

 private:
  // What is known of a UAV beside its map.
  struct Peer {
    std::uint32_t beat = 0;
    std::optional<Time> beat_at;  // when it rose last
    std::optional<Claim> claim;
    bool is_done = false;
    std::uint64_t newest = 0;  // version that anyone has heard of
    int tries = 0;
  };
  static constexpr std::int64_t kContents = -1;  // in the place of an object's id

  void HearDigest(const UavKey& sender, const Digest& digest, Time local);
  void HearPart(const PartMessage& part, Time local);
  void HearLine(const DigestLine& line, Time local);
  void Defend(const PartMessage& part, Time local);
  void Answer(const UavKey& sender, const DigestLine& line, Time local);
  int RankAfter(const UavKey& owner, const UavKey& asker, Time local) const;
  Peer* Know(const UavKey& uav);
  bool IsBehind(const UavKey& uav, const Peer& peer) const;

  void TellOwn(Time local);
  void MergeOwn(const PartMessage& own, Time local);
  void SendDigest(Time local, const Send& send);
  void SendQueued(Time local, const Send& send);
  void SendMessage(const TeamMessage& message, const Send& send);
  void Warn(const std::string& warning);

  UavKey self_;
  TeamOptions options_;
  std::optional<TeamKey> key_;
  TeamMap map_;
  std::map<UavKey, Peer> peers_;  // with oneself
  struct OwnMap {
    std::vector<MappedObject> objects;
    Time now;
  };
  std::optional<OwnMap> untold_;
  std::optional<Time> told_;
  std::optional<Time> last_digest_;
  std::optional<Time> last_tick_;
  std::optional<Time> lacked_;
  bool has_news_ = false;         // for the digest
  double allowance_;              // bytes that may be sent now
  std::set<ObjectRef> queue_;     // to be sent
  ObjectRef cursor_;              // where in the queue the turn is
  std::map<UavKey, Time> twins_;  // others of the same name: when they were heard first
  std::size_t refused_ = 0;
  std::set<std::string> warned_;
  std::vector<std::string> warnings_;
};

}  // namespace kestrel

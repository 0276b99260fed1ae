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

// A UAV in its team, over any transport: messages may come late, twice, out of order or not at all.
// It sends its own map, and every digest_period_s a digest of what it has heard of all. A UAV that
// hears that the sender of a digest lacks something sends it. The owner answers at once. If the
// owner is gone or not heard, the others answer, in the order of names: one more with every digest
// that still lacks it, so that one answer is enough. Times named 'local' are on this computer's
// clock and never go back; clocks of different UAVs are unrelated. One thread at a time.
class TeamMember {
 public:
  // With a key, every message is signed, and messages without its signature are refused. Throws
  // InputError when the options or the name are not valid.
  TeamMember(const UavKey& self, const TeamOptions& options, std::optional<TeamKey> key = {});

  // Sets the own map at its time 'now', which does not decrease. Of more than kMaxSentObjects,
  // those seen most are kept. The next Tick sends it.
  void Share(std::vector<MappedObject> objects, Time now);

  // Sets the object that this UAV claims, with the bid as others will hear it. The next Tick sends
  // a change.
  void SetClaim(const std::optional<Claim>& claim);

  // Sets where this UAV flies; nothing: it does not. A change of is_at_work is sent at once.
  void SetFlight(const std::optional<UavFlight>& flight);

  // Declares that an object is not there any more, because it was taken. All UAVs hear it, for as
  // long as the map of its UAV has the object.
  void SetGone(const ObjectRef& object, Time local);

  // Declares that the map set last is this UAV's last one; the next Tick sends that.
  void SetDone();

  // Takes a message from anyone. A malformed one changes nothing.
  void Hear(std::span<const std::uint8_t> bytes, Time local);

  // Passes the messages that are due to 'send'; call it often.
  using Send = std::function<void(std::span<const std::uint8_t>)>;
  void Tick(Time local, const Send& send);

  const UavKey& self() const { return self_; }
  const TeamOptions& options() const { return options_; }
  const TeamMap& map() const { return map_; }

  // True when all that is known to have been sent is here, and nothing waits to be sent.
  bool IsWhole() const;
  // Time at which another UAV was last heard to lack something that is here.
  const std::optional<Time>& lacked() const { return lacked_; }
  // True for this UAV, and for those of which anyone has heard within silence_s.
  bool IsAlive(const UavKey& uav, Time local) const;
  // Returns all UAVs ever heard of, and this one.
  std::vector<UavKey> Known() const;
  // True when this UAV and every UAV that is alive have declared their map the last one.
  bool AreAllDone(Time local) const;
  // Returns the claim of a UAV that is alive.
  std::optional<Claim> ClaimOf(const UavKey& uav, Time local) const;
  // Returns where a UAV that is alive flies now, by what it has sent last.
  std::optional<UavFlight> FlightOf(const UavKey& uav, Time local) const;
  // Returns the objects that were taken, as far as it is known here.
  struct Gone {
    ObjectRef object;
    Time since;  // when it became known
  };
  std::vector<Gone> AllGone() const;

  std::size_t refused() const { return refused_; }  // number of messages
  // Returns warnings for the user since the last call.
  std::vector<std::string> TakeWarnings();

 private:
  // State of a UAV, except its map.
  struct Peer {
    std::uint32_t beat = 0;
    std::optional<Time> beat_at;  // when it last increased
    std::optional<Claim> claim;
    std::optional<UavFlight> flight;
    std::map<std::int64_t, Time> gone;  // objects of its map, and when this was first heard
    bool is_done = false;
    std::uint64_t newest = 0;  // newest version that anyone has heard of
    int tries = 0;
  };
  static constexpr std::int64_t kContents = -1;  // stands for the contents instead of an object's
                                                 // id

  void HearDigest(const UavKey& sender, const Digest& digest, Time local);
  void HearPart(const PartMessage& part, Time local);
  void HearLine(const DigestLine& line, Time local);
  void AddGone(const UavKey& uav, std::int64_t id, Time local);
  void Defend(const PartMessage& part, Time local);
  void Answer(const UavKey& sender, const DigestLine& line, Time local);
  int RankAfter(const UavKey& owner, const UavKey& asker, Time local) const;
  Peer* Know(const UavKey& uav);
  bool IsBehind(const UavKey& uav, const Peer& peer) const;

  void SendOwn(Time local);
  void MergeOwn(const PartMessage& own, Time local);
  void SendDigest(Time local, const Send& send);
  void SendQueued(Time local, const Send& send);
  void SendMessage(const TeamMessage& message, const Send& send);
  void Warn(const std::string& warning);

  UavKey self_;
  TeamOptions options_;
  std::optional<TeamKey> key_;
  TeamMap map_;
  std::map<UavKey, Peer> peers_;  // this UAV included
  struct OwnMap {
    std::vector<MappedObject> objects;
    Time now;
  };
  std::optional<OwnMap> unsent_;
  std::optional<Time> reported_;
  std::optional<Time> last_digest_;
  std::optional<Time> last_tick_;
  std::optional<Time> lacked_;
  bool has_news_ = false;         // for the digest
  double allowance_;              // number of bytes that may be sent now
  std::set<ObjectRef> queue_;     // parts to be sent
  ObjectRef cursor_;              // next position in the queue
  std::map<UavKey, Time> twins_;  // other UAVs with the same name: when they were first heard
  std::size_t refused_ = 0;
  std::set<std::string> warned_;
  std::vector<std::string> warnings_;
};

}  // namespace kestrel

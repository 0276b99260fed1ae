// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_member.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

// Bytes of objects in one message: with the rest of the message it fits one frame of most radios.
// With two frames the loss would be nearly twice as frequent.
constexpr std::size_t kPartBytes = 900;

bool IsSame(const MappedObject& a, const MappedObject& b) {
  const Time now = std::max({a.time, b.time, a.last_seen, b.last_seen});
  return EncodeObject(a, now) == EncodeObject(b, now);
}

bool HaveSameIds(const Contents& a, const Contents& b) {
  return std::equal(a.objects.begin(), a.objects.end(), b.objects.begin(), b.objects.end(),
                    [](const auto& x, const auto& y) { return x.first == y.first; });
}

// Returns the first ids, at most so many.
std::vector<std::int64_t> IdsOf(const std::map<std::int64_t, Time>& times, std::size_t most) {
  std::vector<std::int64_t> ids;
  for (const auto& [id, time] : times) {
    if (ids.size() < most) ids.push_back(id);
  }
  return ids;
}

// True when a beat comes after another: the count wraps around.
bool IsLater(std::uint32_t beat, std::uint32_t other) {
  return static_cast<std::int32_t>(beat - other) > 0;
}

// True when the message contradicts the part that is here.
bool Contradicts(const PartMessage& message, const TeamMap::Part& part) {
  if (message.contents.version > part.contents.version) return true;
  if (message.contents.version == part.contents.version &&
      message.contents.objects != part.contents.objects) {
    return true;
  }
  return std::any_of(message.objects.begin(), message.objects.end(), [&](const auto& object) {
    const auto own = part.objects.find(object.id);
    return own != part.objects.end() &&
           own->second.version == message.contents.objects.at(object.id) &&
           !IsSame(object, own->second.object);
  });
}

}  // namespace

TeamMember::TeamMember(const UavKey& self, const TeamOptions& options, std::optional<TeamKey> key)
    : self_(self), options_(Checked(options)), key_(key), allowance_(options.rate_bytes_per_s) {
  if (!IsUavName(self.name)) {
    throw InputError(fmt::format(
        "'{}' is no name of a UAV: expected 1 to 32 letters, digits, '_', '-' and '.'", self.name));
  }
  peers_[self_];
}

void TeamMember::Share(std::vector<MappedObject> objects, Time now) {
  if (objects.size() > kMaxSentObjects) {
    std::stable_sort(objects.begin(), objects.end(),
                     [](const auto& a, const auto& b) { return a.detections > b.detections; });
    objects.resize(kMaxSentObjects);
  }
  unsent_ = {std::move(objects), now};
}

void TeamMember::SetClaim(const std::optional<Claim>& claim) {
  std::optional<Claim> reported = claim;
  if (reported) reported->bid = static_cast<float>(reported->bid);
  if (reported == peers_[self_].claim) return;
  peers_[self_].claim = reported;
  has_news_ = true;
}

void TeamMember::SetFlight(const std::optional<UavFlight>& flight) {
  const auto is_at_work = [](const auto& one) { return one && one->is_at_work; };
  std::optional<UavFlight>& own = peers_[self_].flight;
  if (is_at_work(flight) != is_at_work(own)) has_news_ = true;
  own = flight;
}

void TeamMember::SetGone(const ObjectRef& object, Time local) {
  peers_[object.uav].gone.erase(object.id);  // it may have been there again meanwhile
  AddGone(object.uav, object.id, local);
  has_news_ = true;
}

// Others repeat what was heard before the object itself.
void TeamMember::AddGone(const UavKey& uav, std::int64_t id, Time local) {
  const TeamMap::Part* const part = map_.Find(uav);
  if (part != nullptr && part->contents.objects.contains(id)) peers_[uav].gone.emplace(id, local);
}

void TeamMember::SetDone() {
  peers_[self_].is_done = true;
  has_news_ = true;
}

void TeamMember::Hear(std::span<const std::uint8_t> bytes, Time local) {
  const auto content = key_ ? CheckSignature(*key_, bytes) : bytes;
  const auto message = content ? ParseMessage(*content) : std::nullopt;
  if (!message) {
    ++refused_;
    Warn(key_ ? "messages are refused that are not signed by the team's key"
              : "messages are refused that are damaged, or signed with a key that is not given");
    return;
  }
  if (message->sender.name == self_.name && message->sender != self_) {
    // After a restart messages from the earlier run may still arrive.
    const Time since = twins_.try_emplace(message->sender, local).first->second;
    if (twins_.size() > kMaxUavs) twins_.clear();
    constexpr Duration kEcho = std::chrono::seconds(2);
    if (local - since > kEcho) {
      Warn(fmt::format("another UAV is called '{}': give each a name of its own", self_.name));
    }
  }
  if (const auto* digest = std::get_if<Digest>(&message->body)) {
    HearDigest(message->sender, *digest, local);
  } else {
    HearPart(std::get<PartMessage>(message->body), local);
  }
}

void TeamMember::HearPart(const PartMessage& part, Time local) {
  if (part.uav == self_) {
    Defend(part, local);
  } else if (Know(part.uav) != nullptr) {
    map_.Merge(part, local);
  }
}

// Somebody sends another map under this UAV's name. Only a version above it makes all forget it.
void TeamMember::Defend(const PartMessage& part, Time local) {
  const TeamMap::Part* own = map_.Find(self_);
  const TeamMap::Part nothing;
  if (own == nullptr) own = &nothing;
  if (!Contradicts(part, *own)) return;
  Warn("somebody sends a map under this UAV's name: use a key that the team shares");
  const std::uint64_t version = std::max(part.contents.version, own->contents.version) + 1;
  if (version > kMaxVersion) return;
  PartMessage renewed{self_, local - own->sent_at, {version, own->contents.now, {}}, {}};
  for (const auto& [id, entry] : own->objects) {
    renewed.contents.objects[id] = version;
    renewed.objects.push_back(entry.object);
  }
  MergeOwn(renewed, local);
}

void TeamMember::HearDigest(const UavKey& sender, const Digest& digest, Time local) {
  if (sender == self_) return;
  std::map<UavKey, const DigestLine*> lines;
  for (const DigestLine& line : digest) {
    lines[line.uav] = &line;
    HearLine(line, local);
  }
  for (const auto& [uav, part] : map_.parts()) {
    const auto line = lines.find(uav);
    Answer(sender, line == lines.end() ? DigestLine{uav, {}, {}, {}, {}, {}, {}} : *line->second,
           local);
  }
}

void TeamMember::HearLine(const DigestLine& line, Time local) {
  Peer* const peer = Know(line.uav);
  if (peer == nullptr) return;
  for (const std::int64_t id : line.gone) AddGone(line.uav, id, local);
  if (line.uav == self_) {
    if (IsLater(line.beat, peer->beat)) peer->beat = line.beat;  // forged: stay ahead of it
    return;
  }
  peer->newest = std::max(peer->newest, line.version);
  if (peer->beat_at && !IsLater(line.beat, peer->beat)) return;
  peer->beat = line.beat;
  peer->beat_at = local;
  peer->claim = line.claim;
  peer->flight = line.flight;
  peer->is_done = line.is_done;
}

// Queues what the sender of the line lacks, if it is this UAV's turn.
void TeamMember::Answer(const UavKey& sender, const DigestLine& line, Time local) {
  const TeamMap::Part& part = *map_.Find(line.uav);
  if (line.version >= part.contents.version && line.missing.empty()) return;
  lacked_ = local;
  if (line.uav == sender || RankAfter(line.uav, sender, local) > line.tries) return;
  const std::set<std::int64_t> missing(line.missing.begin(), line.missing.end());
  // A UAV that still lacks it after so many digests does not hear the one that sent it.
  constexpr int kPatience = 8;
  const Duration resend = DurationFromSeconds(line.tries > kPatience ? 0 : TeamOptions::kResend_s);
  bool is_on_air = false;
  for (const auto& [id, entry] : part.objects) {
    if (!part.Has(id) || (entry.version <= line.version && !missing.contains(id))) continue;
    if (local - entry.on_air < resend) {
      is_on_air = true;
    } else {
      queue_.insert({line.uav, id});
    }
  }
  // The contents are sent with every object.
  if (line.version < part.contents.version && !is_on_air) queue_.insert({line.uav, kContents});
}

// Returns how many UAVs answer before this one when somebody lacks a part of the owner's map.
int TeamMember::RankAfter(const UavKey& owner, const UavKey& asker, Time local) const {
  if (owner == self_) return 0;
  const auto before = peers_.lower_bound(self_);
  return 1 + static_cast<int>(std::count_if(peers_.begin(), before, [&](const auto& peer) {
           return peer.first != owner && peer.first != asker && IsAlive(peer.first, local);
         }));
}

// Null when the number of UAVs has reached its limit.
TeamMember::Peer* TeamMember::Know(const UavKey& uav) {
  if (peers_.size() >= kMaxUavs && !peers_.contains(uav)) return nullptr;
  return &peers_[uav];
}

bool TeamMember::IsBehind(const UavKey& uav, const Peer& peer) const {
  const TeamMap::Part* const part = map_.Find(uav);
  if (part == nullptr) return peer.newest > 0;
  return peer.newest > part->contents.version || !part->Missing(1).empty();
}

bool TeamMember::IsWhole() const {
  return !unsent_ && queue_.empty() &&
         std::none_of(peers_.begin(), peers_.end(),
                      [&](const auto& peer) { return IsBehind(peer.first, peer.second); });
}

bool TeamMember::IsAlive(const UavKey& uav, Time local) const {
  if (uav == self_) return true;
  const auto peer = peers_.find(uav);
  return peer != peers_.end() && peer->second.beat_at &&
         local - *peer->second.beat_at <= DurationFromSeconds(options_.silence_s);
}

std::vector<UavKey> TeamMember::Known() const {
  std::vector<UavKey> known;
  for (const auto& [uav, peer] : peers_) known.push_back(uav);
  return known;
}

bool TeamMember::AreAllDone(Time local) const {
  return std::all_of(peers_.begin(), peers_.end(), [&](const auto& peer) {
    return peer.second.is_done || !IsAlive(peer.first, local);
  });
}

std::optional<Claim> TeamMember::ClaimOf(const UavKey& uav, Time local) const {
  return IsAlive(uav, local) ? peers_.at(uav).claim : std::nullopt;
}

std::optional<UavFlight> TeamMember::FlightOf(const UavKey& uav, Time local) const {
  const auto peer = peers_.find(uav);
  if (peer == peers_.end() || !peer->second.flight || !IsAlive(uav, local)) return std::nullopt;
  constexpr double kLongest_s = 2;  // who is not heard for longer stands still for all we know
  UavFlight flight = *peer->second.flight;
  if (peer->second.beat_at) {
    const double ahead_s = std::min(ToSeconds(local - *peer->second.beat_at), kLongest_s);
    flight.position += ahead_s * flight.velocity;
  }
  return flight;
}

std::vector<TeamMember::Gone> TeamMember::AllGone() const {
  std::vector<Gone> all;
  for (const auto& [uav, peer] : peers_) {
    for (const auto& [id, since] : peer.gone) all.push_back({{uav, id}, since});
  }
  return all;
}

void TeamMember::Tick(Time local, const Send& send) {
  if (last_tick_) {
    const double more = ToSeconds(local - *last_tick_) * options_.rate_bytes_per_s;
    allowance_ = std::min(allowance_ + more, options_.rate_bytes_per_s);
  }
  last_tick_ = local;
  const auto is_due = [&](const std::optional<Time>& last, double period_s) {
    return !last || local - *last >= DurationFromSeconds(period_s);
  };
  if (unsent_ && is_due(reported_, TeamOptions::kSendPeriod_s)) SendOwn(local);
  if (allowance_ > 0 && (has_news_ || is_due(last_digest_, TeamOptions::kDigestPeriod_s))) {
    SendDigest(local, send);
  }
  while (allowance_ > 0 && !queue_.empty()) SendQueued(local, send);
}

// Sends a new version, with what has changed.
void TeamMember::SendOwn(Time local) {
  const TeamMap::Part* part = map_.Find(self_);
  const TeamMap::Part nothing;
  if (part == nullptr) part = &nothing;
  const std::uint64_t version = part->contents.version + 1;
  PartMessage own{self_, {}, {version, unsent_->now, {}}, {}};
  for (const MappedObject& object : unsent_->objects) {
    const auto reported = AsReported(object, unsent_->now);
    if (!reported) continue;
    const auto held = part->objects.find(reported->id);
    const bool is_same = held != part->objects.end() && IsSame(*reported, held->second.object);
    own.contents.objects[reported->id] = is_same ? held->second.version : version;
    if (!is_same) own.objects.push_back(*reported);
  }
  const bool has_changed = !own.objects.empty() || !HaveSameIds(own.contents, part->contents);
  if (has_changed && version <= kMaxVersion) MergeOwn(own, local);
  reported_ = local;
  unsent_.reset();
}

void TeamMember::MergeOwn(const PartMessage& own, Time local) {
  map_.Merge(own, local);
  queue_.insert({self_, kContents});
  for (const MappedObject& object : own.objects) queue_.insert({self_, object.id});
}

void TeamMember::SendDigest(Time local, const Send& send) {
  Digest digest;
  std::size_t room = kMaxMissing;
  std::size_t gone_room = kMaxGone - std::min(kMaxGone, peers_[self_].gone.size());
  peers_[self_].beat += 1;
  for (auto& [uav, peer] : peers_) {
    const TeamMap::Part* const part = map_.Find(uav);
    DigestLine line;
    line.uav = uav;
    line.beat = peer.beat;
    if (part != nullptr) line.version = part->contents.version;
    line.is_done = peer.is_done && !(uav == self_ && unsent_);
    line.claim = ClaimOf(uav, local);
    line.flight = FlightOf(uav, local);
    if (part != nullptr) line.missing = part->Missing(room);
    std::erase_if(peer.gone, [part](const auto& gone) {
      return part == nullptr || !part->contents.objects.contains(gone.first);
    });
    line.gone = IdsOf(peer.gone, uav == self_ ? kMaxGone : gone_room);
    room -= line.missing.size();
    if (uav != self_) gone_room -= line.gone.size();
    peer.tries = IsBehind(uav, peer) ? std::min(peer.tries + 1, kMaxTries) : 0;
    line.tries = peer.tries;
    digest.push_back(std::move(line));
  }
  SendMessage({self_, std::move(digest)}, send);
  last_digest_ = local;
  has_news_ = false;
}

// Sends one message with the contents of the next UAV in turn and its next objects.
void TeamMember::SendQueued(Time local, const Send& send) {
  auto next = queue_.lower_bound(cursor_);
  if (next == queue_.end()) next = queue_.begin();
  const UavKey uav = next->uav;
  const TeamMap::Part& part = *map_.Find(uav);
  PartMessage message{uav, local - part.sent_at, part.contents, {}};
  std::size_t bytes = 0;
  while (next != queue_.end() && next->uav == uav && bytes < kPartBytes) {
    const auto entry = part.objects.find(next->id);
    if (entry != part.objects.end() && part.Has(next->id)) {
      message.objects.push_back(entry->second.object);
      bytes += EncodeObject(entry->second.object, part.contents.now).size();
    }
    cursor_ = {uav, next->id + 1};
    next = queue_.erase(next);
  }
  // The message contains the contents.
  queue_.erase({uav, kContents});
  map_.Merge(message, local);  // it is on the air now
  SendMessage({self_, std::move(message)}, send);
}

void TeamMember::SendMessage(const TeamMessage& message, const Send& send) {
  std::vector<std::uint8_t> bytes = EncodeMessage(message);
  if (key_) SignMessage(*key_, &bytes);
  allowance_ -= static_cast<double>(bytes.size());
  send(bytes);
}

std::vector<std::string> TeamMember::TakeWarnings() { return std::exchange(warnings_, {}); }

void TeamMember::Warn(const std::string& warning) {
  if (warned_.insert(warning).second) warnings_.push_back(warning);
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_link.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdint>
#include <random>
#include <span>
#include <thread>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/comms/mavlink/signing.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/tables/object_map_files.h"

namespace kestrel {
namespace {

constexpr std::size_t kMaxName = 32;
constexpr char kUavNames[] = "expected 1 to 32 letters, digits, '_', '-' and '.'";

bool IsTeamName(const std::string& name) {
  return !name.empty() && name.size() <= kMaxName &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

// The computer's name, changed to a valid name of a UAV.
std::string ComputerName() {
  std::array<char, kMaxName + 1> name{};
  // A longer name is cut off, which is not an error here.
  static_cast<void>(gethostname(name.data(), kMaxName));
  std::string text = name.data();
  std::replace_if(
      text.begin(), text.end(), [](char c) { return !IsUavName(std::string(1, c)); }, '_');
  return text.empty() ? "uav" : text;
}

UavKey OwnKey(const TeamLinkOptions& options) {
  std::random_device random;
  return {options.uav.empty() ? ComputerName() : options.uav, random()};
}

std::optional<TeamKey> ReadKey(const TeamLinkOptions& options) {
  if (options.key.empty()) return std::nullopt;
  return mavlink::ReadSigningKey(options.key);
}

std::string CheckedTeam(const std::string& team) {
  if (IsTeamName(team)) return team;
  throw InputError(fmt::format("--team '{}': expected 1 to 32 letters, digits and '_'", team));
}

}  // namespace

std::vector<std::string> TeamLinkOptions::Validate() const {
  std::vector<std::string> violations;
  if (!uav.empty() && !IsUavName(uav)) {
    violations.push_back(fmt::format("uav is '{}', {}", uav, kUavNames));
  }
  return violations;
}

TeamLink::TeamLink(const std::string& team, int domain, const TeamLinkOptions& options,
                   const ObjectMapOptions& map, const ObjectModel& model, Report report)
    : options_(options),
      member_(OwnKey(options), options.team, ReadKey(options)),
      topic_(domain, CheckedTeam(team),
             fmt::format("{}/{:08x}", member_.self().name, member_.self().boot)),
      fusion_(options.team, map),
      model_(model),
      report_(std::move(report)) {}

bool TeamLink::IsTimeToSend() const {
  return !reported_ || Now() - *reported_ >= DurationFromSeconds(TeamOptions::kSendPeriod_s);
}

void TeamLink::Share(std::vector<MappedObject> objects) {
  if (map_time_ == Time::min() && objects.empty()) return;  // the map has no time yet
  for (const MappedObject& object : objects) {
    map_time_ = std::max({map_time_, object.time, object.last_seen});
  }
  member_.Share(std::move(objects), map_time_);
  reported_ = Now();
}

void TeamLink::Exchange() {
  topic_.Receive([this](std::span<const std::uint8_t> bytes) { member_.Hear(bytes, Now()); });
  const bool claims = goals_ || (options_.claim && position_);
  if (claims && Now() >= next_claim_) ChooseAgain();
  member_.Tick(Now(), [this](std::span<const std::uint8_t> bytes) { topic_.Send(bytes); });
  for (const std::string& warning : member_.TakeWarnings()) {
    report_("team: " + warning);
  }
}

// Returns the object for which the UAV goes; nothing: there is none.
std::optional<MappedObject> TeamLink::Choose() {
  const TeamView view = View();
  if (goals_) {
    const TeamGoal& goal = goals_->Update(view, flight_, Now(), &member_);
    return goal.number == 0 ? std::nullopt : std::optional(goal.object);
  }
  const auto chosen = ChooseObject(view, *position_, model_, Now(), &member_);
  return chosen ? std::optional(view.objects[*chosen]) : std::nullopt;
}

// Called as often as the claim is sent to others.
void TeamLink::ChooseAgain() {
  next_claim_ = Now() + DurationFromSeconds(TeamOptions::kDigestPeriod_s);
  const std::optional<MappedObject> chosen = Choose();
  std::optional<ObjectRef> claimed;
  if (const auto claim = member_.ClaimOf(member_.self(), Now())) claimed = claim->object;
  if (std::exchange(claimed_, claimed) == claimed) return;
  if (!chosen) {
    // One that carries an object goes for no other one meanwhile.
    if (!goals_ || flight_.wants_object) report_("team: there is nothing left to go for");
    return;
  }
  const MappedObject& object = *chosen;
  const auto class_index = ClassOf(object, model_);
  report_(fmt::format("team: goes for {} at ({:.1f}, {:.1f}) m",
                      class_index ? model_.classes[*class_index].name : ToString(object.shape),
                      object.position().x(), object.position().y()));
}

std::vector<std::optional<Claim>> TeamLink::Claims() const {
  std::vector<std::optional<Claim>> claims;
  for (const UavKey& uav : member_.Known()) claims.push_back(member_.ClaimOf(uav, Now()));
  return claims;
}

void TeamLink::Finish(std::vector<MappedObject> objects, const std::function<bool()>& is_stopped) {
  constexpr Duration kStay = std::chrono::seconds(1);  // others may lack data, unheard
  constexpr Duration kPause = std::chrono::milliseconds(10);
  const Duration silence = DurationFromSeconds(options_.team.silence_s);
  Share(std::move(objects));
  member_.SetDone();
  flight_.wants_object = false;  // the flight has ended
  bool was_reported = false;
  Time awaited = Now();  // last time at which a UAV was not done
  Time lacking = Now();  // last time at which data were missing or changed
  std::vector<std::optional<Claim>> claims;
  for (;;) {
    Exchange();
    const Time now = Now();
    if (auto newest = Claims(); newest != claims) {
      claims = std::move(newest);
      lacking = now;
    }
    const bool are_done = member_.AreAllDone(now);
    if (!are_done) awaited = now;
    if (!are_done && !std::exchange(was_reported, true)) ReportAwaited();
    if (!are_done || !member_.IsWhole() || member_.Known().size() == 1) lacking = now;
    if (member_.lacked()) lacking = std::max(lacking, *member_.lacked());
    if (is_stopped() || now - lacking >= kStay || now - awaited >= silence) break;
    std::this_thread::sleep_for(kPause);
  }
  if (!member_.IsWhole()) report_("team: of what the team has seen not all was heard");
}

void TeamLink::ReportAwaited() const {
  std::vector<std::string> names;
  for (const UavKey& uav : member_.Known()) {
    if (uav != member_.self() && member_.IsAlive(uav, Now())) names.push_back(uav.name);
  }
  report_(fmt::format("team: waits for {} (Ctrl-C: no longer)", fmt::join(names, ", ")));
}

void TeamLink::WriteMap(const std::vector<double>& origin, const OutputFolder& folder) {
  const TeamView view = View();
  WriteTeamMap(CommonMap(member_, view, fusion_), view.objects, model_, origin, folder);
}

std::string TeamLink::Found() {
  return fmt::format("team: {} UAVs, {} objects", member_.Known().size(), View().objects.size());
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_map.h"

#include <algorithm>

namespace kestrel {

bool TeamMap::Part::Has(std::int64_t id) const {
  const auto held = objects.find(id);
  const auto listed = contents.objects.find(id);
  return held != objects.end() && listed != contents.objects.end() &&
         held->second.version == listed->second;
}

std::vector<std::int64_t> TeamMap::Part::Missing(std::size_t max) const {
  std::vector<std::int64_t> missing;
  for (const auto& [id, version] : contents.objects) {
    if (missing.size() == max) break;
    if (!Has(id)) missing.push_back(id);
  }
  return missing;
}

void TeamMap::Merge(const PartMessage& message, Time local) {
  if (!parts_.contains(message.uav) && parts_.size() == kMaxUavs) return;
  const auto [place, is_new] = parts_.try_emplace(message.uav);
  Part& part = place->second;
  const Time sent_at = local - message.age;
  if (is_new || message.contents.version > part.contents.version) {
    part.contents = message.contents;
    part.sent_at = sent_at;
    ++part.revision;
    std::erase_if(part.objects,
                  [&](const auto& held) { return !part.contents.objects.contains(held.first); });
  } else if (message.contents.version == part.contents.version) {
    part.sent_at = std::min(part.sent_at, sent_at);
  }
  for (const MappedObject& object : message.objects) {
    const auto listed = part.contents.objects.find(object.id);
    if (listed == part.contents.objects.end() ||
        listed->second != message.contents.objects.at(object.id)) {
      continue;
    }
    if (!part.Has(object.id)) {
      part.objects[object.id] = {listed->second, object, local};
      ++part.revision;
    }
    part.objects[object.id].on_air = local;
  }
}

const TeamMap::Part* TeamMap::Find(const UavKey& uav) const {
  const auto part = parts_.find(uav);
  return part == parts_.end() ? nullptr : &part->second;
}

}  // namespace kestrel

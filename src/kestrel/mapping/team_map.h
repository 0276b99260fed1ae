// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "kestrel/mapping/mapped_object.h"
#include "kestrel/mapping/object_map.h"

namespace kestrel {

// What one UAV has told of its map. 'version' grows with every telling.
struct UavMap {
  std::uint64_t version = 0;
  std::vector<MappedObject> objects;
};

// The maps of a team of UAVs. Of each UAV the newest is kept, so that merging is commutative,
// associative and idempotent: in whatever order and however often messages come, all that have
// heard the same hold the same map.
class TeamMap {
 public:
  // Keeps the newer of both; of two that differ under one version, always the same one.
  void Put(const std::string& uav, const UavMap& map);
  void Merge(const TeamMap& other);

  const std::map<std::string, UavMap>& maps() const { return maps_; }

  // All objects as one map, at the time of the newest: those of one kind that are as near to each
  // other as their covariances allow are one. A function of maps() alone. Ids count from 1.
  std::vector<MappedObject> Fused(const ObjectMapOptions& options) const;

 private:
  std::map<std::string, UavMap> maps_;
};

}  // namespace kestrel

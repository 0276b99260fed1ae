// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "kestrel/comms/team/team_message.h"
#include "kestrel/core/base/time.h"
#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// The maps of a team's UAVs, merged by versions: of each UAV the newest contents, of each object
// the state that they list. Merging is commutative, associative and idempotent: in whatever order
// and however often messages come, all that have heard the same hold the same. What newer contents
// do not list is gone, so that nothing has to be remembered of what was removed.
class TeamMap {
 public:
  struct Entry {
    std::uint64_t version = 0;
    MappedObject object;  // on the clock and in the world of its UAV
    Time on_air;          // told or heard last, on this computer's clock
  };
  struct Part {
    Contents contents;
    Time told_at;  // when the contents were told, on this computer's clock: the earliest guess
    // What has come of it. An object that the contents list with a newer version is kept as it was.
    std::map<std::int64_t, Entry> objects;
    std::uint64_t revision = 0;  // grows whenever contents or objects change here

    bool Has(std::int64_t id) const;  // in the version that is listed
    // Of the objects that are listed and not here, the first 'max'.
    std::vector<std::int64_t> Missing(std::size_t max) const;
  };

  // 'local': now, on this computer's clock. Of more than kMaxUavs the last are left out.
  void Merge(const PartMessage& message, Time local);

  // Null when nothing was heard of the UAV's map.
  const Part* Find(const UavKey& uav) const;
  const std::map<UavKey, Part>& parts() const { return parts_; }

 private:
  std::map<UavKey, Part> parts_;
};

}  // namespace kestrel

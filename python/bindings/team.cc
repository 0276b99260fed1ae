// SPDX-License-Identifier: BSD-3-Clause
// The map that a team of UAVs shares.
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "bindings.h"
#include "enum_casters.h"
#include "kestrel/comms/team/team_view.h"
#include "option_values.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

// The team's map as one UAV holds it, over any transport.
class TeamMap {
 public:
  TeamMap(const std::string& name, const TeamOptions& options)
      : member_({name, std::random_device()()}, options), fusion_(options, ObjectMapOptions()) {}

  void Share(const std::vector<MappedObject>& objects, Time now) { member_.Share(objects, now); }

  void Hear(const py::bytes& message, Time local) {
    const std::string_view text = message;
    member_.Hear(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), local);
  }

  std::vector<py::bytes> Tick(Time local) {
    std::vector<py::bytes> messages;
    member_.Tick(local, [&](std::span<const std::uint8_t> bytes) {
      messages.emplace_back(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    });
    return messages;
  }

  std::vector<TeamObject> Objects(Time local) { return OwnMap(ViewTeam(member_, local, &fusion_)); }

  std::vector<std::string> Uavs(Time local) const {
    std::vector<std::string> names;
    for (const UavKey& uav : member_.Known()) {
      if (member_.IsAlive(uav, local)) names.push_back(uav.name);
    }
    return names;
  }

  const TeamMember& member() const { return member_; }

 private:
  TeamMember member_;
  TeamFusion fusion_;
};

}  // namespace

void BindTeam(py::module_& module) {
  ValueClass<TeamObject>(module, "TeamObject", "An object of the team's map.")
      .Field("object", &TeamObject::object, "MappedObject, in this UAV's world.")
      .Field("uavs", &TeamObject::uavs, "Names of the UAVs that have it in their maps.")
      .Field("holder", &TeamObject::holder, "Name of the UAV that goes for it; empty: none.");
  py::class_<TeamMap>(module, "TeamMap",
                      "The map that a team of UAVs shares, as one UAV holds it. The messages go "
                      "over any transport: "
                      "they may come late, twice, out of order or not at all. For one thread.")
      .def(py::init([](const std::string& name, const py::kwargs& options) {
             TeamOptions values;
             SetFields(options, FieldsOf(values));
             return std::make_unique<TeamMap>(name, values);
           }),
           py::arg("name"),
           "name: of this UAV, 1 to 32 letters, digits, '_', '-' and '.'.\nKeyword arguments: "
           "options by the names of `kestrel config` under team, as rate_bytes_per_s=5000.")
      .def("share", &TeamMap::Share, py::arg("objects"), py::arg("time_ns"),
           "Sets this UAV's own map, a list of MappedObject, at its time; the next tick sends it.")
      .def(
          "hear", &TeamMap::Hear, py::arg("message"), py::arg("now_ns"),
          "Takes a message (bytes) of anyone; a malformed one changes nothing.\n\nnow_ns: the time "
          "of this computer, which never goes back.")
      .def("tick", &TeamMap::Tick, py::arg("now_ns"),
           "Returns the messages that are due, a list of bytes for all others. Call it often, some "
           "ten times a second.")
      .def("objects", &TeamMap::Objects, py::arg("now_ns"),
           "Returns the team's map in this UAV's own world, a list of TeamObject.")
      .def("uavs", &TeamMap::Uavs, py::arg("now_ns"),
           "Returns the names of the UAVs that are alive, this one included.")
      .def_property_readonly(
          "is_whole", [](const TeamMap& self) { return self.member().IsWhole(); },
          "True when all that is known to have been sent is here.")
      .def("__repr__", [](const TeamMap& self) {
        return fmt::format("<TeamMap of {}: {} UAVs>", self.member().self().name,
                           self.member().Known().size());
      });
}

}  // namespace kestrel::python

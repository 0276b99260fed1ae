// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/message_table.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "kestrel/comms/mavlink/camera_messages.h"
#include "kestrel/comms/mavlink/messages.h"

namespace kestrel::mavlink {
namespace {

template <class... Messages>
constexpr auto MakeTable() {
  return std::array<MessageInfo, sizeof...(Messages)>{
      MessageInfo{Messages::kId, Messages::kName, &kLayout<Messages>}...};
}

constexpr auto kTable = MakeTable<
    Heartbeat, SysStatus, SystemTime, SetMode, ParamRequestRead, ParamRequestList, ParamValue,
    ParamSet, GpsRawInt, RawImu, Attitude, AttitudeQuaternion, LocalPositionNed, GlobalPositionInt,
    SetGpsGlobalOrigin, GpsGlobalOrigin, RcChannels, RequestDataStream, VfrHud, CommandLong,
    CommandAck, SetAttitudeTarget, SetPositionTargetLocalNed, HighresImu, SimState, Timesync,
    HilStateQuaternion, DistanceSensor, Altitude, FollowTarget, AutopilotVersion, LandingTarget,
    EkfStatusReport, EstimatorStatus, HomePosition, MessageInterval, ExtendedSysState, Statustext,
    CameraInformation, CameraSettings, CameraCaptureStatus, MountOrientation,
    VideoStreamInformation, VideoStreamStatus, CameraFovStatus, CameraTrackingImageStatus,
    CameraTrackingGeoStatus, GimbalManagerInformation, GimbalManagerStatus,
    GimbalDeviceAttitudeStatus, GimbalManagerSetPitchyaw, Odometry, CurrentMode, TargetRelative>();

constexpr bool IsSortedById() {
  return std::is_sorted(kTable.begin(), kTable.end(),
                        [](const auto& a, const auto& b) { return a.id < b.id; });
}
static_assert(IsSortedById());

// Values from the autopilots' own headers, generated from the XML: a description that differs from
// theirs does not compile.
template <class Message>
constexpr bool Is(std::uint8_t crc_extra, std::size_t base_length, std::size_t full_length) {
  constexpr const MessageLayout& layout = kLayout<Message>;
  return layout.crc_extra == crc_extra && layout.base_length == base_length &&
         layout.full_length == full_length;
}
static_assert(Is<Heartbeat>(50, 9, 9));
static_assert(Is<SysStatus>(124, 31, 43));
static_assert(Is<SystemTime>(137, 12, 12));
static_assert(Is<SetMode>(89, 6, 6));
static_assert(Is<ParamRequestRead>(214, 20, 20));
static_assert(Is<ParamRequestList>(159, 2, 2));
static_assert(Is<ParamValue>(220, 25, 25));
static_assert(Is<ParamSet>(168, 23, 23));
static_assert(Is<GpsRawInt>(24, 30, 52));
static_assert(Is<RawImu>(144, 26, 29));
static_assert(Is<Attitude>(39, 28, 28));
static_assert(Is<AttitudeQuaternion>(246, 32, 48));
static_assert(Is<LocalPositionNed>(185, 28, 28));
static_assert(Is<GlobalPositionInt>(104, 28, 28));
static_assert(Is<SetGpsGlobalOrigin>(41, 13, 21));
static_assert(Is<GpsGlobalOrigin>(39, 12, 20));
static_assert(Is<RcChannels>(118, 42, 42));
static_assert(Is<RequestDataStream>(148, 6, 6));
static_assert(Is<VfrHud>(20, 20, 20));
static_assert(Is<CommandLong>(152, 33, 33));
static_assert(Is<CommandAck>(143, 3, 10));
static_assert(Is<SetAttitudeTarget>(49, 39, 51));
static_assert(Is<SetPositionTargetLocalNed>(143, 53, 53));
static_assert(Is<HighresImu>(93, 62, 63));
static_assert(Is<SimState>(32, 84, 92));
static_assert(Is<Timesync>(34, 16, 18));
static_assert(Is<HilStateQuaternion>(4, 64, 64));
static_assert(Is<DistanceSensor>(85, 14, 39));
static_assert(Is<Altitude>(47, 32, 32));
static_assert(Is<FollowTarget>(127, 93, 93));
static_assert(Is<AutopilotVersion>(178, 60, 78));
static_assert(Is<LandingTarget>(200, 30, 60));
static_assert(Is<EkfStatusReport>(71, 22, 26));
static_assert(Is<EstimatorStatus>(163, 42, 42));
static_assert(Is<HomePosition>(104, 52, 60));
static_assert(Is<MessageInterval>(95, 6, 6));
static_assert(Is<ExtendedSysState>(130, 2, 2));
static_assert(Is<Statustext>(83, 51, 54));
static_assert(Is<CameraInformation>(92, 235, 237));
static_assert(Is<CameraSettings>(146, 5, 14));
static_assert(Is<CameraCaptureStatus>(12, 18, 23));
static_assert(Is<MountOrientation>(26, 16, 20));
static_assert(Is<VideoStreamInformation>(109, 213, 215));
static_assert(Is<VideoStreamStatus>(59, 19, 20));
static_assert(Is<CameraFovStatus>(22, 52, 53));
static_assert(Is<CameraTrackingImageStatus>(126, 31, 32));
static_assert(Is<CameraTrackingGeoStatus>(18, 49, 50));
static_assert(Is<GimbalManagerInformation>(70, 33, 33));
static_assert(Is<GimbalManagerStatus>(48, 13, 13));
static_assert(Is<GimbalDeviceAttitudeStatus>(137, 40, 49));
static_assert(Is<GimbalManagerSetPitchyaw>(1, 23, 23));
static_assert(Is<Odometry>(91, 230, 233));
static_assert(Is<CurrentMode>(193, 9, 9));
static_assert(Is<TargetRelative>(28, 71, 71));

}  // namespace

std::span<const MessageInfo> KnownMessages() { return kTable; }

const MessageInfo* FindMessage(std::uint32_t id) {
  const auto* found = std::lower_bound(
      kTable.begin(), kTable.end(), id,
      [](const MessageInfo& info, std::uint32_t wanted) { return info.id < wanted; });
  return found != kTable.end() && found->id == id ? found : nullptr;
}

}  // namespace kestrel::mavlink

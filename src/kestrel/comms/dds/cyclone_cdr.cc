// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/dds/cyclone_cdr.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/version.h>
#include <string>
#if DDS_VERSION_MAJOR == 0
#include <dds/ddsi/ddsi_cdrstream.h>
#endif

namespace kestrel {
namespace {

constexpr std::size_t kEncapsulation = 4;  // bytes before the data

// Returns the bytes as sent: Cyclone pads them to four bytes, and stores the padding in the fourth.
std::string BytesOf(const ddsi_serdata& message) {
  constexpr std::size_t kOptions = 3;
  std::string bytes(ddsi_serdata_size(&message), '\0');
  ddsi_serdata_to_ser(&message, 0, bytes.size(), bytes.data());
  bytes.resize(bytes.size() - static_cast<std::size_t>(bytes[kOptions] & 3));
  bytes[kOptions] = 0;
  return bytes;
}

#if DDS_VERSION_MAJOR == 0

// A message in the form in which Cyclone takes it. Only since version 11 it takes bytes.
class CdrSample {
 public:
  explicit CdrSample(const dds_topic_descriptor_t& type)
      : type_(type), memory_(std::calloc(1, type.m_size)) {}
  ~CdrSample() {
    dds_stream_free_sample(memory_, type_.m_ops);
    std::free(memory_);
  }
  CdrSample(const CdrSample&) = delete;
  CdrSample& operator=(const CdrSample&) = delete;

  // False when the bytes are not of the type.
  bool Read(std::string_view bytes) {
    constexpr std::uint32_t kXcdrVersion = 1;
    if (bytes.size() < kEncapsulation) return false;
    std::string data(bytes.substr(kEncapsulation));
    const auto size = static_cast<std::uint32_t>(data.size());
    std::uint32_t used = 0;
    const bool is_whole = dds_stream_normalize_data(data.data(), &used, size, /*bswap=*/false,
                                                    kXcdrVersion, type_.m_ops) != nullptr;
    if (!is_whole || used != size) return false;
    dds_istream_t stream;
    dds_istream_init(&stream, size, data.data(), kXcdrVersion);
    dds_stream_read(&stream, static_cast<char*>(memory_), type_.m_ops);
    return true;
  }

  const void* get() const { return memory_; }

 private:
  const dds_topic_descriptor_t& type_;
  void* memory_;
};

#endif

}  // namespace

#if DDS_VERSION_MAJOR == 0

bool WriteCdr(dds_entity_t writer, const dds_topic_descriptor_t& type, std::string_view bytes) {
  CdrSample sample(type);
  return sample.Read(bytes) && dds_write(writer, sample.get()) >= 0;
}

#else

// Cyclone keeps what follows a message in the bytes; the sample of the message has it no more.
bool WriteCdr(dds_entity_t writer, const dds_topic_descriptor_t& type, std::string_view bytes) {
  const ddsi_sertype* own_type = nullptr;
  if (bytes.size() < kEncapsulation || dds_get_entity_sertype(writer, &own_type) < 0) return false;
  std::string copy(bytes);
  const ddsrt_iovec_t part{copy.data(), copy.size()};
  ddsi_serdata* const given = ddsi_serdata_from_ser_iov(own_type, SDK_DATA, 1, &part, copy.size());
  if (given == nullptr) return false;
  void* const sample = dds_alloc(type.m_size);
  const bool is_read = ddsi_serdata_to_sample(given, sample, nullptr, nullptr);
  ddsi_serdata_unref(given);
  ddsi_serdata* const message =
      is_read ? ddsi_serdata_from_sample(own_type, SDK_DATA, sample) : nullptr;
  dds_sample_free(sample, &type, DDS_FREE_ALL);
  if (message == nullptr) return false;
  if (BytesOf(*message).size() == bytes.size()) return dds_writecdr(writer, message) >= 0;
  ddsi_serdata_unref(message);
  return false;
}

#endif

void TakeCdr(dds_entity_t reader, const std::function<void(std::string_view bytes)>& take) {
  constexpr std::size_t kAtOnce = 16;
  std::array<ddsi_serdata*, kAtOnce> messages{};
  std::array<dds_sample_info_t, kAtOnce> infos{};
  const int count = dds_takecdr(reader, messages.data(), kAtOnce, infos.data(), DDS_ANY_STATE);
  for (int i = 0; i < count; ++i) {
    if (infos[i].valid_data) take(BytesOf(*messages[i]));
    ddsi_serdata_unref(messages[i]);
  }
}

}  // namespace kestrel

// SPDX-License-Identifier: BSD-3-Clause
// Usage: fast_dds_peer. Receives and publishes by Fast DDS, in a domain that is free, messages that
// are only bytes to it; ends when stdin does. Commands on stdin, one per line:
//
//   read TOPIC TYPE QOS         listens; QOS: best_effort, reliable or kept
//   write TOPIC TYPE QOS SIZE   publishes the SIZE bytes that follow the line
//
// Output on stdout, one line each, with SIZE bytes after it:
//
//   domain NUMBER SIZE                 and the CYCLONEDDS_URI with which others join it
//   participant GID - - SIZE           a participant, and its user data; GID: hexadecimal
//   reader|writer GID TOPIC TYPE SIZE  the same for an endpoint
//   message TOPIC SIZE                 a received message
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <poll.h>
#include <sstream>
#include <string>
#include <unistd.h>

#include "kestrel/comms/dds/test_dds.h"
#include "kestrel/comms/dds/test_fast_dds.h"

namespace kestrel {
namespace {

void Print(const std::string& words, const std::string& bytes) {
  std::printf("%s %zu\n", words.c_str(), bytes.size());
  std::fwrite(bytes.data(), 1, bytes.size(), stdout);
  std::fflush(stdout);
}

std::string Hexadecimal(const std::string& bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) text += {kDigits[byte >> 4], kDigits[byte & 15]};
  return text;
}

FastQos QosOf(const std::string& name) {
  return {.is_reliable = name != "best_effort", .is_kept = name == "kept"};
}

class Peer {
 public:
  explicit Peer(int domain) : participant_(domain) {}

  // Executes the complete commands; the rest is left in 'input'.
  void Obey(std::string* input) {
    for (std::size_t end; (end = input->find('\n')) != std::string::npos;) {
      std::istringstream line(input->substr(0, end));
      std::string verb, topic, type, qos;
      std::size_t size = 0;
      line >> verb >> topic >> type >> qos >> size;
      if (input->size() < end + 1 + size) return;
      std::string bytes = input->substr(end + 1, size);
      input->erase(0, end + 1 + size);
      if (verb == "read") {
        readers_[topic] = participant_.Read(topic, type, QosOf(qos));
      } else {
        fast::DataWriter*& writer = writers_[topic];
        if (writer == nullptr) writer = participant_.Write(topic, type, QosOf(qos));
        writer->write(&bytes);
      }
    }
  }

  void Report() {
    const std::vector<FastEntity> others = participant_.others().heard();
    for (; reported_ < others.size(); ++reported_) {
      const FastEntity& other = others[reported_];
      const std::string gid = Hexadecimal(other.gid);
      if (other.topic.empty()) {
        Print("participant " + gid + " - -", other.user_data);
      } else {
        const std::string kind = other.is_writer ? "writer " : "reader ";
        Print(kind + gid + " " + other.topic + " " + other.type, other.user_data);
      }
    }
    std::string bytes;
    for (const auto& [topic, reader] : readers_) {
      while (TakeRaw(reader, &bytes)) Print("message " + topic, bytes);
    }
  }

 private:
  FastParticipant participant_;
  std::map<std::string, fast::DataReader*> readers_;
  std::map<std::string, fast::DataWriter*> writers_;
  std::size_t reported_ = 0;
};

int Run() {
  const int domain = TestDomain();
  Peer peer(domain);
  Print("domain " + std::to_string(domain), std::getenv("CYCLONEDDS_URI"));
  constexpr int kPause_ms = 2;
  std::string input;
  for (;;) {
    pollfd wait{STDIN_FILENO, POLLIN, 0};
    if (poll(&wait, 1, kPause_ms) > 0) {
      char bytes[1 << 16];
      const ssize_t count = read(STDIN_FILENO, bytes, sizeof(bytes));
      if (count <= 0) return 0;
      input.append(bytes, static_cast<std::size_t>(count));
      peer.Obey(&input);
    }
    peer.Report();
  }
}

}  // namespace
}  // namespace kestrel

int main() { return kestrel::Run(); }

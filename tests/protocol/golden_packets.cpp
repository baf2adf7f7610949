#include "tests/protocol/golden_packets.hpp"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <string_view>

namespace tweend::protocol {
namespace {

std::string path_of(const std::string& name) { return std::string(TWEEND_PROTOCOL_GOLDEN) + "/" + name; }

/// Numbers as this machine has them, which the wire's are too wherever the tests run.
class Reader {
 public:
  explicit Reader(std::span<const char> bytes) : rest_(bytes) {}

  [[nodiscard]] std::uint32_t number() {
    std::uint32_t value = 0;
    copy(&value, sizeof value);
    return value;
  }
  template <class T>
  [[nodiscard]] std::vector<T> array(std::size_t size) {
    std::vector<T> values(size);
    copy(values.data(), size * sizeof(T));
    return values;
  }

 private:
  void copy(void* to, std::size_t size) {
    if (size == 0 || size > rest_.size()) return;
    std::memcpy(to, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }
  std::span<const char> rest_;
};

class Writer {
 public:
  explicit Writer(const std::string& path) : out_(path, std::ios::binary) {}

  void number(std::size_t value) {
    const auto as_u32 = static_cast<std::uint32_t>(value);
    out_.write(reinterpret_cast<const char*>(&as_u32), sizeof as_u32);
  }
  template <class T>
  void array(const std::vector<T>& values) {
    out_.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
  }

 private:
  std::ofstream out_;
};

}  // namespace

GoldenFile read_golden(const std::string& name) {
  std::ifstream in(path_of(name), std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  Reader reader(bytes);
  GoldenFile file;
  file.elements = reader.number();
  file.weights = reader.number();
  file.packets.resize(reader.number());
  for (GoldenPacket& packet : file.packets) {
    const std::uint32_t flags = reader.number();
    packet.asked = (flags & 1U) != 0;
    packet.key = (flags & 2U) != 0;
    const std::uint32_t payload_bytes = reader.number();
    const std::uint32_t floats = reader.number();
    packet.payload = reader.array<std::byte>(payload_bytes);
    packet.in = reader.array<float>(floats);
    packet.out = reader.array<float>(floats);
  }
  return file;
}

void write_golden(const std::string& name, const GoldenFile& file) {
  Writer writer(path_of(name));
  writer.number(file.elements);
  writer.number(file.weights);
  writer.number(file.packets.size());
  for (const GoldenPacket& packet : file.packets) {
    writer.number((packet.asked ? 1U : 0U) | (packet.key ? 2U : 0U));
    writer.number(packet.payload.size());
    writer.number(packet.in.size());
    writer.array(packet.payload);
    writer.array(packet.in);
    writer.array(packet.out);
  }
}

bool updates_golden() {
  const char* const update = std::getenv("TWEEND_UPDATE_GOLDEN");
  return update != nullptr && std::string_view(update) == "1";
}

}  // namespace tweend::protocol

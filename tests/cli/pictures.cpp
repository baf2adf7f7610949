#include "tests/cli/pictures.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include "protocol/base64.hpp"

namespace tweend::cli::test {

std::string png() {
  const auto bytes = protocol::decode_base64(kPngBase64);
  return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

std::string jpeg() { return "\xFF\xD8\xFF\xE0 a picture"; }

std::string frame_packet(std::uint32_t sequence, std::uint8_t encoding, const std::string& picture) {
  protocol::PacketHeader header;
  header.kind = protocol::PacketKind::Frame;
  header.encoding = encoding;
  header.flags = protocol::kFlagKey;
  header.stream = 4;
  header.sequence = sequence;
  header.media_us = 1'250'000;
  header.server_us = 77;
  header.revision = 9;
  return raw_packet(header, picture);
}

std::vector<Reaction> frame_stream(Json params, const std::string& packets, bool closes) {
  std::vector<Reaction> script(4, answers("server.ping", Json::object(), {{"time_us", 5}}));
  params["kind"] = "frames";
  if (!params.contains("encoding")) params["encoding"] = "jpeg";
  const Json opened{{"stream", 4}, {"layout", {{"width", 640}, {"height", 360}, {"codec", nullptr}}}};
  script.push_back({"stream.open", params, answer(opened) + packets, closes});
  return script;
}

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "tweenctl_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder");
  root_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(root_, ignored);
}

std::string Folder::path(const std::string& name) const { return root_ + "/" + name; }

std::string Folder::read(const std::string& name) const {
  std::ifstream file(path(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string Folder::list(const std::string& name) const {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path(name))) names.insert(entry.path().filename().string());
  std::string text;
  for (const auto& each : names) text += each + ",";
  return text;
}

}  // namespace tweend::cli::test

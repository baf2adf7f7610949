#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/envelope.hpp"
#include "protocol/packet.hpp"
#include "protocol/type_info.hpp"
#include "protocol/utf8.hpp"

namespace tweend::protocol {

enum class Mode : std::uint8_t { Step, Linear };
template <>
struct EnumNames<Mode> {
  static constexpr std::array<std::string_view, 2> kNames{"step", "linear"};
};

}  // namespace tweend::protocol

namespace {

using namespace tweend::protocol;

constexpr std::size_t kDepth = 16;
constexpr std::size_t kBatch = 64;

void require(bool holds) {
  if (!holds) std::abort();
}

struct Turn {
  static constexpr std::string_view kName = "Turn";
  std::optional<glm::quat> rotation;
  std::optional<glm::vec3> translation;
  static void describe(FieldList<Turn>& f) {
    f.add<&Turn::rotation>("rotation", "Of a joint.");
    f.add<&Turn::translation>("translation", "Of a joint.");
  }
};

/// One parameter of each kind, all optional.
struct Everything {
  static constexpr std::string_view kName = "Everything";
  std::optional<bool> flag;
  std::optional<std::int64_t> integer;
  std::optional<std::uint64_t> count;
  std::optional<double> time;
  std::optional<float> near;
  std::optional<std::string> text;
  std::optional<Name> name;
  std::optional<std::array<double, 4>> easing;
  std::optional<std::vector<float>> positions;
  std::optional<std::vector<std::uint32_t>> indices;
  std::optional<Base64Floats> positions_base64;
  std::optional<Base64Indices> indices_base64;
  std::optional<Turn> turn;
  std::optional<std::vector<Turn>> turns;
  std::optional<std::vector<std::string>> texts;
  std::optional<JsonValue> later;
  Nullable<Mode> mode;
  static void describe(FieldList<Everything>& f) {
    using T = Everything;
    f.add<&T::flag>("flag", "A flag.");
    f.add<&T::integer>("integer", "An integer.");
    f.add<&T::count>("count", "A count.");
    f.add<&T::time>("time", "A time.", kNotNegative);
    f.add<&T::near>("near", "A distance.", kPositive);
    f.add<&T::text>("text", "A text.");
    f.add<&T::name>("name", "A name.");
    f.add<&T::easing>("easing", "Four numbers.");
    f.add<&T::positions>("positions", "Floats.");
    f.add<&T::indices>("indices", "Indices.");
    f.add<&T::positions_base64>("positions_base64", "Floats.");
    f.add<&T::indices_base64>("indices_base64", "Indices.");
    f.add<&T::turn>("turn", "A part.");
    f.add<&T::turns>("turns", "Parts.");
    f.add<&T::texts>("texts", "Texts.");
    f.add<&T::later>("later", "An object.");
    f.add<&T::mode>("mode", "A mode, or null.");
  }
};

tweend::Limits small_limits() {
  tweend::Limits limits;
  limits.json_depth = kDepth;
  limits.batch_requests = kBatch;
  return limits;
}

/// What decoding promises of the values it lets in.
void check(const Everything& e) {
  if (e.time) require(std::isfinite(*e.time) && *e.time >= 0.0);
  if (e.near) require(std::isfinite(*e.near) && *e.near > 0.0F);
  if (e.text) require(is_utf8(*e.text));
  if (e.name) require(!e.name->text.empty() && e.name->text.size() <= 64 && e.name->text[0] != '.');
  if (e.positions) {
    for (const float v : *e.positions) require(std::isfinite(v));
  }
  if (e.turn && e.turn->rotation) {
    const glm::quat& q = *e.turn->rotation;
    require(std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1.0F) < 1e-5F);
  }
}

/// What was decoded is encoded to valid JSON, which decodes again: to the same, once numbers have been through it.
void check_round_trip(Everything e) {
  e.later.reset();  // parameters only: encoded as an empty object
  e.turn.reset();   // normalising again may move the last place
  e.turns.reset();
  e.positions_base64.reset();  // may hold what no JSON number is
  std::string before;
  for (int round = 0; round < 3; ++round) {
    const std::string text = encode(e);
    require(is_utf8(text));
    const auto value = JsonValue::parse(text, tweend::Limits());
    require(value.has_value());
    auto again = decode<Everything>(*value);
    require(again.has_value());
    if (round == 2) require(text == before);  // -0.0 becomes -0 and then 0
    before = text;
    e = std::move(*again);
  }
}

void check_answer(std::string_view id, const tweend::Error& error) {
  require(!error.message.empty());
  if (id.empty()) return;  // a notification
  const std::string answer = answer_json(id, error);
  require(is_utf8(answer));
  require(JsonValue::parse(answer, tweend::Limits()).has_value());
}

void check_request(const Request& request) {
  if (!request.id.empty()) {
    require(JsonValue::parse(answer_json(request.id, "{}"), tweend::Limits()).has_value());
  }
  const auto decoded = decode<Everything>(request.params);
  if (!decoded) {
    require(decoded.error().path.starts_with("params"));
    check_answer(request.id, decoded.error());
    return;
  }
  check(*decoded);
  check_round_trip(*decoded);
  if (decoded->later) {
    const auto inner = decode<Everything>(*decoded->later, "params.later");
    if (inner) check(*inner);
  }
}

void check_packet(const std::uint8_t* data, std::size_t size) {
  if (size < kPacketHeaderBytes) return;
  PacketHeaderBytes bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::byte{data[i]};
  const auto header = decode_header(bytes);
  if (header) require(encode_header(*header) == bytes);
}

}  // namespace

/// A message of a client, as the network hands it over, or the header of a packet.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check_packet(data, size);
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (!is_utf8(text)) return 0;  // refused before it is parsed
  const Message message = parse_message(text, small_limits());
  require(!message.items.empty() && message.items.size() <= kBatch);
  require(message.batch || message.items.size() == 1);
  for (const auto& item : message.items) {
    if (const auto* rejected = std::get_if<Rejected>(&item)) {
      check_answer(rejected->id, rejected->error);
    } else {
      check_request(std::get<Request>(item));
    }
  }
  return 0;
}

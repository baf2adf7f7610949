#include "server/assets/gltf_accessors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace tweend::assets {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF's numbers are read as they lie");

constexpr std::size_t kMostElements = std::size_t{1} << 32U;
constexpr std::size_t kMostBytes = std::size_t{1} << 48U;

struct TypeName {
  std::string_view name;
  std::size_t width;
};
constexpr std::array<TypeName, 7> kTypes{
    {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};

struct ComponentName {
  std::string_view name;
  GltfComponent component;
  std::size_t bytes;
};
constexpr std::array<ComponentName, 6> kComponents{{{"BYTE", GltfComponent::I8, 1},
                                                    {"UNSIGNED_BYTE", GltfComponent::U8, 1},
                                                    {"SHORT", GltfComponent::I16, 2},
                                                    {"UNSIGNED_SHORT", GltfComponent::U16, 2},
                                                    {"UNSIGNED_INT", GltfComponent::U32, 4},
                                                    {"FLOAT", GltfComponent::F32, 4}}};

const ComponentName& entry_of(GltfComponent component) noexcept {
  return *std::find_if(kComponents.begin(), kComponents.end(), [&](const auto& c) { return c.component == component; });
}

std::string name_of(const GltfNumber& number) {
  return std::string(number.normalized ? "normalized " : "") + std::string(entry_of(number.component).name);
}

std::string names_of(std::span<const GltfNumber> numbers) {
  std::string list;
  for (std::size_t i = 0; i < numbers.size(); ++i) list += (i == 0 ? "" : " or ") + name_of(numbers[i]);
  return list;
}

Result<GltfComponent> read_component(const JsonNode& holder) {
  TWEEND_ASSIGN(const JsonNode node, holder.get("componentType"));
  TWEEND_ASSIGN(const double number, node.number());
  for (const ComponentName& c : kComponents) {
    if (number == static_cast<double>(c.component)) return c.component;
  }
  return node.expected("a component type: 5120, 5121, 5122, 5123, 5125 or 5126");
}

template <class T>
T load(const std::byte* at) noexcept {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// glTF 2.0, section 3.11: a normalized number c stands for c / max, a signed one's smallest for -1.
template <class T>
void convert(std::span<const std::byte> bytes, bool normalized, std::vector<float>& out) {
  constexpr auto kLargest = static_cast<float>(std::numeric_limits<T>::max());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto value = static_cast<float>(load<T>(&bytes[i * sizeof(T)]));
    out[i] = normalized ? std::max(value / kLargest, -1.0F) : value;
  }
}

template <class T>
void widen(std::span<const std::byte> bytes, std::vector<std::uint32_t>& out) {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = load<T>(&bytes[i * sizeof(T)]);
}

}  // namespace

std::size_t size_of(GltfComponent component) noexcept { return entry_of(component).bytes; }

std::size_t GltfAccessor::element_bytes() const noexcept { return width * size_of(number.component); }

Result<GltfAccessor> GltfAccessors::describe(const JsonNode& reference, const GltfAccessorRule& rule) const {
  TWEEND_ASSIGN(const JsonNode node, file_.refer(reference, "accessors"));
  GltfAccessor accessor{node, rule.type, 1, 0, {}};
  TWEEND_ASSIGN(const JsonNode type, node.get("type"));
  TWEEND_ASSIGN(const std::string_view type_text, type.text());
  if (type_text != rule.type) return type.expected(fmt::format("{} for {}", rule.type, reference.pointer()));
  accessor.width = std::find_if(kTypes.begin(), kTypes.end(), [&](const TypeName& t) { return t.name == rule.type; })->width;
  TWEEND_ASSIGN(accessor.number.component, read_component(node));
  TWEEND_ASSIGN(accessor.number.normalized, node.boolean_or("normalized", false));
  if (std::find(rule.numbers.begin(), rule.numbers.end(), accessor.number) == rule.numbers.end()) {
    return node.error(fmt::format("expected the componentType {} for {}, found {}", names_of(rule.numbers), reference.pointer(),
                                  name_of(accessor.number)));
  }
  TWEEND_ASSIGN(const JsonNode count, node.get("count"));
  TWEEND_ASSIGN(accessor.count, count.whole(1, kMostElements));
  return accessor;
}

Result<bool> GltfAccessors::has_type(const JsonNode& reference, std::string_view type) const {
  TWEEND_ASSIGN(const JsonNode node, file_.refer(reference, "accessors"));
  TWEEND_ASSIGN(const JsonNode own, node.get("type"));
  TWEEND_ASSIGN(const std::string_view text, own.text());
  return text == type;
}

Result<GltfAccessors::Run> GltfAccessors::locate(const JsonNode& node, const JsonNode& count_node, std::size_t count,
                                                 GltfComponent component, std::size_t bytes) {
  TWEEND_ASSIGN(const JsonNode reference, node.get("bufferView"));
  TWEEND_ASSIGN(const GltfView view, buffers_.view(reference));
  TWEEND_ASSIGN(const std::size_t offset, node.whole_or("byteOffset", 0, 0, kMostBytes));
  if (offset % size_of(component) != 0) {
    return node.error(fmt::format("expected a byteOffset that is a multiple of the {} bytes of a number, found {}",
                                  size_of(component), offset));
  }
  const std::size_t stride = view.stride == 0 ? bytes : view.stride;
  if (stride < bytes) {
    return node.error(fmt::format("expected at least the {} bytes of an element from one to the next, found a byteStride of {}",
                                  bytes, stride));
  }
  const std::size_t room = offset < view.bytes.size() ? view.bytes.size() - offset : 0;
  const std::size_t most = room < bytes ? 0 : (room - bytes) / stride + 1;
  if (count > most) {
    return count_node.error(fmt::format("expected at most {} elements of {} bytes in the {} bytes from byte {} of {}, found {}",
                                        most, bytes, room, offset, reference.pointer(), count));
  }
  return Run{view.bytes.subspan(offset), stride, count, bytes};
}

GltfAccessors::Bytes GltfAccessors::Run::gather() const {
  Bytes out(count * bytes);
  for (std::size_t i = 0; i < count; ++i) std::memcpy(&out[i * bytes], &from[i * stride], bytes);
  return out;
}

Status GltfAccessors::check_backed(const GltfAccessor& accessor) {
  if (!accessor.node.find("bufferView")) return {};
  TWEEND_ASSIGN(const JsonNode count, accessor.node.get("count"));
  TWEEND_TRY(locate(accessor.node, count, accessor.count, accessor.number.component, accessor.element_bytes()));
  return {};
}

Result<GltfAccessors::Bytes> GltfAccessors::dense(const GltfAccessor& accessor) {
  if (!accessor.node.find("bufferView")) return Bytes(accessor.count * accessor.element_bytes());
  TWEEND_ASSIGN(const JsonNode count, accessor.node.get("count"));
  TWEEND_ASSIGN(const Run run,
                locate(accessor.node, count, accessor.count, accessor.number.component, accessor.element_bytes()));
  return run.gather();
}

Status GltfAccessors::put_sparse(const GltfAccessor& accessor, const JsonNode& sparse, Bytes& elements) {
  TWEEND_ASSIGN(const JsonNode count_node, sparse.get("count"));
  TWEEND_ASSIGN(const std::size_t count, count_node.whole(1, accessor.count));
  TWEEND_ASSIGN(const JsonNode indices_node, sparse.get("indices"));
  TWEEND_ASSIGN(const JsonNode values_node, sparse.get("values"));
  TWEEND_ASSIGN(const GltfComponent component, read_component(indices_node));
  if (component != GltfComponent::U8 && component != GltfComponent::U16 && component != GltfComponent::U32) {
    return indices_node.error("expected indices of UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT, found " +
                              name_of({component, false}));
  }
  TWEEND_ASSIGN(const Run index_run, locate(indices_node, count_node, count, component, size_of(component)));
  const std::size_t bytes = accessor.element_bytes();
  TWEEND_ASSIGN(const Run value_run, locate(values_node, count_node, count, accessor.number.component, bytes));
  const Bytes index_bytes = index_run.gather();
  const Bytes values = value_run.gather();
  std::vector<std::uint32_t> indices(count);
  if (component == GltfComponent::U8) widen<std::uint8_t>(index_bytes, indices);
  if (component == GltfComponent::U16) widen<std::uint16_t>(index_bytes, indices);
  if (component == GltfComponent::U32) widen<std::uint32_t>(index_bytes, indices);
  for (std::size_t i = 0; i < count; ++i) {
    if (indices[i] >= accessor.count || (i > 0 && indices[i] <= indices[i - 1])) {
      return indices_node.error(
          fmt::format("expected ascending indices below {}, found {} at place {}", accessor.count, indices[i], i));
    }
    std::memcpy(&elements[indices[i] * bytes], &values[i * bytes], bytes);
  }
  return {};
}

Result<GltfAccessors::Bytes> GltfAccessors::elements(const GltfAccessor& accessor) {
  TWEEND_ASSIGN(Bytes bytes, dense(accessor));
  if (const auto sparse = accessor.node.find("sparse")) TWEEND_TRY(put_sparse(accessor, *sparse, bytes));
  return bytes;
}

Result<std::vector<float>> GltfAccessors::floats(const GltfAccessor& accessor) {
  TWEEND_ASSIGN(const Bytes bytes, elements(accessor));
  std::vector<float> out(accessor.count * accessor.width);
  const bool normalized = accessor.number.normalized;
  switch (accessor.number.component) {
    case GltfComponent::I8:
      convert<std::int8_t>(bytes, normalized, out);
      break;
    case GltfComponent::U8:
      convert<std::uint8_t>(bytes, normalized, out);
      break;
    case GltfComponent::I16:
      convert<std::int16_t>(bytes, normalized, out);
      break;
    case GltfComponent::U16:
      convert<std::uint16_t>(bytes, normalized, out);
      break;
    case GltfComponent::U32:
      convert<std::uint32_t>(bytes, normalized, out);
      break;
    case GltfComponent::F32:
      std::memcpy(out.data(), bytes.data(), bytes.size());
      break;
  }
  const auto bad = std::find_if(out.begin(), out.end(), [](float v) { return !std::isfinite(v); });
  if (bad == out.end()) return out;
  const auto at = static_cast<std::size_t>(bad - out.begin());
  return accessor.node.error(fmt::format("expected finite numbers, found {} in element {}", *bad, at / accessor.width));
}

Result<std::vector<std::uint32_t>> GltfAccessors::wholes(const GltfAccessor& accessor) {
  TWEEND_ASSIGN(const Bytes bytes, elements(accessor));
  std::vector<std::uint32_t> out(accessor.count * accessor.width);
  if (accessor.number.component == GltfComponent::U8) {
    widen<std::uint8_t>(bytes, out);
  } else if (accessor.number.component == GltfComponent::U16) {
    widen<std::uint16_t>(bytes, out);
  } else {
    widen<std::uint32_t>(bytes, out);
  }
  return out;
}

}  // namespace tweend::assets

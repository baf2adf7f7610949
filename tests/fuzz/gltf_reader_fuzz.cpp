#include "server/assets/gltf_reader.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "server/model/model_blob.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// What every reader of a model takes for granted.
void check(const tweend::model::ImportedModel& m, const tweend::Limits& limits) {
  require(m.model->skeleton && m.model->joint_count() <= limits.joints_per_actor);
  require(m.model->vertex_count() <= limits.vertices_per_actor);
  require((m.model->mesh == nullptr) == (m.model->rest == nullptr));
  require(!m.clips.empty());
  for (const auto& clip : m.clips) {
    require(clip.times_s.size() == clip.keyframes.size());
    for (std::size_t i = 0; i < clip.times_s.size(); ++i) {
      require(std::isfinite(clip.times_s[i]) && (i == 0 || clip.times_s[i] > clip.times_s[i - 1]));
      for (const auto& value : clip.keyframes[i].pose->values()) {
        const bool weight = value.channel.property == tweend::animation::Property::Weight;
        require(value.channel.target < (weight ? m.model->weight_count() : m.model->joint_count()));
      }
    }
  }
}

}  // namespace

/// A glTF file, binary or text, is read or refused; what is read survives the model blob.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tweend::Limits limits;
  limits.vertices_per_actor = 10'000;
  limits.triangles_per_actor = 20'000;
  limits.morphed_vertices = 20'000;
  limits.keyed_values = 20'000;
  limits.asset_bytes = 1U << 20U;
  limits.texture_pixels = 64 * 64;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto no_file = [](std::string_view, std::size_t) -> tweend::Result<std::string> {
    return tweend::fail(tweend::ErrorCode::NotFound, "there is none");
  };
  const auto imported = tweend::assets::read_gltf(bytes, "fuzz.glb", no_file, 0, limits);
  if (!imported) {
    require(imported.error().message.find("\"fuzz.glb\"") == 0);
    return 0;
  }
  check(*imported, limits);
  const auto again = tweend::model::read_model_blob(tweend::model::write_model_blob(*imported).bytes);
  require(again.has_value());
  check(*again, limits);
  return 0;
}

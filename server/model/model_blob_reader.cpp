#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "server/model/blob_bytes.hpp"
#include "server/model/model_blob.hpp"
#include "server/model/model_blob_form.hpp"

namespace tweend::model {
namespace {

// The fewest bytes that each may take, by the writer.
constexpr std::size_t kTextBytes = 8;
constexpr std::size_t kImageBytes = 16;
constexpr std::size_t kMaterialBytes = 39;
constexpr std::size_t kPartBytes = 12;
constexpr std::size_t kJointBytes = 52;
constexpr std::size_t kEntryBytes = 52;
constexpr std::size_t kTargetBytes = 44;
constexpr std::size_t kModeBytes = 6;
constexpr std::size_t kValueBytes = 21;
constexpr std::size_t kClipBytes = 29;

constexpr std::uint8_t kInterpolations = 4;
constexpr std::uint8_t kProperties = 4;
constexpr std::uint8_t kWraps = 3;
constexpr std::uint8_t kClipTypes = 3;

Error damaged(std::string_view why) {
  return fail(ErrorCode::BadAsset, fmt::format("expected an imported model, found bytes that are none: {}", why));
}

/// A factory's refusal is a damaged blob, whatever it calls it.
template <class T>
Result<T> sound(Result<T> made) {
  if (!made) return damaged(made.error().message);
  return made;
}

class ModelReader {
 public:
  explicit ModelReader(std::string_view bytes) : r_(bytes) {}

  Result<ImportedModel> read() {
    ImportedModel imported;
    imported.source = r_.take_text();
    TWEEND_ASSIGN(imported.model, read_model());
    const std::size_t clips = r_.take_count(kClipBytes);
    for (std::size_t i = 0; i < clips; ++i) {
      TWEEND_ASSIGN(Clip clip, read_clip(*imported.model));
      imported.clips.push_back(std::move(clip));
    }
    const std::size_t warnings = r_.take_count(kTextBytes);
    for (std::size_t i = 0; i < warnings; ++i) imported.warnings.push_back(r_.take_text());
    if (!r_.ok()) return damaged("they end early, or name what isn't there");
    if (r_.left() > 0) return damaged("there are more of them");
    return imported;
  }

 private:
  template <class Vector>
  Vector take_numbers(glm::length_t count) {
    Vector v(0.0F);
    for (glm::length_t i = 0; i < count; ++i) {
      v[i] = r_.take<float>();
      if (!std::isfinite(v[i])) r_.spoil();
    }
    return v;
  }
  float take_finite() {
    const auto value = r_.take<float>();
    if (!std::isfinite(value)) r_.spoil();
    return value;
  }
  double take_finite_double() {
    const auto value = r_.take<double>();
    if (!std::isfinite(value)) r_.spoil();
    return value;
  }
  [[nodiscard]] Status still_ok() const {
    if (r_.ok()) return {};
    return damaged("they end early, or name what isn't there");
  }

  Result<ModelPtr> read_model() {
    const bool has_mesh = r_.take_bool(), has_skeleton = r_.take_bool(), has_skin = r_.take_bool(), has_morphs = r_.take_bool();
    Model model;
    if (has_mesh) {
      TWEEND_ASSIGN(model.mesh, read_mesh());
    }
    TWEEND_ASSIGN(model.rest, read_vertices(model));
    if (has_skeleton) {
      TWEEND_ASSIGN(model.skeleton, read_skeleton());
    }
    if (has_skin) {
      TWEEND_ASSIGN(model.skin, read_skin(model));
    }
    if (has_morphs) {
      TWEEND_ASSIGN(model.morphs, read_morphs(model));
    }
    if (!model.mesh && !model.skeleton) return damaged("they hold neither a mesh nor a skeleton");
    return std::make_shared<const Model>(std::move(model));
  }

  Result<MeshPtr> read_mesh() {
    const auto vertices = r_.take<std::uint64_t>();
    std::vector<std::uint32_t> indices = r_.take_run<std::uint32_t>();
    std::vector<float> texcoords = r_.take_run<float>();
    std::vector<float> colors = r_.take_run<float>();
    TWEEND_ASSIGN(Surface surface, read_surface());
    TWEEND_TRY(still_ok());
    const auto finite = [](float v) { return std::isfinite(v); };
    if (!std::all_of(texcoords.begin(), texcoords.end(), finite) || !std::all_of(colors.begin(), colors.end(), finite)) {
      return damaged("a texture coordinate or colour is not finite");
    }
    if (vertices > (std::uint64_t{1} << 32U)) return damaged("they count too many vertices");
    return sound(Mesh::make(static_cast<std::size_t>(vertices), std::move(indices), std::move(texcoords), std::move(surface),
                            std::move(colors)));
  }

  Result<Surface> read_surface() {
    std::vector<ImagePtr> images;
    const std::size_t image_count = r_.take_count(kImageBytes);
    for (std::size_t i = 0; i < image_count; ++i) {
      const auto width = r_.take<std::uint32_t>();
      const auto height = r_.take<std::uint32_t>();
      TWEEND_ASSIGN(ImagePtr image, sound(Image::make(width, height, r_.take_run<std::uint8_t>())));
      images.push_back(std::move(image));
    }
    Surface surface;
    const std::size_t materials = r_.take_count(kMaterialBytes);
    for (std::size_t i = 0; i < materials; ++i) surface.materials.push_back(read_material(images));
    const std::size_t parts = r_.take_count(kPartBytes);
    for (std::size_t i = 0; i < parts; ++i) {
      const auto first = r_.take<std::uint32_t>();
      const auto count = r_.take<std::uint32_t>();
      surface.parts.push_back({first, count, r_.take<std::uint32_t>()});
    }
    return surface;
  }

  Material read_material(const std::vector<ImagePtr>& images) {
    Material m;
    m.name = r_.take_text();
    m.base_color = take_numbers<glm::vec3>(3);
    const auto image = r_.take<std::uint32_t>();
    if (image < images.size()) {
      m.base_color_texture = images[image];
    } else if (image != kNoNumber) {
      r_.spoil();
    }
    m.wrap_u = static_cast<TextureWrap>(r_.take_below<std::uint8_t>(kWraps));
    m.wrap_v = static_cast<TextureWrap>(r_.take_below<std::uint8_t>(kWraps));
    m.alpha = take_finite();
    const bool cut = r_.take_bool();
    const float cutoff = take_finite();
    if (cut) m.alpha_cutoff = cutoff;
    m.unlit = r_.take_bool();
    return m;
  }

  /// All that the rest and the keyframes show; those of the rest.
  Result<VertexKeyPtr> read_vertices(const Model& model) {
    const std::size_t count = r_.take_count(kTextBytes);
    if (count > 0 && !model.mesh) return damaged("they hold vertices without a mesh");
    for (std::size_t i = 0; i < count; ++i) {
      TWEEND_ASSIGN(VertexKeyPtr key, sound(VertexKey::from_block(*model.mesh, r_.take_run<float>())));
      vertices_.push_back(std::move(key));
    }
    const VertexKeyPtr rest = take_vertices();
    TWEEND_TRY(still_ok());
    if ((rest != nullptr) != (model.mesh != nullptr)) return damaged("mesh and vertices don't go together");
    return rest;
  }

  VertexKeyPtr take_vertices() {
    const auto number = r_.take<std::uint32_t>();
    if (number < vertices_.size()) return vertices_[number];
    if (number != kNoNumber) r_.spoil();
    return nullptr;
  }

  Result<SkeletonPtr> read_skeleton() {
    std::vector<Joint> joints(r_.take_count(kJointBytes));
    for (Joint& joint : joints) {
      joint.name = r_.take_text();
      joint.parent = r_.take<std::int32_t>();
      joint.rest.translation = take_numbers<glm::vec3>(3);
      const auto q = take_numbers<glm::vec4>(4);
      joint.rest.rotation = glm::quat(q.w, q.x, q.y, q.z);
      joint.rest.scale = take_numbers<glm::vec3>(3);
    }
    TWEEND_TRY(still_ok());
    return sound(Skeleton::make(std::move(joints)));
  }

  Result<SkinPtr> read_skin(const Model& model) {
    if (!model.rest || !model.skeleton) return damaged("they hold a skin without a mesh or a skeleton");
    std::vector<SkinEntry> entries(r_.take_count(kEntryBytes));
    for (SkinEntry& entry : entries) {
      entry.joint = r_.take_below(static_cast<std::uint32_t>(model.skeleton->size()));
      for (glm::vec4& row : entry.joint_from_mesh.rows) row = take_numbers<glm::vec4>(4);
    }
    const auto per_vertex = r_.take<std::uint8_t>();
    std::vector<std::uint16_t> joints = r_.take_run<std::uint16_t>();
    std::vector<float> weights = r_.take_run<float>();
    TWEEND_TRY(still_ok());
    return sound(Skin::make(std::move(entries), per_vertex, std::move(joints), std::move(weights), model.rest->positions()));
  }

  Result<MorphTargetsPtr> read_morphs(const Model& model) {
    std::vector<MorphTarget> targets(r_.take_count(kTargetBytes));
    for (MorphTarget& t : targets) {
      t.name = r_.take_text();
      t.default_weight = r_.take<float>();
      t.first_vertex = static_cast<std::size_t>(r_.take<std::uint64_t>());
      t.positions = r_.take_run<float>();
      t.normals = r_.take_run<float>();
      t.tangents = r_.take_run<float>();
    }
    TWEEND_TRY(still_ok());
    return sound(MorphTargets::make(std::move(targets), model.vertex_count()));
  }

  animation::Channel take_channel(const Model& model) {
    animation::Channel channel;
    channel.target = r_.take<std::uint32_t>();
    channel.property = static_cast<animation::Property>(r_.take_below<std::uint8_t>(kProperties));
    const bool weight = channel.property == animation::Property::Weight;
    if (channel.target >= (weight ? model.weight_count() : model.joint_count())) r_.spoil();
    return channel;
  }

  std::optional<animation::Interpolation> take_interpolation() {
    const auto number = r_.take<std::uint8_t>();
    if (number == kNoInterpolation) return std::nullopt;
    if (number >= kInterpolations) r_.spoil();
    return static_cast<animation::Interpolation>(std::min<std::uint8_t>(number, kInterpolations - 1));
  }

  PoseKeyPtr read_pose(const Model& model) {
    std::vector<KeyedValue> values(r_.take_count(kValueBytes));
    for (KeyedValue& v : values) {
      v.channel = take_channel(model);
      v.value = take_numbers<glm::vec4>(4);
    }
    for (std::size_t i = 1; i < values.size(); ++i) {
      if (!(values[i - 1].channel < values[i].channel)) r_.spoil();
    }
    std::vector<KeyedTangents> tangents(r_.take_bool() ? values.size() : 0);
    for (KeyedTangents& t : tangents) {
      t.in = take_numbers<glm::vec4>(4);
      t.out = take_numbers<glm::vec4>(4);
    }
    return std::make_shared<const PoseKey>(std::move(values), std::move(tangents));
  }

  Keyframe read_keyframe(const Model& model) {
    Keyframe k;
    k.interpolation = take_interpolation();
    const bool eased = r_.take_bool();
    animation::CubicBezier e;
    for (double* number : {&e.x1, &e.y1, &e.x2, &e.y2}) *number = take_finite_double();
    if (eased) k.easing = e;
    k.vertices = take_vertices();
    if (r_.take_bool()) k.pose = read_pose(model);
    if ((k.vertices != nullptr) == (k.pose != nullptr)) r_.spoil();
    return k;
  }

  Result<Clip> read_clip(const Model& model) {
    Clip clip;
    clip.name = r_.take_text();
    clip.settings.closed = r_.take_bool();
    const bool has_duration = r_.take_bool();
    const double duration_s = take_finite_double();
    if (has_duration) clip.settings.duration_s = duration_s;
    clip.settings.interpolation = take_interpolation();
    clip.declared_type = static_cast<ClipType>(r_.take_below<std::uint8_t>(kClipTypes));
    if (r_.take_bool()) clip.channel_modes = read_modes(model);
    clip.times_s = r_.take_run<double>();
    TWEEND_TRY(still_ok());
    for (std::size_t i = 0; i < clip.times_s.size(); ++i) {
      const double least = i == 0 ? 0.0 : std::nextafter(clip.times_s[i - 1], INFINITY);
      if (!(clip.times_s[i] >= least) || !std::isfinite(clip.times_s[i])) return damaged("times of a clip do not ascend");
      clip.keyframes.push_back(read_keyframe(model));
      TWEEND_TRY(still_ok());
      if ((clip.keyframes.back().pose != nullptr) != (clip.keyframes.front().pose != nullptr)) {
        return damaged("a clip has keyframes of two kinds");
      }
    }
    return clip;
  }

  ChannelModesPtr read_modes(const Model& model) {
    auto modes = std::make_shared<std::vector<ChannelMode>>(r_.take_count(kModeBytes));
    for (std::size_t i = 0; i < modes->size(); ++i) {
      ChannelMode& mode = (*modes)[i];
      mode.channel = take_channel(model);
      mode.interpolation = static_cast<animation::Interpolation>(r_.take_below<std::uint8_t>(kInterpolations));
      if (i > 0 && !((*modes)[i - 1].channel < mode.channel)) r_.spoil();
    }
    return modes;
  }

  BlobReader r_;
  std::vector<VertexKeyPtr> vertices_;
};

}  // namespace

Result<ImportedModel> read_model_blob(std::string_view bytes) {
  BlobReader whole(bytes);
  if (whole.take<std::uint32_t>() != kBlobMagic || !whole.ok()) return damaged("they do not begin like one");
  if (const auto version = whole.take<std::uint32_t>(); version != kBlobVersion) {
    return damaged(fmt::format("they are of version {}, not {}", version, kBlobVersion));
  }
  const auto length = whole.take<std::uint64_t>();
  if (!whole.ok() || length != whole.left()) return damaged(fmt::format("their length should be {}", length));
  return ModelReader(bytes.substr(bytes.size() - whole.left())).read();
}

}  // namespace tweend::model

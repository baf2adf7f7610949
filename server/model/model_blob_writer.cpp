#include <unordered_map>

#include "server/model/blob_bytes.hpp"
#include "server/model/model_blob.hpp"
#include "server/model/model_blob_form.hpp"

namespace tweend::model {
namespace {

/// Numbers shared values in the order in which they come.
template <class T>
class Numbers {
 public:
  void add(const std::shared_ptr<const T>& value) {
    if (value && numbers_.try_emplace(value.get(), static_cast<std::uint32_t>(values_.size())).second) {
      values_.push_back(value.get());
    }
  }
  [[nodiscard]] std::uint32_t of(const std::shared_ptr<const T>& value) const {
    return value ? numbers_.at(value.get()) : kNoNumber;
  }
  [[nodiscard]] const std::vector<const T*>& values() const noexcept { return values_; }

 private:
  std::unordered_map<const T*, std::uint32_t> numbers_;
  std::vector<const T*> values_;
};

template <class Vector>
void put_numbers(BlobWriter& w, const Vector& v, glm::length_t count) {
  for (glm::length_t i = 0; i < count; ++i) w.put<float>(v[i]);
}

void put_surface(BlobWriter& w, const Surface& surface) {
  Numbers<Image> images;
  for (const Material& m : surface.materials) images.add(m.base_color_texture);
  w.put_count(images.values().size());
  for (const Image* image : images.values()) {
    w.put<std::uint32_t>(image->width());
    w.put<std::uint32_t>(image->height());
    w.put_run(image->rgba());
  }
  w.put_count(surface.materials.size());
  for (const Material& m : surface.materials) {
    w.put_text(m.name);
    put_numbers(w, m.base_color, 3);
    w.put<std::uint32_t>(images.of(m.base_color_texture));
    w.put<std::uint8_t>(static_cast<std::uint8_t>(m.wrap_u));
    w.put<std::uint8_t>(static_cast<std::uint8_t>(m.wrap_v));
    w.put<float>(m.alpha);
    w.put<std::uint8_t>(m.alpha_cutoff ? 1 : 0);
    w.put<float>(m.alpha_cutoff.value_or(0.0F));
    w.put<std::uint8_t>(m.unlit ? 1 : 0);
  }
  w.put_count(surface.parts.size());
  for (const MeshPart& p : surface.parts) {
    w.put<std::uint32_t>(p.first_index);
    w.put<std::uint32_t>(p.index_count);
    w.put<std::uint32_t>(p.material);
  }
}

void put_mesh(BlobWriter& w, const Mesh& mesh) {
  w.put<std::uint64_t>(mesh.vertex_count());
  w.put_run(mesh.indices());
  w.put_run(mesh.texcoords());
  w.put_run(mesh.colors());
  put_surface(w, mesh.surface());
}

void put_skeleton(BlobWriter& w, const Skeleton& skeleton) {
  w.put_count(skeleton.size());
  for (const Joint& joint : skeleton.joints()) {
    w.put_text(joint.name);
    w.put<std::int32_t>(joint.parent);
    put_numbers(w, joint.rest.translation, 3);
    put_numbers(w, glm::vec4(joint.rest.rotation.x, joint.rest.rotation.y, joint.rest.rotation.z, joint.rest.rotation.w), 4);
    put_numbers(w, joint.rest.scale, 3);
  }
}

void put_skin(BlobWriter& w, const Skin& skin) {
  w.put_count(skin.entries().size());
  for (const SkinEntry& entry : skin.entries()) {
    w.put<std::uint32_t>(entry.joint);
    for (const glm::vec4& row : entry.joint_from_mesh.rows) put_numbers(w, row, 4);
  }
  const animation::SkinInfluences influences = skin.influences();
  w.put<std::uint8_t>(static_cast<std::uint8_t>(influences.per_vertex));
  w.put_run(influences.entries);
  w.put_run(influences.weights);
}

void put_morphs(BlobWriter& w, const MorphTargets& morphs) {
  w.put_count(morphs.size());
  for (const MorphTarget& t : morphs.targets()) {
    w.put_text(t.name);
    w.put<float>(t.default_weight);
    w.put<std::uint64_t>(t.first_vertex);
    w.put_run(t.positions);
    w.put_run(t.normals);
    w.put_run(t.tangents);
  }
}

void put_channel(BlobWriter& w, const animation::Channel& channel) {
  w.put<std::uint32_t>(channel.target);
  w.put<std::uint8_t>(static_cast<std::uint8_t>(channel.property));
}

void put_interpolation(BlobWriter& w, const std::optional<animation::Interpolation>& interpolation) {
  w.put<std::uint8_t>(interpolation ? static_cast<std::uint8_t>(*interpolation) : kNoInterpolation);
}

void put_pose(BlobWriter& w, const PoseKey& pose) {
  w.put_count(pose.values().size());
  for (const KeyedValue& v : pose.values()) {
    put_channel(w, v.channel);
    put_numbers(w, v.value, 4);
  }
  w.put<std::uint8_t>(pose.tangents().empty() ? 0 : 1);
  for (const KeyedTangents& t : pose.tangents()) {
    put_numbers(w, t.in, 4);
    put_numbers(w, t.out, 4);
  }
}

void put_keyframe(BlobWriter& w, const Keyframe& k, const Numbers<VertexKey>& vertices) {
  put_interpolation(w, k.interpolation);
  w.put<std::uint8_t>(k.easing ? 1 : 0);
  const animation::CubicBezier e = k.easing.value_or(animation::CubicBezier{});
  for (const double number : {e.x1, e.y1, e.x2, e.y2}) w.put<double>(number);
  w.put<std::uint32_t>(vertices.of(k.vertices));
  w.put<std::uint8_t>(k.pose ? 1 : 0);
  if (k.pose) put_pose(w, *k.pose);
}

void put_clip(BlobWriter& w, const Clip& clip, const Numbers<VertexKey>& vertices) {
  w.put_text(clip.name);
  w.put<std::uint8_t>(clip.settings.closed ? 1 : 0);
  w.put<std::uint8_t>(clip.settings.duration_s ? 1 : 0);
  w.put<double>(clip.settings.duration_s.value_or(0.0));
  put_interpolation(w, clip.settings.interpolation);
  w.put<std::uint8_t>(static_cast<std::uint8_t>(clip.declared_type));
  w.put<std::uint8_t>(clip.channel_modes ? 1 : 0);
  if (clip.channel_modes) {
    w.put_count(clip.channel_modes->size());
    for (const ChannelMode& mode : *clip.channel_modes) {
      put_channel(w, mode.channel);
      w.put<std::uint8_t>(static_cast<std::uint8_t>(mode.interpolation));
    }
  }
  w.put_run(clip.times_s);
  for (const Keyframe& keyframe : clip.keyframes) put_keyframe(w, keyframe, vertices);
}

void put_model(BlobWriter& w, const Model& model, const Numbers<VertexKey>& vertices) {
  for (const bool there : {model.mesh != nullptr, model.skeleton != nullptr, model.skin != nullptr, model.morphs != nullptr}) {
    w.put<std::uint8_t>(there ? 1 : 0);
  }
  if (model.mesh) put_mesh(w, *model.mesh);
  w.put_count(vertices.values().size());
  for (const VertexKey* key : vertices.values()) w.put_run(key->block());
  w.put<std::uint32_t>(vertices.of(model.rest));
  if (model.skeleton) put_skeleton(w, *model.skeleton);
  if (model.skin) put_skin(w, *model.skin);
  if (model.morphs) put_morphs(w, *model.morphs);
}

}  // namespace

ModelBlob write_model_blob(const ImportedModel& imported) {
  Numbers<VertexKey> vertices;
  vertices.add(imported.model->rest);
  for (const Clip& clip : imported.clips) {
    for (const Keyframe& keyframe : clip.keyframes) vertices.add(keyframe.vertices);
  }
  BlobWriter w;
  w.put<std::uint32_t>(kBlobMagic);
  w.put<std::uint32_t>(kBlobVersion);
  w.put<std::uint64_t>(0);  // the length, once it is known
  const std::size_t content = w.size();
  w.put_text(imported.source);
  put_model(w, *imported.model, vertices);
  w.put_count(imported.clips.size());
  for (const Clip& clip : imported.clips) put_clip(w, clip, vertices);
  w.put_count(imported.warnings.size());
  for (const std::string& warning : imported.warnings) w.put_text(warning);
  w.put_at<std::uint64_t>(content - sizeof(std::uint64_t), w.size() - content);
  return {w.take()};
}

}  // namespace tweend::model

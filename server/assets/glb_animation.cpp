#include "server/assets/glb_animation.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tweend::assets {
namespace {

const char* blend_name(GlbBlend blend) {
  if (blend == GlbBlend::Step) return "STEP";
  return blend == GlbBlend::Linear ? "LINEAR" : "CUBICSPLINE";
}

const char* path_name(animation::Property property) {
  switch (property) {
    case animation::Property::Translation:
      return "translation";
    case animation::Property::Rotation:
      return "rotation";
    case animation::Property::Scale:
      return "scale";
    case animation::Property::Weight:
      return "weights";
  }
  return "";
}

GlbShape shape_of(animation::Property property) {
  if (property == animation::Property::Weight) return GlbShape::Scalar;
  return property == animation::Property::Rotation ? GlbShape::Vec4 : GlbShape::Vec3;
}

class AnimationWriter {
 public:
  explicit AnimationWriter(GlbDocument& document) : document_(document) {}

  void add(const GlbSamples& samples, std::size_t node, animation::Property property) {
    const std::size_t output = add_floats(document_, samples.values, shape_of(property), GlbUse::None, false);
    animation_.samplers.push_back({times(samples.times_s), output, blend_name(samples.blend)});
    animation_.channels.push_back({animation_.samplers.size() - 1, node, path_name(property)});
  }

  [[nodiscard]] GlbAnimation take() { return std::move(animation_); }

 private:
  std::size_t times(const std::vector<float>& times_s) {
    const auto known = times_.find(times_s);
    if (known != times_.end()) return known->second;
    return times_.emplace(times_s, add_floats(document_, times_s, GlbShape::Scalar, GlbUse::None, true)).first->second;
  }

  GlbDocument& document_;
  GlbAnimation animation_;
  std::map<std::vector<float>, std::size_t> times_;
};

}  // namespace

void add_animation(const std::string& name, const ClipSamples& samples, std::size_t mesh_node, GlbDocument& document) {
  if (samples.joints.empty() && !samples.weights) return;
  AnimationWriter writer(document);
  for (const JointSamples& j : samples.joints) writer.add(j.samples, j.joint, j.property);
  if (samples.weights) writer.add(*samples.weights, mesh_node, animation::Property::Weight);
  GlbAnimation animation = writer.take();
  animation.name = name;
  document.animations.push_back(std::move(animation));
}

}  // namespace tweend::assets

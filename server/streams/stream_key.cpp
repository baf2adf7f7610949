#include "server/streams/stream_key.hpp"

namespace tweend::streams {

bool same_but_view(const StreamKey& a, const StreamKey& b) {
  StreamKey c = b;
  c.rate = a.rate;
  if (auto* frames = std::get_if<FramesSpec>(&c.what)) {
    if (const auto* other = std::get_if<FramesSpec>(&a.what)) frames->camera = other->camera;
  }
  return a == c;
}

}  // namespace tweend::streams

#include "server/model/clip.hpp"

#include <algorithm>

namespace tweend::model {

double Clip::duration_s() const noexcept {
  if (settings.duration_s) return *settings.duration_s;
  if (times_s.empty()) return 0.0;
  if (!settings.closed) return times_s.back();
  // A single keyframe has no spacing of its own: it gets that of keyframes added without a time.
  const double spacing =
      times_s.size() < 2 ? 1.0 : (times_s.back() - times_s.front()) / static_cast<double>(times_s.size() - 1);
  return times_s.back() + spacing;
}

std::optional<std::size_t> Clip::index_of(KeyframeId id) const noexcept {
  const auto at = std::find_if(keyframes.begin(), keyframes.end(), [id](const Keyframe& k) { return k.id == id; });
  if (at == keyframes.end()) return std::nullopt;
  return static_cast<std::size_t>(at - keyframes.begin());
}

std::size_t Clip::place_of(double time_s) const noexcept {
  return static_cast<std::size_t>(std::lower_bound(times_s.begin(), times_s.end(), time_s) - times_s.begin());
}

}  // namespace tweend::model

#pragma once

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "render/picture.hpp"

namespace tweend::render::test {

/// What lies between -1 and 1 in the plane z = 0 fills the picture, without perspective. Light comes from everywhere, so that
/// colours are plain to see.
inline Picture flat_picture(Size size) {
  Picture picture;
  picture.size = size;
  picture.view.eye = {0.0F, 0.0F, 5.0F};
  picture.view.view_from_world = glm::lookAt(picture.view.eye, glm::vec3(0.0F), glm::vec3(0.0F, 1.0F, 0.0F));
  picture.view.clip_from_view = glm::ortho(-1.0F, 1.0F, -1.0F, 1.0F, 0.1F, 10.0F);
  picture.light.position = {0.0F, 0.0F, 5.0F};
  picture.light.ambient = 1.0F;  // of a normal that is neither up nor down: as bright as the texture
  return picture;
}

}  // namespace tweend::render::test

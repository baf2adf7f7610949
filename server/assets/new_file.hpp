#pragma once

#include <string>

namespace tweend::assets {

/// A file to be saved, called as in its folder.
struct NewFile {
  std::string name;
  std::string bytes;
};

}  // namespace tweend::assets

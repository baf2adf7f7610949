#pragma once

#include <string>
#include <string_view>

#include "server/base/result.hpp"
#include "server/model/model.hpp"

namespace tweend::model {

/// An imported model in one flat piece of memory: what an import hands over, wherever it ran. It holds mesh, vertices,
/// skeleton, skin, morph targets, materials with their images, clips and warnings.
///
/// Little-endian, without gaps: the magic "TWMB", the version of this form, the length of all, then the parts in the order in
/// which read_model_blob takes them, each run of numbers and each text behind its length. It is for one build's own use and
/// never kept.
struct ModelBlob {
  std::string bytes;
};

[[nodiscard]] ModelBlob write_model_blob(const ImportedModel& imported);

/// Puts a model together again, one with the same hashes. Takes nothing for granted: each length, index and enumerator is
/// checked, in one pass, and no more memory is taken than in proportion to the bytes. Pure; safe from any thread.
/// @return BadAsset for bytes that write_model_blob has not made
[[nodiscard]] Result<ImportedModel> read_model_blob(std::string_view bytes);

}  // namespace tweend::model

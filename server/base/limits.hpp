#pragma once

#include <cstddef>
#include <cstdint>

namespace tweend {

/// What nobody may exceed; each is an option of `tweend serve` with these defaults (docs/PROTOCOL.md, section 5.3).
struct Limits {
  std::size_t connections = 10'000;
  std::size_t message_bytes = 16U << 20U;  ///< a JSON message, in
  std::size_t json_depth = 64;
  std::size_t batch_requests = 4'096;
  std::size_t streams_per_connection = 64;
  std::size_t scenes = 256;
  std::size_t actors_per_scene = 1'024;
  std::size_t vertices_per_actor = 4'000'000;
  std::size_t triangles_per_actor = 8'000'000;
  std::size_t joints_per_actor = 4'096;
  std::size_t morph_targets_per_actor = 4'096;
  std::size_t morphed_vertices = 16'000'000;  ///< those of an actor's morph targets, counted once for each target
  std::size_t keyed_values = 16'000'000;      ///< of one asset's clips together
  std::size_t keyframes_per_clip = 100'000;
  std::size_t clips_per_actor = 1'024;
  std::size_t markers_per_clip = 10'000;
  std::size_t undo_steps = 1'000;
  std::size_t queued_clips = 1'000;            ///< entries of one playback.queue
  std::size_t scheduled_commands = 10'000;     ///< that wait for their reading, of all scenes together
  std::size_t stream_pixels = 64U << 20U;      ///< of a connection's streams of frames together
  std::size_t frame_side = 4'096;              ///< pixels of a picture's width, and of its height
  std::size_t recordings = 8;                  ///< under way at once
  std::size_t recorded_pictures = 108'000;     ///< of one recording, which ends then: an hour at 30 a second
  std::size_t film_pictures = 18'000;          ///< of one file of GET /scenes/{scene}/clip.mp4
  std::size_t film_bytes = 256U << 20U;        ///< of the same, which is made in memory
  std::size_t asset_bytes = 256U << 20U;       ///< one asset's files together
  std::size_t texture_pixels = 4'096 * 4'096;  ///< one texture's; those of one asset together: 16 times as many
};

}  // namespace tweend

#pragma once

#include <string>

#include "clients/cli/packet_stream.hpp"

namespace tweend::cli {

// What is printed of a packet of a stream of frames; throws NoServer where it is none.

/// The size of a picture that came smaller than asked for tells how far down the server has gone for us: `96 x 54 of 640 x
/// 360`.
/// @param layout  as stream.open answered it
[[nodiscard]] std::string frame_size_text(const Packet& packet, const Json& layout);
/// A line for people.
[[nodiscard]] std::string frame_text(const Packet& packet, ClockUs age_us, const Json& layout);
/// A line for programs.
/// @param file  where the picture was stored; empty: nowhere
[[nodiscard]] std::string frame_json(const Packet& packet, ClockUs age_us, const std::string& file);

}  // namespace tweend::cli

#include <fmt/format.h>

#include "render/h264_encoder.hpp"
#include "render/h264_level.hpp"

namespace tweend::render {

// Profile 66 with the constraints of both Baseline and Main: Constrained Baseline.
std::string H264Encoder::codec(Size size, double rate) { return fmt::format("avc1.42c0{:02x}", h264_level(size, rate).idc); }

}  // namespace tweend::render

#pragma once

#include <kaboum/geom/region.h>

#include <string>
#include <string_view>
#include <vector>

namespace kaboum::io {

/// Regions with an epsilon each, at least one, of a JSON text (docs/formats.md, "Regions").
/// @param name  of the text, for messages
/// @throws Error{InvalidInput} naming the text and the region
std::vector<geom::RequestedRegion> parse_regions(std::string_view text, const std::string& name);

/// The same of a file. @throws Error as read_file and parse_regions
std::vector<geom::RequestedRegion> read_regions(const std::string& file);

/// Regions that name frames of a robot, and its links, at least one; lengths in the robot's unit.
/// @throws as parse_regions
geom::FrameRegions parse_frame_regions(std::string_view text, const std::string& name);

/// The same of a file. @throws Error as read_file and parse_frame_regions
geom::FrameRegions read_frame_regions(const std::string& file);

}  // namespace kaboum::io

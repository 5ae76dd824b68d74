#pragma once

#include <string>
#include <string_view>

#include "io/mesh_builder.h"

namespace plumb::detail {

/// Whether the first word of the bytes is "solid", in any case.
bool begins_with_solid(std::string_view bytes);

/// Reads the text of an STL file into the builder. Throws plumb::Error with the line at fault.
void read_stl_text(std::string_view text, const std::string& file, MeshBuilder& builder);

}  // namespace plumb::detail

#pragma once

namespace kaboum::verify {

/// The claims about a mesh that have to hold: about its solid, its surface, or both.
enum class Claims { All, Solid, Surface };

}  // namespace kaboum::verify

#pragma once

namespace kaboum::verify {

/// Which claims about a mesh have to hold: about its solid, its surface, or both.
enum class Claims { All, Solid, Surface };

}  // namespace kaboum::verify

#pragma once

// Words of preparation's notes and errors.

#include <kaboum/geom/mesh.h>

#include <sstream>
#include <string>

namespace kaboum::geom {

inline std::string count_of(std::size_t n, const char* singular, const char* plural) {
  return std::to_string(n) + " " + (n == 1 ? singular : plural);
}

inline std::string text_of(const Vec3& p) {
  std::ostringstream s;
  s.precision(6);
  s << '(' << p.x() << ", " << p.y() << ", " << p.z() << ')';
  return s.str();
}

inline std::string text_of(double x) {
  std::ostringstream s;
  s.precision(4);
  s << x;
  return s.str();
}

}  // namespace kaboum::geom

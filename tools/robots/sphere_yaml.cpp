// Spheres of robots in cuRobo's format.
#include "sphere_yaml.h"

#include <kaboum/geom/float32.h>

#include <iomanip>
#include <sstream>

#include "common/cli.h"

namespace kaboum::tools {

std::string sphere_yaml(const robot::RobotFile& robot, const certify::CertifiedBodies& bodies,
                        const std::string& parameters) {
  std::ostringstream out;
  out << "# Spheres of the links of " << robot.path.filename().string()
      << ", in their frames. Each link's hold the link's meshes.\n# bcd-decompose " << version()
      << " " << parameters << "\n# sha256 " << robot.sha256 << "\ncollision_spheres:\n"
      << std::setprecision(9);
  std::size_t last = robot.robot.links.size();
  for (const robot::LinkBody& body : bodies.artefact()) {
    const geom::Vec3 center = geom::to_float32(body.points.at(0));
    const double wanted = (body.margin + (body.points[0] - center).norm()) * (1 + 1e-12);
    double radius = geom::to_float32(wanted);
    if (radius < wanted) radius += geom::float32_spacing(radius);
    if (body.link != last) {
      last = body.link;
      out << "  \"" << robot.robot.links[last].name << "\":\n";
    }
    out << "    - center: [" << center.x() << ", " << center.y() << ", " << center.z()
        << "]\n      radius: " << radius << "\n";
  }
  return out.str();
}

}  // namespace kaboum::tools

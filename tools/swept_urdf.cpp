#include "swept_urdf.h"

#include <kaboum/geom/error.h>
#include <kaboum/io/convex_io.h>
#include <tinyxml2.h>

namespace kaboum::tools {

void write_swept_urdf(const std::filesystem::path& path, const geom::ConvexSet& set) {
  ensure(set.margin == 0, "a margin cannot be stated in URDF");
  std::filesystem::path folder = path;
  folder.replace_extension();
  io::write_convex_set(folder, set, io::SetFormat::Directory);
  tinyxml2::XMLPrinter out;
  out.PushHeader(false, true);
  out.OpenElement("robot");
  out.PushAttribute("name", folder.filename().string().c_str());
  out.OpenElement("link");
  out.PushAttribute("name", "swept_volume");
  for (std::size_t i = 0; i < set.bodies.size(); ++i) {
    out.OpenElement("collision");
    out.PushAttribute("name", set.bodies[i].name.c_str());
    out.OpenElement("geometry");
    out.OpenElement("mesh");
    const std::string file = folder.filename().string() + "/" + io::default_name(i) + ".stl";
    out.PushAttribute("filename", file.c_str());
    out.CloseElement();
    out.CloseElement();
    out.CloseElement();
  }
  out.CloseElement();
  out.CloseElement();
  io::write_file(path, std::string_view(out.CStr()));
}

}  // namespace kaboum::tools

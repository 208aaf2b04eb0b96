// Sets that scenes name: refused unless they are what the scene was made with, and bound what is
// needed.

#include "scene_sets.h"

#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>

namespace kaboum::world::detail {

SceneSets::File SceneSets::file(const Located& value) const {
  known(value, {"file", "sha256"});
  File out{string(need(value, "file")), {}, {}};
  try {
    out.bytes = read_(out.name);
  } catch (const Error& error) {
    fail(need(value, "file"), error.what());
  }
  out.sha256 = io::sha256(out.bytes);
  const Located& stated = need(value, "sha256");
  if (string(stated) != out.sha256)
    fail(stated, out.name + " is not the file that this scene was made with: its SHA-256 is " +
                     out.sha256 + "; make the scene anew, or put that hash here");
  return out;
}

SceneSets::Loaded SceneSets::container(const Located& value, const char* direction) {
  Loaded out;
  out.file = file(value);
  const Located& at = need(value, "file");
  if (!out.file.name.ends_with(".glb"))
    fail(at, out.file.name + " is no container of convex sets (.glb)");
  try {
    io::SetReadDetails details;
    out.set = io::parse_convex_set(out.file.bytes, io::Format::Glb, out.file.name, &details);
    if (!details.has_record) fail(at, out.file.name + " has no record of what it bounds");
  } catch (const Error& error) {
    fail(at, error.what());
  }
  const geom::Provenance& p = out.set.provenance;
  if (p.direction != direction)
    fail(at, out.file.name + " is " +
                 (p.direction.empty() ? "not said to be an outer or an inner set"
                                      : "an " + p.direction + " set") +
                 ", but an " + direction + " one is needed here");
  if (p.unit != unit_) fail(at, out.file.name + " is in " + p.unit + ", the scene in " + unit_);
  if (out.set.provenance.direction == "outer") note_sheets(out);
  return out;
}

BoundingSet SceneSets::set(const Loaded& loaded, const Located& value) const {
  try {
    return BoundingSet(loaded.set);
  } catch (const Error& error) {
    fail(need(value, "file"), loaded.file.name + ": " + error.what());
  }
}

BoundingSet SceneSets::set(const Located& object, const char* member, const char* direction) {
  const Located& value = need(object, member);
  return set(container(value, direction), value);
}

void SceneSets::note_sheets(const Loaded& loaded) {
  if (loaded.set.provenance.covers_surface) return;
  notes.push_back(file_name() + ": " + loaded.file.name +
                  " covers the solid only: sheets without volume were dropped or stick out, and "
                  "nothing is checked of them");
}

std::optional<BoundingSet> SceneSets::optional_inner(const Located& object) {
  if (find(object, "inner") == nullptr) return std::nullopt;
  return set(object, "inner", "inner");
}

}  // namespace kaboum::world::detail

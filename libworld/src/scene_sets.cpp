// Sets that scenes name: refused unless they are what the scene was made with, and bound what is
// needed.

#include "scene_sets.h"

#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>

#include <algorithm>

namespace kaboum::world::detail {

SceneSets::File SceneSets::file(const Located& value, const std::vector<std::string>& more) const {
  std::vector<std::string> members{"file", "sha256"};
  members.insert(members.end(), more.begin(), more.end());
  known(value, members);
  File out{string(need(value, "file")), {}, {}};
  try {
    out.bytes = read_(out.name);
  } catch (const Error& error) {
    fail(need(value, "file"),
         std::string(error.what()) +
             "; files are looked for from the scene's folder: a scene is moved or copied with all "
             "files that it names, at the same places beside it");
  }
  out.sha256 = io::sha256(out.bytes);
  const Located& stated = need(value, "sha256");
  if (string(stated) != out.sha256)
    fail(stated, out.name + " is not the file that this scene was made with: its SHA-256 is " +
                     out.sha256 + "; kaboum-scene update makes what is out of date anew");
  return out;
}

std::vector<std::string> SceneSets::sources(const Located& list, const std::string& set) {
  std::vector<std::string> out;
  for (const Located& source : array(list)) {
    known(source, {"file", "sha256"});
    const Located &named = need(source, "file"), &stated = need(source, "sha256");
    const std::string& name = string(named);
    auto known_hash = hashes_.find(name);
    if (known_hash == hashes_.end()) try {
        known_hash = hashes_.emplace(name, io::sha256(read_(name))).first;
      } catch (const Error& error) {
        fail(named, std::string(error.what()) + "; " + set +
                        " was made from it: bring it back, or take it out of 'made_from', and "
                        "nobody will notice when it changes");
      }
    if (string(stated) != known_hash->second)
      fail(stated, std::string(name)
                       .append(" has changed since ")
                       .append(set)
                       .append(" was made from it; kaboum-scene update makes it anew"));
    out.push_back(known_hash->second);
  }
  return out;
}

SceneSets::Loaded SceneSets::container(const Located& value, const char* direction) {
  Loaded out;
  out.file = file(value, {"made_from"});
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
  if (out.set.provenance.direction == "outer") {
    // Nothing would be free of everything.
    if (out.set.bodies.empty()) fail(at, out.file.name + " is empty: it bounds nothing");
    note_sheets(out);
  }
  if (const Located* list = find(value, "made_from"))
    out.made_from = sources(*list, out.file.name);
  else if (!p.source.empty())
    of_unknown_source_.push_back(out.file.name);
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
  const Loaded loaded = container(value, direction);
  require_source(loaded, value, {});
  return set(loaded, value);
}

void SceneSets::require_source(const Loaded& loaded, const Located& value,
                               const std::string& robot) const {
  const geom::Provenance& p = loaded.set.provenance;
  if (p.source_sha256.empty() || (!robot.empty() && p.source_sha256 == robot)) return;
  if (!loaded.made_from && robot.empty()) return;  // noted
  if (loaded.made_from &&
      std::ranges::find(*loaded.made_from, p.source_sha256) != loaded.made_from->end())
    return;
  fail(need(value, "file"),
       loaded.file.name + " was made from another file '" + p.source + "' than " +
           (robot.empty() ? "those in 'made_from'"
                          : "the robot as it is now, or those in 'made_from'") +
           "; kaboum-scene update makes it anew");
}

void SceneSets::note_unknown_sources() {
  const std::size_t n = of_unknown_source_.size();
  if (n == 0) return;
  notes.push_back(file_name() + ": " + of_unknown_source_.front() +
                  (n == 1 ? " does" : " and " + std::to_string(n - 1) + " more do") +
                  " not say in 'made_from' which meshes " + (n == 1 ? "it was" : "they were") +
                  " made from: nobody will notice when these change");
}

void SceneSets::note_sheets(const Loaded& loaded) {
  if (loaded.set.provenance.covers_surface) return;
  notes.push_back(file_name() + ": " + loaded.file.name +
                  " covers the solid only: sheets without volume were dropped or stick out, and "
                  "nothing is checked of them");
}

std::pair<BoundingSet, std::optional<BoundingSet>> SceneSets::sets_of(const Located& object) {
  const Located& outer_value = need(object, "outer");
  const Loaded outer = container(outer_value, "outer");
  require_source(outer, outer_value, {});
  std::pair<BoundingSet, std::optional<BoundingSet>> out{set(outer, outer_value), std::nullopt};
  if (const Located* value = find(object, "inner")) {
    const Loaded inner = container(*value, "inner");
    require_source(inner, *value, {});
    require_within(inner, outer, *value);
    out.second = set(inner, *value);
  }
  return out;
}

void SceneSets::require_within(const Loaded& inner, const Loaded& outer, const Located& at) const {
  if (!outer.set.provenance.covers_solid) return;  // what holes leave open is filled in each anew
  geom::Box3 box;
  for (const geom::ConvexBody& body : outer.set.bodies) box.extend(geom::bounding_box(body));
  for (const geom::ConvexBody& body : inner.set.bodies)
    for (const Vec3& p : body.core.vertices)
      if (!((p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all()))
        fail(need(at, "file"), inner.file.name + " reaches out of " + outer.file.name +
                                   ": an inner set lies in its outer one, so they are not of one "
                                   "solid; make both of the same mesh");
}

}  // namespace kaboum::world::detail

// Replay of logs: kaboum.replay, as bmesh-replay; and the cache, as
// kaboum-cache.

#include <kaboum/certify/cache_folder.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/replay.h>

#include <chrono>

#include "answers.h"
#include "mesh.h"
#include "running.h"

namespace kaboum::python {
namespace {

std::string file_of(const py::object& path, const char* argument) {
  const auto file = path_of(path);
  if (!file)
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a str or an os.PathLike");
  return *file;
}

Verdict replay(const py::object& original, const py::object& log, const py::object& result,
               double scale, const py::object& progress) {
  const std::string from = file_of(original, "original"), by = file_of(log, "log");
  if (!(scale >= 1e-9 && scale <= 1e9))
    throw Error(ErrorCode::InvalidArgument, "scale must be a number from 1e-9 to 1e9");
  const MeshValue made = mesh_of(result, "result");
  bmesh::Log steps;
  Watch watch(progress);
  const verify::ReplayResult r = run(0, [&] {
    std::vector<char> bytes;
    io::ReadResult input = io::read_mesh(from, {}, &bytes);
    steps = bmesh::parse_log(io::read_file(by), by);
    if (steps.input_sha256 != io::sha256(bytes))
      throw Error(ErrorCode::InvalidInput,
                  by + ": the log was made from another file than " + from);
    io::require_recorded_scale(by, steps.tool, scale);
    io::scale(input, scale, from);
    return verify::replay(input.mesh, steps, *made.mesh, watch.hook());
  });
  Verdict out;
  out.answer = r.verified ? verify::Answer::Verified : verify::Answer::Refuted;
  py::dict one;
  one["answer"] = verify::name_of(out.answer);
  one["reason"] = r.violation;
  one["direction"] = steps.direction == bmesh::Direction::Any     ? "any"
                     : steps.direction == bmesh::Direction::Outer ? "outer"
                                                                  : "inner";
  one["closed"] = r.closed;
  one["steps"] = r.steps;
  one["predicates"] = r.predicates;
  one["dropped_triangles"] = r.dropped;
  one["turned_triangles"] = r.reversed;
  one["filled_triangles"] = r.filled;
  out.claims["replay"] = one;
  if (steps.direction == bmesh::Direction::Any)
    out.notes.emplace_back("Direction 'any' claims no enclosure.");
  if (r.reversed != 0)
    out.notes.emplace_back(
        "Triangles are turned as the log says; whether they "
        "should be is not checked.");
  return out;
}

certify::CacheFolder cache_of(const py::object& folder) {
  if (!folder.is_none()) return certify::CacheFolder(file_of(folder, "folder"));
  const std::filesystem::path place = certify::CacheFolder::default_folder();
  if (place.empty())
    throw Error(ErrorCode::InvalidArgument,
                "there is no cache: none of $KABOUM_CACHE, $XDG_CACHE_HOME and "
                "$HOME is set");
  return certify::CacheFolder(place);
}

double seconds_since(std::filesystem::file_time_type time) {
  return std::chrono::duration<double>(std::filesystem::file_time_type::clock::now() - time)
      .count();
}

py::list cache_entries(const py::object& folder, bool verify, const py::object& progress) {
  const certify::CacheFolder cache = cache_of(folder);
  using Entry = certify::CacheFolder::Entry;
  std::vector<std::string> kinds, flaws;
  Watch watch(progress);
  const std::vector<Entry> entries = run(0, [&] {
    std::vector<Entry> found = cache.entries();
    for (const Entry& entry : found) {
      watch(entry.path.stem().string());
      kinds.push_back(certify::CacheFolder::kind_of(entry));
      flaws.push_back(verify ? certify::CacheFolder::flaw_of(entry) : std::string());
    }
    return found;
  });
  py::list out;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    py::dict one;
    one["entry"] = entries[i].path.stem().string();
    one["kind"] = kinds[i];
    one["bytes"] = entries[i].bytes;
    one["seconds_since_use"] = seconds_since(entries[i].used);
    if (verify) one["flaw"] = flaws[i];
    out.append(one);
  }
  return out;
}

py::dict prune_cache(const py::object& folder, const std::optional<std::uintmax_t>& size) {
  const certify::CacheFolder cache = cache_of(folder);
  const auto removed =
      run(0, [&] { return cache.prune(size ? *size : certify::CacheFolder::size_limit()); });
  std::uintmax_t sum = 0;
  for (const certify::CacheFolder::Entry& entry : removed) sum += entry.bytes;
  py::dict out;
  out["removed"] = removed.size();
  out["bytes"] = sum;
  return out;
}

}  // namespace

void bind_replay_and_cache(py::module_& module) {
  module.def(
      "replay", &replay, py::arg("original"), py::arg("log"), py::arg("result"), py::kw_only(),
      py::arg("scale") = 1.0, py::arg("progress") = py::none(),
      R"(Derives a result of `bmesh-decimate --log` again and checks every step exactly, as `bmesh-replay`.

Parameters
----------
original : str or path
    The file that was simplified.
log : str or path
result : mesh
    What was written.
scale : float
    That the original's coordinates were multiplied by.
progress
    As for `decimate`.

Raises
------
Error
    'invalid_input' where the log was made from another file.)");
  module.def("cache_entries", &cache_entries, py::kw_only(), py::arg("folder") = py::none(),
             py::arg("verify") = false, py::arg("progress") = py::none(),
             R"(Entries of the cache, those not used for the longest time first, as `kaboum-cache`.

Parameters
----------
folder : str or path, optional
    By default $KABOUM_CACHE, else $XDG_CACHE_HOME/kaboum, else ~/.cache/kaboum.
verify : bool
    Look at each entry: 'flaw' is why it is damaged, empty where it is whole.
progress
    As for `decimate`.)");
  module.def("prune_cache", &prune_cache, py::kw_only(), py::arg("folder") = py::none(),
             py::arg("size") = py::none(),
             R"(Removes what was not used for the longest time, until the rest is small enough.

Parameters
----------
folder : str or path, optional
size : int, optional
    Bytes that are left at the most; 0 removes all. By default $KABOUM_CACHE_SIZE, else 4 GiB.)");
}

}  // namespace kaboum::python

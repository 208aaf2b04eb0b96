// The option --batch of kaboum-check: configurations by the million.

#include "batch.h"

#include <kaboum/base/error.h>
#include <kaboum/filter/batch_checker.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/world/finger_paths.h>
#include <kaboum/world/gripper.h>
#include <kaboum/world/motion_check.h>

#include <cstdint>

namespace kaboum::tools {
namespace {

bool is_npy(const std::string& file) { return file.ends_with(".npy"); }

/// A byte for each configuration or motion: an array of uint8, or lines of 0 and 1.
std::string text_of(const std::vector<std::uint8_t>& free, bool npy) {
  std::string out;
  if (!npy) {
    out.reserve(2 * free.size());
    for (const std::uint8_t x : free) out += x != 0 ? "1\n" : "0\n";
    return out;
  }
  std::string header = "{'descr': '|u1', 'fortran_order': False, 'shape': (";
  header += std::to_string(free.size());
  header += ",), }";
  header.resize((10 + header.size() + 64) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  out = "\x93NUMPY";
  out += '\x01';
  out += '\0';
  out += static_cast<char>(header.size() % 256);
  out += static_cast<char>(header.size() / 256);
  out += header;
  out.append(free.begin(), free.end());
  return out;
}

}  // namespace

void require_batch_meaning(const CheckOptions& o) {
  const auto no = [](const std::string& text) { throw Error(ErrorCode::InvalidArgument, text); };
  if (o.batch.empty()) {
    if (!o.verdicts.empty()) no("--verdicts needs --batch");
    if (!o.motions.empty()) no("--motions needs --batch; one motion is given by --path");
    return;
  }
  if (o.engine.library != engines::Library::Own || o.distance || o.state.resting ||
      !o.inside.empty() || !o.preview.empty())
    no("--engine, --distance, --resting, --inside and --preview are not for --batch: give "
       "--configurations");
}

namespace {

/// Rows of values, one after the other.
std::vector<double> joined(const robot::Path& rows, std::size_t first, std::size_t step,
                           std::size_t count) {
  std::vector<double> out;
  out.reserve(count * rows.front().size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<double>& row = rows[first + i * step];
    out.insert(out.end(), row.begin(), row.end());
  }
  return out;
}

/// Verdicts of what is asked for, and how they came about.
struct Verdicts {
  std::vector<std::uint8_t> free;
  filter::BatchCounts counts;
};

/// What is free where fingers are as the rows have them is so wherever they stop within what the
/// grasps of what is held allow, or counts as contact.
void look_at_fingers(const CheckOptions& o, const world::Checker& checker, std::size_t robot,
                     const std::function<robot::Path(std::size_t)>& path_of, Verdicts& out) {
  const world::WorldState state = initial_state(checker.world());
  if (!world::holds_by_fingers(state)) return;
  for (std::size_t i = 0; i < out.free.size(); ++i) {
    const std::string what = o.motions.empty() ? "row " + std::to_string(i + 1)
                                               : "motion " + std::to_string(i + 1) + ", row";
    std::vector<world::RobotPath> paths;
    try {
      paths = world::paths_with_fingers(checker.world(), state, robot, path_of(i), what);
    } catch (const Error& error) {
      throw Error(ErrorCode::InvalidInput, o.batch + ": " + error.what());
    }
    if (paths.empty() || out.free[i] == 0) continue;
    world::MotionOptions options = o.motion;
    options.where = false;
    if (check_motions(checker, state, paths, options).outcome == world::MotionAnswer::Outcome::Free)
      continue;
    out.free[i] = 0;
    --out.counts.free;
    ++out.counts.contact;
  }
}

Verdicts decide(const CheckOptions& o, const world::Checker& checker, std::size_t robot,
                const robot::Path& rows) {
  const filter::BatchChecker batch(checker, initial_state(checker.world()), robot, {});
  Verdicts out;
  if (o.motions.empty()) {
    out.free.resize(rows.size());
    out.counts = batch.decide(joined(rows, 0, 1, rows.size()), out.free);
    look_at_fingers(
        o, checker, robot, [&](std::size_t i) { return robot::Path{rows[i]}; }, out);
    return out;
  }
  const bool pairs = o.motions == kPairs;
  if (pairs && rows.size() % 2 != 0)
    throw Error(ErrorCode::InvalidInput,
                o.batch + ": " + std::to_string(rows.size()) +
                    " rows; of pairs of rows there must be an even number");
  if (!pairs && rows.size() < 2)
    throw Error(ErrorCode::InvalidInput, o.batch + ": one row; a motion needs two");
  const std::size_t count = pairs ? rows.size() / 2 : rows.size() - 1, step = pairs ? 2 : 1;
  out.free.resize(count);
  out.counts = batch.decide_motions(joined(rows, 0, step, count), joined(rows, 1, step, count),
                                    out.free, o.motion);
  look_at_fingers(
      o, checker, robot,
      [&](std::size_t i) {
        return robot::Path{rows[i * step], rows[i * step + 1]};
      },
      out);
  return out;
}

}  // namespace

int check_batch(const CheckOptions& o, const world::SceneFile& scene, std::size_t robot,
                const robot::Path& rows, const std::string& kept,
                const std::function<void(const std::string&)>& say, Json& report) {
  const world::Checker checker(scene.world);
  const auto [free, counts] = decide(o, checker, robot, rows);
  if (!o.verdicts.empty()) {
    const std::string text = text_of(free, is_npy(o.verdicts));
    io::write_file(o.verdicts, std::vector<char>(text.begin(), text.end()));
  }
  const bool moves = !o.motions.empty();
  const std::string summary =
      std::to_string(counts.free) + " of " + std::to_string(free.size()) +
      (moves ? " motions are free at every instant, " : " configurations are free, ") +
      std::to_string(counts.contact) + " are not" + kept + "; " + std::to_string(counts.exactly) +
      " needed exact predicates";
  // Standard output is the verdicts' where they are written there.
  if (o.verdicts == "-")
    log(o.common.quiet, summary);
  else
    say(summary);
  report["batch"] = {{"file", o.batch},
                     {moves ? "motions" : "configurations", free.size()},
                     {"free", counts.free},
                     {"not_free", counts.contact},
                     {"exactly", counts.exactly}};
  report["answer"] = counts.contact == 0 ? "free" : "not free";
  return counts.contact == 0 ? kDone : kNo;
}

}  // namespace kaboum::tools

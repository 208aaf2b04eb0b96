// Batches: kaboum.run_batch, as kaboum-batch.

#include <kaboum/base/program_file.h>
#include <kaboum/batch/batch.h>

#include <filesystem>

#include "arguments.h"
#include "bindings.h"
#include "running.h"

namespace kaboum::python {
namespace {

std::string text_path(const py::handle& value, const char* argument) {
  const auto path = path_of(py::reinterpret_borrow<py::object>(value));
  if (!path)
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a str or an os.PathLike");
  return *path;
}

std::vector<std::string> paths_of(const py::object& value, const char* argument) {
  if (const auto one = path_of(value)) return {*one};
  std::vector<std::string> out;
  if (!py::isinstance<py::sequence>(value))
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a path or a sequence of them");
  for (const py::handle item : value.cast<py::sequence>()) out.push_back(text_path(item, argument));
  return out;
}

/// Program and options, as a list of words; or a rule's text without its pattern.
std::vector<std::string> command_of(const py::handle& value) {
  if (py::isinstance<py::str>(value))
    return batch::parse_rule("*: " + value.cast<std::string>()).command;
  if (!py::isinstance<py::sequence>(value))
    throw Error(ErrorCode::InvalidArgument,
                "commands must be a str, a list of words, or a dict of patterns and these");
  std::vector<std::string> words;
  for (const py::handle word : value.cast<py::sequence>()) words.push_back(py::str(word));
  if (words.empty()) throw Error(ErrorCode::InvalidArgument, "a command needs a program");
  return words;
}

/// A command for all files, or a dict of patterns and commands.
std::vector<batch::Rule> rules_of(const py::object& commands) {
  if (!py::isinstance<py::dict>(commands)) return {{"*", command_of(commands)}};
  std::vector<batch::Rule> rules;
  for (const auto& [pattern, command] : commands.cast<py::dict>())
    rules.push_back({py::str(pattern), command_of(command)});
  return rules;
}

/// The programs that are installed with the module, as a wheel has them; empty: there are none.
std::filesystem::path installed_programs() {
  const auto folder =
      program_file(reinterpret_cast<const void*>(&installed_programs)).parent_path() / "bin";
  std::error_code error;
  return std::filesystem::is_directory(folder, error) ? folder : std::filesystem::path();
}

batch::BatchResult run_batch(
    const py::object& inputs, const py::object& folder, const py::object& commands,
    const std::optional<std::string>& extension, std::size_t jobs,
    const std::optional<std::uintmax_t>& memory, const std::optional<std::uintmax_t>& max_memory,
    const std::optional<double>& timeout, const std::optional<std::string>& shard, bool summary,
    bool retry, bool pictures, const py::object& programs, const py::object& progress) {
  batch::BatchRequest request;
  request.inputs = paths_of(inputs, "inputs");
  request.folder = text_path(folder, "folder");
  request.rules = rules_of(commands);
  request.extension = extension.value_or("");
  if (jobs > 1024) throw Error(ErrorCode::InvalidArgument, "jobs must be from 0 to 1024");
  request.jobs = jobs;
  if (memory) request.memory = *memory;
  request.most_memory = max_memory.value_or(0);
  if (timeout && !(*timeout > 0))
    throw Error(ErrorCode::InvalidArgument, "timeout must be a number of seconds above 0");
  request.timeout = timeout.value_or(0);
  if (shard) request.shard = batch::parse_shard(*shard);
  request.only_summary = summary;
  request.retry = retry;
  request.pictures = pictures;
  request.programs = programs.is_none() ? installed_programs()
                                        : std::filesystem::path(text_path(programs, "programs"));
  Watch watch(progress);
  request.progress = watch.hook();
  return run(0, [&] { return batch::run_batch(request); });
}

constexpr const char* kBatchDoc =
    R"(Runs a program on many files, at the same time, with limits, and resumably, as `kaboum-batch`.

Each file has a process of its own, which is ended with this one. Called again after anything, it goes
on: what is done, and has not changed, is not done again (docs/pipelines.md).

Parameters
----------
inputs : path or sequence of path
    Folders (all meshes and robots in them), lists of files (.txt, a line each), or files.
folder : path
    Of results, the journal and the summaries (summary.html, .csv, .json).
commands : str, list of str, or dict
    Program and options, 'bcd-decompose --epsilon 1%', for all files; or by pattern of their names,
    of which the first that matches counts. '{input}', '{output}' and '{report}' stand for files, for
    programs that are not KABouM's.
extension : str, optional
    Of results; by default .glb of bcd-decompose, .ply of others; robots become folders.
jobs : int
    Files at a time; 0: one per core.
memory : int, optional
    Of all programs at a time: fewer run where they are expected to need more. By default 80% of what
    is free; 0: no limit. [bytes]
max_memory : int, optional
    Address space of one program. [bytes]
timeout : float, optional
    A program is ended after so long. [s]
shard : str, optional
    'K/N': only this part of N, as several machines do in one folder; then no summary is written.
summary : bool
    Work on nothing, write the summary of what is done so far.
retry : bool
    Also do again what was not done for a reason.
pictures : bool
    Of results, for the summary.
programs : path, optional
    Folder that programs are looked for in first, then on PATH. By default that of the installed
    package, where it has programs.
progress
    As for `decimate`.

Returns
-------
Batch

Raises
------
Error
    'invalid_input' where nothing matches; 'output_failed', also where another batch writes there.)";

}  // namespace

void bind_batches(py::module_& module) {
  using batch::BatchResult;
  py::class_<BatchResult>(module, "Batch",
                          "What a batch has come to: true if and only if all files are done.")
      .def("__bool__", &BatchResult::complete)
      .def("__len__", [](const BatchResult& b) { return b.records.size(); })
      .def_property_readonly(
          "rows",
          [](const BatchResult& b) {
            return py::module_::import("json").attr("loads")(b.json())["rows"].cast<py::list>();
          },
          "A dict for each file that was worked on: 'name', 'state' ('done', 'no', 'failed', "
          "'timeout' or 'memory'), 'reason', 'output', 'verdict', 'distance', and so on, as in "
          "summary.json.")
      .def_property_readonly(
          "counts",
          [](const BatchResult& b) {
            return py::module_::import("json").attr("loads")(b.json())["states"].cast<py::dict>();
          },
          "How many there are of each state.")
      .def_readonly("done_before", &BatchResult::done_before, "By earlier runs.")
      .def_readonly("to_do", &BatchResult::to_do, "Files that were not worked on.")
      .def("__repr__", [](const BatchResult& b) { return "<kaboum.Batch: " + b.words() + ">"; });
  module.def("run_batch", &run_batch, py::arg("inputs"), py::arg("folder"), py::arg("commands"),
             py::kw_only(), py::arg("extension") = py::none(), py::arg("jobs") = 0,
             py::arg("memory") = py::none(), py::arg("max_memory") = py::none(),
             py::arg("timeout") = py::none(), py::arg("shard") = py::none(),
             py::arg("summary") = false, py::arg("retry") = false, py::arg("pictures") = true,
             py::arg("programs") = py::none(), py::arg("progress") = py::none(), kBatchDoc);
}

}  // namespace kaboum::python

// Which files a batch is about, and what is made of each.

#include "job.h"

#include <fnmatch.h>
#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace kaboum::batch {
namespace {

/// Words as in a shell. @throws Error{InvalidArgument} on a quotation mark without its second one
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::string word;
  bool inside = false;  // a word, which may be empty
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote)
        quote = 0;
      else
        word += c;
    } else if (c == '\'' || c == '"') {
      quote = c;
      inside = true;
    } else if (c == ' ' || c == '\t') {
      if (inside) words.push_back(word);
      word.clear();
      inside = false;
    } else {
      word += c;
      inside = true;
    }
  }
  if (quote != 0) throw Error(ErrorCode::InvalidArgument, "a quotation mark has no second one");
  if (inside) words.push_back(word);
  return words;
}

std::vector<std::string> lines_of(const std::string& file) {
  const std::vector<char> bytes = io::read_file(file);
  std::istringstream stream(std::string(bytes.begin(), bytes.end()));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    if (line.ends_with('\r')) line.pop_back();
    lines.push_back(line);
  }
  return lines;
}

constexpr const char* kJournals = ".kaboum-batch";  ///< folder of them, in that of a batch

/// A file to work on, and what it is called.
struct InputFile {
  std::string name;
  fs::path path;
};

bool is_input(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".urdf" || io::format_from_name(extension).has_value();
}

/// Whether a folder holds what a batch made, this one or another.
bool is_of_batch(const fs::path& path) {
  const fs::path name = path.filename();
  std::error_code error;
  return (name == "results" || name == "pictures" || name == kJournals) &&
         fs::is_directory(path.parent_path() / kJournals, error);
}

void add_folder(const fs::path& folder, const BatchRequest& options,
                std::vector<InputFile>& found) {
  std::error_code error;
  fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, error);
  if (error) throw Error(ErrorCode::InvalidInput, folder.string() + ": " + error.message());
  for (; it != fs::recursive_directory_iterator(); it.increment(error)) {
    const fs::path& path = it->path();
    const bool directory = it->is_directory(error);
    if (directory && fs::equivalent(path, options.folder, error)) {
      it.disable_recursion_pending();
    } else if (directory && is_of_batch(path)) {
      it.disable_recursion_pending();
      if (options.note && path.filename() == "results")
        options.note(path.string() + ": left out, for these are results of a batch");
    } else if (it->is_regular_file(error) && is_input(path)) {
      found.push_back({path.lexically_relative(folder).generic_string(), path});
    }
  }
}

/// @throws Error{InvalidArgument} when inputs lie where results are written.
void require_no_results(const std::vector<InputFile>& found, const fs::path& batch) {
  std::error_code error;
  const fs::path results = fs::weakly_canonical(batch / "results", error);
  for (const InputFile& f : found) {
    const fs::path input = fs::weakly_canonical(f.path, error);
    if (std::mismatch(results.begin(), results.end(), input.begin(), input.end()).first ==
        results.end())
      throw Error(ErrorCode::InvalidArgument,
                  f.path.string() + " lies in " + (batch / "results").string() +
                      ", where this batch writes its results; give another «output»");
  }
}

/// Paths are called as they are written, without what leads above the list.
std::string name_of(const fs::path& path) {
  fs::path name;
  for (const fs::path& part : path.relative_path().lexically_normal())
    if (part != ".." && part != ".") name /= part;
  return name.generic_string();
}

void add_list(const fs::path& list, std::vector<InputFile>& found) {
  for (const std::string& line : lines_of(list.string())) {
    if (line.empty() || line.starts_with('#')) continue;
    found.push_back({name_of(line), list.parent_path() / line});
  }
}

std::vector<InputFile> find_inputs(const BatchRequest& options) {
  std::vector<InputFile> found;
  for (const std::string& text : options.inputs) {
    const fs::path input(text);
    std::error_code error;
    if (fs::is_directory(input, error))
      add_folder(input, options, found);
    else if (input.extension() == ".txt")
      add_list(input, found);
    else
      found.push_back({input.filename().string(), input});
  }
  require_no_results(found, options.folder);
  std::sort(found.begin(), found.end(), [](const InputFile& a, const InputFile& b) {
    return std::tie(a.name, a.path) < std::tie(b.name, b.path);
  });
  for (std::size_t i = 1; i < found.size(); ++i)
    if (found[i].name == found[i - 1].name)
      throw Error(ErrorCode::InvalidInput, found[i].path.string() + " and " +
                                               found[i - 1].path.string() +
                                               " would have the same result; give a folder that "
                                               "holds both");
  return found;
}

std::string extension_for(const Job& job, const std::string& asked) {
  if (job.makes_folder()) return "";
  if (!asked.empty()) return asked.starts_with('.') ? asked : "." + asked;
  return fs::path(job.command.front()).filename() == "bcd-decompose" ? ".glb" : ".ply";
}

/// Results are called as their inputs; where several would be called the same, with all of the
/// inputs' names.
void name_outputs(std::vector<Job>& jobs, const std::string& extension) {
  std::map<std::string, std::size_t> uses;
  const auto short_name = [](const Job& job) {
    fs::path name = fs::path(job.name).replace_extension();
    if (job.input.extension() == ".xacro" && name.extension() == ".urdf") name.replace_extension();
    return name.generic_string();
  };
  for (const Job& job : jobs) ++uses[short_name(job)];
  for (Job& job : jobs)
    job.output = "results/" +
                 (uses[short_name(job)] == 1 ? short_name(job) : job.name + "-result") +
                 extension_for(job, extension);
}

/// A batch asks for dependency files itself, to know when results are to be made anew.
void require_own_depfile(const std::vector<std::string>& command) {
  for (const std::string& word : command)
    if (word == "--depfile" || word.starts_with("--depfile="))
      throw Error(ErrorCode::InvalidArgument,
                  "«depfile»: a batch has one written for itself, to see what a result depends on; "
                  "leave it out");
}

}  // namespace

Rule parse_rule(const std::string& text) {
  const std::size_t colon = text.find(": ");
  if (colon == std::string::npos || colon == 0)
    throw Error(ErrorCode::InvalidArgument,
                "a rule is PATTERN: PROGRAM OPTIONS, as in '*.stl: mesh-prepare', "
                "not '" +
                    text + "'");
  Rule rule{text.substr(0, colon), words_of(text.substr(colon + 1))};
  if (rule.command.empty())
    throw Error(ErrorCode::InvalidArgument, "the rule '" + text + "' has no program");
  return rule;
}

std::vector<Rule> read_rules(const std::string& file) {
  std::vector<Rule> rules;
  std::size_t number = 0;
  for (const std::string& line : lines_of(file)) {
    ++number;
    if (line.empty() || line.starts_with('#')) continue;
    try {
      rules.push_back(parse_rule(line));
    } catch (const Error& error) {
      throw Error(error.code(), file + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  return rules;
}

FileState file_state(const fs::path& file) {
  const fs::path path = fs::absolute(file).lexically_normal();
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {path};
  const auto nanoseconds = [](const timespec& t) { return t.tv_sec * 1'000'000'000LL + t.tv_nsec; };
  return {path, static_cast<std::uintmax_t>(status.st_size), nanoseconds(status.st_mtim),
          nanoseconds(status.st_ctim)};
}

bool Job::may_refer_to_others() const {
  const fs::path extension = input.extension();
  return makes_folder() || extension == ".gltf" || extension == ".wrl" || extension == ".x3d";
}

std::string Job::key() const {
  std::string text = state.path.string() + "\n" + std::to_string(state.bytes) + " " +
                     std::to_string(state.modified) + " " + std::to_string(state.changed) +
                     " " KABOUM_VERSION;
  for (const std::string& word : command) text += "\n" + word;
  return io::sha256(text + "\n" + output);
}

std::vector<Job> find_jobs(const BatchRequest& options) {
  std::vector<Job> jobs;
  for (const InputFile& found : find_inputs(options)) {
    const auto rule = std::find_if(options.rules.begin(), options.rules.end(), [&](const Rule& r) {
      return fnmatch(r.pattern.c_str(), found.name.c_str(), 0) == 0;
    });
    if (rule != options.rules.end())
      jobs.push_back(
          {.name = found.name, .input = found.path, .output = {}, .command = rule->command});
  }
  if (jobs.empty())
    throw Error(ErrorCode::InvalidInput, "no file that could be read matches a rule");
  for (const Job& job : jobs) require_own_depfile(job.command);
  name_outputs(jobs, options.extension);  // which depend on all names
  if (options.shard) std::erase_if(jobs, [&](const Job& j) { return !options.shard->has(j.name); });
  for (Job& job : jobs) job.state = file_state(job.input);
  return jobs;
}

}  // namespace kaboum::batch

#pragma once

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/plan/check.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/solve.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

/// What the planner's tests share.
namespace kaboum::plan::test {

inline std::string slurp(const std::string& file) {
  std::ifstream in(file);
  EXPECT_TRUE(in.good()) << file;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// What `make-problem N` of a scenario prints.
inline std::string made(const std::string& domain, const std::string& arguments) {
  const std::string command =
      std::string(KABOUM_DOMAINS) + "/" + domain + "/make-problem " + arguments;
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe.get()))
    text.append(buffer.data(), n);
  EXPECT_FALSE(text.empty()) << command;
  return text;
}

inline Model model_of(const std::string& kpl) {
  return load({"test.kpl", kpl, Language::Kpl}, nullptr);
}

inline Model scenario(const std::string& domain, const std::string& arguments) {
  std::string file = KABOUM_DOMAINS "/";
  file.append(domain).append("/domain.kpl");
  const Text d{"domain.kpl", slurp(file), Language::Kpl};
  const Text p{"problem.kpl", made(domain, arguments), Language::Kpl};
  return load(d, &p);
}

inline Solution solved(const Model& model, Algorithm algorithm) {
  SolveOptions options;
  options.algorithm = algorithm;
  options.timeout = 60;
  Solution s = solve(model, options);
  if (s.outcome == Outcome::Solved) {
    const CheckResult r = check(model, s.plan);
    EXPECT_TRUE(r.valid) << r.violation << "\n" << plan_text(model, s.plan);
  }
  return s;
}

inline constexpr std::array kAll = {Algorithm::DepthFirst, Algorithm::BreadthFirst,
                                    Algorithm::IterativeDeepening, Algorithm::Greedy,
                                    Algorithm::AStar};

/// The message of the error that loading raises.
inline std::string complaint(const std::string& text, Language language = Language::Kpl) {
  try {
    load({language == Language::Kpl ? "bad.kpl" : "bad.pddl", text, language}, nullptr);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::InvalidInput);
    return e.what();
  }
  return "no error";
}

/// The message of the error that loading with these externals, or solving, raises.
inline std::string complaint(const std::string& kpl, const ExternalBindings& bindings) {
  try {
    solve(load({"t.kpl", kpl, Language::Kpl}, nullptr, bindings), {});
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::InvalidInput);
    return e.what();
  }
  return "no error";
}

}  // namespace kaboum::plan::test

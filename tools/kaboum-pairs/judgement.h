#pragma once

#include <kaboum/pairs/matrix.h>

#include <string>
#include <vector>

#include "common/cli.h"

namespace kaboum::tools {

/// What is a no, besides refuted pairs.
struct FailOn {
  bool open = false;    ///< open pairs
  bool faults = false;  ///< of the file
};

/// A judged matrix, and what it was judged by.
struct JudgedMatrix {
  std::string again;  ///< the command that decides pairs of the same shapes of the robot
  std::string file;   ///< name
  pairs::Matrix matrix;
  std::vector<pairs::JudgedPair> pairs;

  [[nodiscard]] std::size_t count(pairs::Judgement judgement) const;
  [[nodiscard]] bool fails(const FailOn& on) const;
};

/// "line 12: panda_link2 panda_link6 (Never): refuted, 0.0541 to 0.0812 deep at 0,0,…".
std::string line_of(const pairs::JudgedPair& pair);
/// A command that shows the contact of a refuted pair; empty: it is none.
std::string replay_of(const JudgedMatrix& judged, const pairs::JudgedPair& pair);
std::string summary_of(const JudgedMatrix& judged);
/// For reports and --json.
Json matrix_json(const JudgedMatrix& judged);
/// A test case for each pair: refuted ones fail, open ones are skipped, or fail as well; and, where
/// these fail, for each fault of the file.
std::string to_junit(const JudgedMatrix& judged, const FailOn& on);
/// SARIF 2.1.0: what is refuted, open or a fault of the file, each at its line; an error where it
/// fails, else a warning.
Json to_sarif(const JudgedMatrix& judged, const FailOn& on);

}  // namespace kaboum::tools

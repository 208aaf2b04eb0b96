#pragma once

#include <kaboum/bmesh/log.h>
#include <kaboum/certify/mesh.h>

#include <optional>
#include <string>
#include <vector>

#include "options.h"

/// What is said of bounding meshes, in words, as a report, and in files.
namespace kaboum::tools {

/// What was asked, of which file, and what was made.
struct DecimationCase {
  const DecimationOptions& asked;
  certify::MeshOptions options = {};
  std::vector<std::string> files = {};  ///< of each result; an empty name: none
  io::ReadResult input = {};            ///< its mesh is dropped once it is prepared
  std::vector<std::string> notes = {};  ///< of reading and preparing, and options without effect
  bmesh::Log log = {};                  ///< without the steps, unless they are asked for
  certify::BoundedMesh made = {};
  double seconds_read = 0, seconds_decimated = 0;  ///< of the process, when that was done

  [[nodiscard]] const geom::Prepared& original() const { return made.original; }
  [[nodiscard]] const certify::MeshSeries& series() const { return made.series; }
  [[nodiscard]] const std::optional<certify::WrapCertificate>& wrap() const { return made.wrap; }
  [[nodiscard]] const certify::MeshRequest& request() const { return options.request; }
  [[nodiscard]] bool outer() const { return request().direction == bmesh::Direction::Outer; }
};

/// Four digits.
std::string formatted(double x);

/// Says why float32 does not do: a note that double is written, or what to do instead.
/// @return whether double is written
bool say_shortage(const DecimationCase& run, const certify::Float32Shortage& shortage);

/// What was made, and how near it is, of one result.
std::string summary_of(const DecimationCase& run, std::size_t place);

/// A page that shows the results over the original. docs/pages.md.
std::string page_of(const DecimationCase& run);

/// Says what was made, what is claimed of it and what to beware of. @return the exit code
int conclude(const DecimationCase& run);

/// The report; but for the time it took the same for any number of threads.
Json report_of(const DecimationCase& run);

/// Refuses to write a file twice, or over the input.
void require_separate_files(const DecimationOptions& asked, const std::vector<std::string>& files);

/// Writes everything or nothing. The results come last, so that they are there only if everything
/// that belongs to them is.
void write_files(const DecimationCase& run);

}  // namespace kaboum::tools

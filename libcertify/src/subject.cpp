// What claims are about, counted and in words.

#include <kaboum/base/counted.h>
#include <kaboum/certify/subject.h>

#include <vector>

namespace kaboum::certify {

Subject subject_of(const geom::PreparationReport& report) {
  return {report.reversed_triangles, report.dropped_copies, report.dropped_sheets, report.holes};
}

std::string in_words(const Subject& s) {
  std::vector<std::string> changes;
  if (s.reversed_triangles > 0)
    changes.push_back("with " + counted(s.reversed_triangles, "triangle", "triangles") + " turned");
  if (s.dropped_copies > 0)
    changes.push_back("without " + counted(s.dropped_copies, "triangle", "triangles") +
                      " of copies");
  if (s.dropped_sheets > 0)
    changes.push_back("without " + counted(s.dropped_sheets, "triangle", "triangles") +
                      " of sheets, of which nothing is claimed");
  if (s.holes > 0)
    changes.push_back("with " + counted(s.holes, "hole", "holes") +
                      " filled, its solid the one so closed");
  std::string text = s.wrapped ? "a wrap round all triangles of the input" : "the input";
  for (std::size_t i = 0; i < changes.size(); ++i) text += (i == 0 ? ": " : "; ") + changes[i];
  return text;
}

}  // namespace kaboum::certify

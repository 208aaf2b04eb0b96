#pragma once

#include <kaboum/certify/link_verdict.h>
#include <kaboum/certify/robot.h>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "file_names.h"
#include "report.h"

/// Certified sets as scenes name them: their files, hashes, and what they were made from.
namespace kaboum::tools {

/// How a scene's sets are made.
struct SceneSetOptions {
  certify::SetRequest sets;             ///< of everything; direction apart
  bool visual = false;                  ///< of robots, shapes for drawing
  std::vector<std::string> links = {};  ///< of robots, only these; empty: all
  /// Of robots, links that get an inner set as well; empty: all; by default none.
  std::optional<std::vector<std::string>> inner_links = {};
  std::vector<std::string> packages;         ///< folders that package:// URIs are looked up in
  const certify::SetCache* cache = nullptr;  ///< null: none
  std::function<void(const std::string&)> progress;
};

/// The options that a set's record states (bcd-decompose's). @return one that is not known.
std::optional<std::string> apply_parameters(const std::string& parameters,
                                            SceneSetOptions& options);

/// Makes sets and keeps their containers until all are to be written.
class SceneSetMaker {
 public:
  /// @param scene  files are named as seen from its folder
  explicit SceneSetMaker(std::filesystem::path scene) : scene_(std::move(scene)) {}

  /// A robot of a scene with its links' sets, at the origin. Meshes that bound no solid are
  /// wrapped. Where a mesh cannot be held at all, its link has no set: whoever reads the scene
  /// refuses it until the link has one. @param folder  of the containers
  Json robot(const std::string& name, const std::string& file, const std::filesystem::path& folder,
             const SceneSetOptions& options);

  /// A mesh's set: {"file", "sha256", "made_from"}; null where no body lies within the mesh at this
  /// epsilon. @param container  to be written
  Json mesh(const std::string& name, const std::string& file,
            certify::SetRequest::Direction direction, const std::filesystem::path& container,
            const SceneSetOptions& options);

  /// Writes the containers, then the scene, each whole or not at all, if it can be read then but
  /// for links that could not be held, which have no set.
  /// @return the containers
  /// @throws Error{InvalidInput} where reading refuses it; nothing is written then.
  std::vector<std::filesystem::path> write(const Json& scene);

  std::set<std::string> inputs;
  std::vector<std::string> notes;
  std::vector<std::string> sizes;  ///< how large each thing is, to see that its unit is right
  /// Of links that are not held as asked for, each with its robot: said whatever is quiet.
  std::vector<std::string> bad_links;

 private:
  [[nodiscard]] std::string seen_from_scene(const std::filesystem::path& file) const;
  /// Puts inner sets into entries of links. @param names  of the files that are taken
  void add_inner_links(Json& links, const robot::RobotFile& file, certify::RobotRequest request,
                       const std::filesystem::path& folder, FileNames& names,
                       const SceneSetOptions& options);
  void add_bad_links(const std::string& name, const robot::Robot& robot,
                     const std::vector<certify::LinkVerdict>& verdicts);
  Json sources_of(std::uint32_t link, const std::vector<robot::LinkShape>& shapes,
                  const std::vector<certify::CertifiedLinkMesh>& meshes) const;
  Json keep(const std::filesystem::path& path, std::vector<char> bytes, const Json& made_from);
  void add_sources(Json& sources, const std::filesystem::path& file,
                   const certify::CertifiedFile& made) const;
  void say_size(const std::string& name, const geom::ConvexSet& set, const std::string& unit);

  std::filesystem::path scene_;
  std::map<std::string, std::vector<std::string>> kept_;  ///< by robot: links without a set
  std::vector<std::pair<std::filesystem::path, std::vector<char>>> files_;
};

}  // namespace kaboum::tools

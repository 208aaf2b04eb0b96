#pragma once

#include <kaboum/certify/link_verdict.h>
#include <kaboum/certify/robot.h>
#include <kaboum/io/file_names.h>
#include <kaboum/scene/scene_maker.h>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "yaml.h"

/// Certified sets as scenes name them: their files, hashes, and what they were made from.
namespace kaboum::scene {

/// The options that a set's record states (bcd-decompose's). @return one that is not known.
std::optional<std::string> apply_parameters(const std::string& parameters,
                                            SceneSetOptions& options);

/// Makes sets and keeps their containers until all are to be written.
class SetMaker {
 public:
  /// @param scene  files are named as seen from its folder
  explicit SetMaker(std::filesystem::path scene) : scene_(std::move(scene)) {}

  /// A robot of a scene with its links' sets, at the origin. Meshes that bound no solid are
  /// wrapped. Where a mesh cannot be held at all, its link has no set: whoever reads the scene
  /// refuses it until the link has one. @param folder  of the containers
  Json robot(const std::string& name, const std::string& file, const std::filesystem::path& folder,
             const SceneSetOptions& options);

  /// A robot of a scene with the sets that were made of its links, without inner ones.
  /// @param names  of files in the folder, to which its containers' are added
  Json robot_of(const std::string& name, const robot::RobotFile& file,
                const certify::CertifiedRobot& made, const std::filesystem::path& folder,
                io::FileNames& names);

  /// A set as an entry of a scene. @param name  of its object or region
  /// @param sources  that it was made from, itself first
  Json set_of(const std::string& name, const certify::CertifiedSet& set,
              const std::vector<std::filesystem::path>& sources,
              const std::filesystem::path& container);

  /// What is read of a scene that is to be written: files that are kept here, else those on disk.
  /// @param folder  of the scene
  [[nodiscard]] std::vector<char> read(const std::filesystem::path& folder,
                                       const std::string& file) const;

  /// A mesh's set: {"file", "sha256", "made_from"}; null where no body lies within the mesh at this
  /// epsilon. @param container  to be written
  Json mesh(const std::string& name, const std::string& file,
            certify::SetRequest::Direction direction, const std::filesystem::path& container,
            const SceneSetOptions& options);

  /// Writes the containers, then the scene, each whole or not at all, if it can be read then but
  /// for links that could not be held, which have no set.
  /// @return the containers, and what was noted
  /// @throws Error{InvalidInput} where reading refuses it; nothing is written then.
  MadeScene write(const Json& scene);
  /// What was noted, where nothing is written.
  MadeScene report();

  std::set<std::string> inputs;
  std::vector<std::string> notes;
  std::vector<std::string> sizes;  ///< how large each thing is, to see that its unit is right
  /// Of links that are not held as asked for, each with its robot: said whatever is quiet.
  std::vector<std::string> bad_links;

 private:
  [[nodiscard]] std::string seen_from_scene(const std::filesystem::path& file) const;
  /// Puts inner sets into entries of links. @param names  of the files that are taken
  void add_inner_links(Json& links, const robot::RobotFile& file, certify::RobotRequest request,
                       const std::filesystem::path& folder, io::FileNames& names,
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

}  // namespace kaboum::scene

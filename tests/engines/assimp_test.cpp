// assimp, which RViz, MoveIt and many viewers read meshes with, has the bodies of STL, OBJ and GLB
// files that were written.

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "expected.h"

namespace engines {
namespace {

/// The meshes of a node and those below, with their poses.
void collect(const aiNode& node, const aiMatrix4x4& above,
             std::vector<std::pair<aiMatrix4x4, unsigned>>& meshes) {
  const aiMatrix4x4 pose = above * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) meshes.emplace_back(pose, node.mMeshes[i]);
  for (unsigned i = 0; i < node.mNumChildren; ++i) collect(*node.mChildren[i], pose, meshes);
}

std::vector<Measure> measure_scene(const std::filesystem::path& file) {
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_JoinIdenticalVertices |
                                           aiProcess_SortByPType);
  std::vector<Measure> out;
  EXPECT_NE(scene, nullptr) << file << ": " << importer.GetErrorString();
  if (scene == nullptr) return out;
  std::vector<std::pair<aiMatrix4x4, unsigned>> meshes;
  collect(*scene->mRootNode, {}, meshes);
  for (const auto& [pose, m] : meshes) {
    const aiMesh& mesh = *scene->mMeshes[m];
    std::vector<Eigen::Vector3d> corners;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned c = 0; c < mesh.mFaces[f].mNumIndices; ++c) {
        const aiVector3D v = pose * mesh.mVertices[mesh.mFaces[f].mIndices[c]];
        corners.emplace_back(v.x, v.y, v.z);
      }
    out.push_back(measure(file.filename().string() + " " + mesh.mName.C_Str(), corners));
  }
  return out;
}

TEST(Assimp, HasTheFilesOfRobots) {
  for (const std::filesystem::path& urdf : outputs())
    for (const Link& link : read_urdf(urdf).links)
      for (const Shape& shape : link.collisions)
        if (!shape.mesh.empty())
          expect_same(shape.file.string(),
                      {measure(shape.mesh, corners_of_stl(shape.file, Eigen::Vector3d::Ones(),
                                                          Eigen::Isometry3d::Identity()))},
                      measure_scene(shape.file));
}

/// One set in three formats.
TEST(Assimp, HasTheBodiesOfContainers) {
  const std::filesystem::path folder = std::filesystem::path(KABOUM_ENGINE_OUTPUTS) / "set";
  std::vector<Measure> expected;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "parts"))
    if (entry.path().extension() == ".stl")
      expected.push_back(measure(
          entry.path().filename(),
          corners_of_stl(entry.path(), Eigen::Vector3d::Ones(), Eigen::Isometry3d::Identity())));
  ASSERT_GT(expected.size(), 1U);
  for (const char* file : {"parts.glb", "parts.obj"})
    expect_same(file, expected, measure_scene(folder / file));
}

/// A viewer shows neighbours in different colours.
TEST(Assimp, HasColoursOfBodies) {
  Assimp::Importer importer;
  const auto file = std::filesystem::path(KABOUM_ENGINE_OUTPUTS) / "set" / "parts.glb";
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  ASSERT_NE(scene, nullptr);
  std::vector<aiColor4D> colours;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    aiColor4D colour;
    const aiMaterial& material = *scene->mMaterials[scene->mMeshes[m]->mMaterialIndex];
    ASSERT_EQ(material.Get(AI_MATKEY_BASE_COLOR, colour), aiReturn_SUCCESS);
    for (const aiColor4D& other : colours) EXPECT_NE(colour, other);
    colours.push_back(colour);
  }
  EXPECT_EQ(colours.size(), 2U);
}

/// Files of links by the report beside a robot; none of a swept volume.
std::map<std::string, std::string> containers(const std::filesystem::path& folder) {
  std::map<std::string, std::string> out;
  std::ifstream report(folder / "report.json");
  if (!report) return out;
  const auto json = nlohmann::json::parse(report);
  for (const auto& link : json.at("links")) out[link.at("link")] = link.at("file");
  return out;
}

/// A link's container holds what the URDF's bodies are in the frame of the link, and hardly more.
TEST(Assimp, HasTheBodiesOfLinks) {
  std::size_t links = 0;
  for (const std::filesystem::path& urdf : outputs()) {
    const std::map<std::string, std::string> files = containers(urdf.parent_path());
    for (const Link& link : read_urdf(urdf).links) {
      if (!files.contains(link.name)) continue;
      const std::filesystem::path file = urdf.parent_path() / files.at(link.name);
      const std::vector<Measure> loaded = measure_scene(file);
      ASSERT_EQ(loaded.size(), link.collisions.size()) << file;
      const Eigen::Isometry3d back = link.pose.inverse();
      for (std::size_t i = 0; i < loaded.size(); ++i) {
        const Shape& shape = link.collisions[i];
        if (shape.mesh.empty()) continue;
        const Measure e =
            measure(shape.mesh, corners_of_stl(shape.file, shape.scale, back * shape.pose));
        EXPECT_GE(loaded[i].volume, e.volume) << file << ": " << shape.mesh;
        EXPECT_LE(loaded[i].volume, e.volume * (1 + 1e-4)) << file << ": " << shape.mesh;
        for (std::size_t d = 0; d < e.reach.size(); ++d) {
          EXPECT_GE(loaded[i].reach[d], e.reach[d] - 1e-15) << file << ": " << shape.mesh;
          EXPECT_LE(loaded[i].reach[d], e.reach[d] + 1e-5) << file << ": " << shape.mesh;
        }
      }
      ++links;
    }
  }
  EXPECT_GT(links, 2U);
}

}  // namespace
}  // namespace engines

#pragma once

#include <string_view>

/// Version words of the cache: each is part of the keys of what it stands for, so that a result of
/// other code is not found. Each changes whenever that may come out otherwise for the same request;
/// tests/certify/cache_words_test.cpp has it beside the hash of what comes out.
namespace kaboum::certify::cache_words {

/// What libverify decides, for all that is kept with a claim.
inline constexpr std::string_view kDecisions = "decisions 4";
/// Bodies of sets.
inline constexpr std::string_view kSets = "planes 34";
/// Sets of spheres, beside it.
inline constexpr std::string_view kBalls = "parallel bodies 3";
/// Inner sets of spheres, beside it.
inline constexpr std::string_view kInnerBalls = "cubes 1";
/// Sets of capsules and boxes, beside it.
inline constexpr std::string_view kSimple = "capsules and boxes 2";
/// Bytes of their containers.
inline constexpr std::string_view kContainers = "coloured";
/// Polytopes of links' bodies, and the bytes of their containers.
inline constexpr std::string_view kLinks = "3, coloured";
/// Meshes round the meshes of links.
inline constexpr std::string_view kEnclosures = "distance 9";
/// Triangles, notes and units that readers of libio give for the bytes of a file.
inline constexpr std::string_view kReaders = "4";

}  // namespace kaboum::certify::cache_words

#pragma once

#include <kaboum/certify/enclosure.h>

#include <string>
#include <utility>

/// Enclosing meshes in words.
namespace kaboum::tools {

/// What is left open, or does not hold; empty: nothing. And the exit code that it gives.
std::pair<std::string, int> shortfall(const certify::EnclosureCertificate& certificate);

std::string summary(const certify::EnclosureCertificate& certificate);

}  // namespace kaboum::tools

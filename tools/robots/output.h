#pragma once

#include <kaboum/base/notes.h>
#include <kaboum/robot_folder/robot_writer.h>

#include <string>
#include <utility>
#include <vector>

#include "common/report.h"
#include "options.h"

/// What tools that make robots with other shapes say of the folders that they write.
namespace kaboum::tools {

/// Refuses an output that is no folder.
/// @throws Error{InvalidArgument}
void require_robot_folder(const std::string& output, const std::string& output_format);

/// What a folder is to hold, as a command line says it.
robot_folder::FolderOptions folder_options(const RobotOptions& options);

/// Notes on files, for later.
robot_folder::FileNote note_in(Notes& notes);

/// Notes on meshes, for the terminal: warnings, of a large epsilon the first ones, and how many
/// others there are; with --verbose all.
void say_notes(const RobotOptions& options, bool quiet, const Notes& notes);

/// Says what a user should know of the folder.
void say(const robot_folder::RobotWriter& writer, const RobotOptions& options, bool quiet);
/// What reports say of it: urdf, documents, stale, links_without_shapes.
Json report_of(const robot_folder::RobotWriter& writer);

}  // namespace kaboum::tools

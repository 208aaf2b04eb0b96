#pragma once

#include <kaboum/execution/plan_page.h>
#include <kaboum/page/event_server.h>
#include <kaboum/world/scene.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

/// Runs of plans by robots as people see them: the scene, where the plan is, what is known, and why
/// it was planned again. docs/pages.md.
namespace kaboum::execution {

/// The lines of a journal (docs/planning/drivers.md).
/// @throws Error{InvalidInput} for files that are no journal
std::vector<std::string> journal_lines(const std::string& file);

/// What a page gets of a line of a journal: the same, with what was told and heard as JSON rather
/// than as text, trajectories and executed motions by at most 25 positions a second, and a drawing
/// of each plan; of one with more than 2,000 nodes their number, "undrawn". A line that is none of
/// a journal is given back as {"unread": true}.
std::string run_event(const std::string& line);

/// The page of a run that is over: one file.
/// @param scene  where the world was read from
/// @param lines  of its journal
/// @param packages  folders that package:// URIs are looked up in
PlanPage run_page(const world::World& world, const std::filesystem::path& scene,
                  const std::vector<std::string>& lines,
                  const std::vector<std::string>& packages = {});

/// A run that browsers on this machine follow while it goes on, by page::EventServer.
class LiveRun {
 public:
  /// Serves the page. @param port  of 127.0.0.1; 0: a free one
  /// @throws as EventServer
  LiveRun(const world::World& world, const std::filesystem::path& scene, std::uint16_t port,
          const std::vector<std::string>& packages = {});

  [[nodiscard]] const std::string& address() const { return server_->address(); }
  [[nodiscard]] const Notes& notes() const { return notes_; }
  /// DriverOptions::noted.
  void note(const std::string& line) { server_->publish(line); }
  /// As EventServer::finish.
  void finish(double patience, double seconds) { server_->finish(patience, seconds); }
  [[nodiscard]] std::string failure() const { return server_->failure(); }

 private:
  Notes notes_;
  std::unique_ptr<page::EventServer> server_;
};

}  // namespace kaboum::execution

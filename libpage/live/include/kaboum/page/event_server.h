#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace kaboum::page {

/// Options of what serves a page.
struct EventServerOptions {
  std::uint16_t port = 0;  ///< of 127.0.0.1; 0: a free one
  std::string page = {};   ///< HTML
  /// Makes an event of what was published; called by the server's thread. Empty: as it is.
  std::function<std::string(const std::string&)> event = {};
  /// Bytes of what is published and of events that are kept. Later ones are dropped, and the last
  /// event says so.
  std::size_t most_bytes = std::size_t{1} << 29U;
};

/// A web server for one page and the events that it follows, for browsers on this machine.
///
/// One thread, which is behind all others where there is more to do than cores for it. It listens
/// on 127.0.0.1 alone, and answers GET and HEAD of its address, and of "events" below it
/// (server-sent events, from the first one on or after the header Last-Event-ID). The address has a
/// secret of 128 bits: other users of the machine do not know it. It reads requests only, and
/// nothing of them but the first line and the headers Host, Origin, Sec-Fetch-Site and
/// Last-Event-ID. Who has events of an earlier server at the port is told that there are none
/// (204). A request to another host's name is refused: pages of others cannot read this one by
/// having their name lead here. At most 64 connections are open; a request has 8 KiB and 5 s, and
/// who takes nothing of what there is for 20 s is cut off.
class EventServer {
 public:
  /// Listens from here on.
  /// @throws Error{OutputFailed} for a port that is in use, or that may not be used
  explicit EventServer(EventServerOptions options);
  /// Ends all connections.
  ~EventServer();
  EventServer(const EventServer&) = delete;
  EventServer& operator=(const EventServer&) = delete;

  /// "http://127.0.0.1:8765/4f…e/".
  [[nodiscard]] const std::string& address() const;
  /// Adds an event: one line. It waits for nobody.
  void publish(std::string line);
  /// Nothing is published any more. Waits until everyone who follows has all events, at most
  /// `patience` seconds; and serves the page for `seconds` in any case.
  void finish(double patience, double seconds = 0);
  /// Why events are not served any more, in words; empty: they are.
  [[nodiscard]] std::string failure() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kaboum::page

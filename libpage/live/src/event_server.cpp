// A web server of one page and its events: one thread, no socket that is waited for.

#include <arpa/inet.h>
#include <fcntl.h>
#include <kaboum/base/error.h>
#include <kaboum/page/event_server.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <list>
#include <mutex>
#include <optional>
#include <random>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace kaboum::page {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t kMostConnections = 64;
constexpr std::size_t kMostRequest = 8192;                // bytes, to the end of the headers
constexpr std::size_t kMostIgnored = 65536;               // bytes that are read after that
constexpr std::size_t kMostSent = std::size_t{1} << 20U;  // bytes to one connection at a time
constexpr int kSystemsBuffer = 1 << 16;                   // bytes that were sent and not taken
constexpr int kMostAccepted = 16;                         // connections at a time
constexpr auto kRequestTime = seconds(5);                 // for a request as a whole
constexpr auto kStallTime = seconds(20);                  // without anything being taken
constexpr auto kLingerTime = seconds(1);       // for the other side to close after an answer
constexpr auto kQuietTime = seconds(15);       // until a sign of life
constexpr auto kRestTime = milliseconds(100);  // where no connection can be opened

constexpr const char* kCommonHeaders =
    "Connection: close\r\n"
    "Cache-Control: no-store\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n";
// The page's scripts and styles are in it; it may ask this server for events, and nobody for
// anything else.
constexpr const char* kPageHeaders =
    "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; connect-src 'self'; img-src data:; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'\r\n"
    "X-Frame-Options: DENY\r\n";

/// What a request asks for, or the answer that refuses it.
struct Request {
  int refused = 0;  ///< a status; 0: it is not
  bool head = false, events = false;
  std::uint64_t after = 0;  ///< how many events it has already
  std::string run = {};     ///< of which run these are; empty: it has none
};

const char* reason_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 408:
      return "Request Timeout";
    case 421:
      return "Misdirected Request";
    case 431:
      return "Request Header Fields Too Large";
    case 503:
      return "Service Unavailable";
    default:
      return "HTTP Version Not Supported";
  }
}

std::string refusal(int status) {
  const std::string text = std::to_string(status) + " " + reason_of(status);
  return "HTTP/1.1 " + text +
         "\r\nContent-Type: text/plain\r\nContent-Length: " + std::to_string(text.size() + 1) +
         "\r\n" + (status == 405 ? "Allow: GET, HEAD\r\n" : "") + kCommonHeaders + "\r\n" + text +
         "\n";
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower, lower);
}

bool is_token(std::string_view text) {
  constexpr std::string_view kOthers = "!#$%&'*+-.^_`|~";
  return !text.empty() && std::ranges::all_of(text, [&](char c) {
    return (lower(c) >= 'a' && lower(c) <= 'z') || (c >= '0' && c <= '9') ||
           kOthers.find(c) != std::string_view::npos;
  });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// A secret of 128 bits, in 32 digits.
std::string random_secret() {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::random_device device;
  std::string out;
  for (int word = 0; word < 4; ++word) {
    const auto bits = static_cast<std::uint32_t>(device());
    for (unsigned shift = 0; shift < 32; shift += 4) out += kDigits[(bits >> shift) & 15U];
  }
  return out;
}

/// Whether a text begins with a secret, in a time that does not tell where the two differ.
bool begins_with(std::string_view text, std::string_view secret) {
  if (text.size() < secret.size()) return false;
  unsigned differ = 0;
  for (std::size_t i = 0; i < secret.size(); ++i)
    differ |= static_cast<unsigned char>(text[i]) ^ static_cast<unsigned char>(secret[i]);
  return differ == 0;
}

/// @param text  a request to the end of its headers, both ends of a line included
/// @param hosts  names that this server has, "127.0.0.1:8765"
/// @param folder  of the page, which only those know who were told the address: "/4f…e/"
Request read_request(std::string_view text, const std::array<std::string, 2>& hosts,
                     std::string_view folder) {
  const auto refuse = [](int status) { return Request{.refused = status}; };
  const auto line = [&] {
    const std::size_t end = text.find("\r\n");
    const std::string_view out = text.substr(0, end);
    text.remove_prefix(end + 2);
    return out;
  };
  const std::string_view first = line();
  const std::size_t method_end = first.find(' '), target_end = first.rfind(' ');
  if (method_end == std::string_view::npos || target_end <= method_end) return refuse(400);
  const std::string_view method = first.substr(0, method_end),
                         target = first.substr(method_end + 1, target_end - method_end - 1),
                         version = first.substr(target_end + 1);
  const bool is_printed = std::ranges::all_of(target, [](char c) { return c > ' ' && c <= '~'; });
  if (!is_token(method) || !target.starts_with('/') || !is_printed) return refuse(400);
  if (version != "HTTP/1.1") return refuse(version.starts_with("HTTP/") ? 505 : 400);
  Request out;
  bool has_host = false, crosses = false;
  for (std::string_view header = line(); !header.empty(); header = line()) {
    const std::size_t colon = header.find(':');
    if (colon == std::string_view::npos || !is_token(header.substr(0, colon))) return refuse(400);
    const std::string_view name = header.substr(0, colon),
                           value = trimmed(header.substr(colon + 1));
    if (std::ranges::any_of(value,
                            [](char c) { return (c >= 0 && c < ' ' && c != '\t') || c == '\x7f'; }))
      return refuse(400);
    if (same_name(name, "host")) {
      if (has_host) return refuse(400);
      has_host = true;
      if (std::ranges::find(hosts, value) == hosts.end()) return refuse(421);
    } else if (same_name(name, "origin")) {
      if (!value.starts_with("http://") || std::ranges::find(hosts, value.substr(7)) == hosts.end())
        return refuse(403);
    } else if (same_name(name, "transfer-encoding") ||
               (same_name(name, "content-length") && value != "0")) {
      return refuse(400);
    } else if (same_name(name, "last-event-id")) {
      const std::size_t dash = value.find('-');
      if (dash == 0 || dash == std::string_view::npos) return refuse(400);
      out.run = value.substr(0, dash);
      const auto [end, error] =
          std::from_chars(value.data() + dash + 1, value.data() + value.size(), out.after);
      if (error != std::errc() || end != value.data() + value.size()) return refuse(400);
    } else if (same_name(name, "sec-fetch-site")) {
      // Of pages of others nothing is asked for in the background.
      if (value == "cross-site") crosses = true;
    }
  }
  if (!has_host) return refuse(400);
  if (method != "GET" && method != "HEAD") return refuse(405);
  if (!begins_with(target, folder)) return refuse(404);
  const std::string_view name = target.substr(folder.size());
  if (!name.empty() && name != "events") return refuse(404);
  out.head = method == "HEAD";
  out.events = name == "events";
  if (out.events && crosses) return refuse(403);
  return out;
}

/// A descriptor that is closed.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

struct Connection {
  explicit Connection(Descriptor s) : socket(std::move(s)) {}
  enum class Phase : char {
    Asks,     ///< its request is read
    Gets,     ///< an answer is sent
    Follows,  ///< events are sent
    Closes,   ///< all is sent
    Over
  };
  Descriptor socket;
  Phase phase = Phase::Asks;
  Clock::time_point until = Clock::now() + kRequestTime;  ///< it is cut off then
  std::string request = {}, head = {};
  std::string_view body = {};  ///< of the answer; the server's
  std::size_t sent = 0;        ///< of head and body; of followers: of the head, then of the event
  std::uint64_t event = 0;     ///< the one that is sent
  bool beating = false;        ///< a sign of life is sent before it
  std::size_t ignored = 0;
};

}  // namespace

struct EventServer::Data {
  explicit Data(EventServerOptions o)
      : options(std::move(o)),
        listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)),
        wake(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    const auto fail = [&](const std::string& what) {
      throw Error(ErrorCode::OutputFailed, "port " + std::to_string(options.port) +
                                               " of 127.0.0.1 cannot be served: " + what);
    };
    if (listener.number() < 0 || wake.number() < 0) fail(std::strerror(errno));
    const int on = 1;
    setsockopt(listener.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_port = htons(options.port);
    name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof name;
    // NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): addresses are given so
    if (bind(listener.number(), reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0)
      fail(errno == EADDRINUSE ? "another program uses it; choose another one, or 0 for a free one"
                               : std::strerror(errno));
    if (listen(listener.number(), 64) != 0) fail(std::strerror(errno));
    if (getsockname(listener.number(), reinterpret_cast<sockaddr*>(&name), &size) != 0)
      fail(std::strerror(errno));
    // NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
    const std::string port = std::to_string(ntohs(name.sin_port));
    folder = "/" + random_secret() + "/";
    address = "http://127.0.0.1:" + port + folder;
    // Of port 80 browsers do not say the number.
    const std::string end = port == "80" ? "" : ":" + port;
    hosts = {"127.0.0.1" + end, "localhost" + end};
    run = std::to_string(std::random_device()());
    thread = std::thread([this] { serve(); });
  }

  ~Data() {
    {
      const std::lock_guard lock(mutex);
      ended = true;
    }
    stir();
    thread.join();
  }

  void stir() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t said = ::write(wake.number(), &one, sizeof one);
  }

  /// The thread. What fails here ends the service, and nothing else.
  void serve() {
    // Of threads of a process, Linux has each one's own.
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 15);
    std::string why;
    try {
      while (go_on()) take_turn();
    } catch (const std::exception& e) {
      why = e.what();
    } catch (...) {
      why = "unknown";
    }
    connections.clear();
    const std::lock_guard lock(mutex);
    failed = why;
    over = true;
    all_sent.notify_all();
  }

  bool go_on() {
    const std::lock_guard lock(mutex);
    return !ended;
  }

  void take_turn() {
    std::vector<pollfd> polled{{wake.number(), POLLIN, 0}};
    const bool accepts = Clock::now() >= resting;
    polled.push_back({accepts ? listener.number() : -1, POLLIN, 0});
    for (const Connection& c : connections) {
      // What comes while an answer is sent is read when that is done.
      const int in = c.phase == Connection::Phase::Gets ? 0 : POLLIN;
      polled.push_back(
          {c.socket.number(), static_cast<short>(in | (has_more(c) ? POLLOUT : 0)), 0});
    }
    const int ready = poll(polled.data(), polled.size(), wait_of());
    if (ready < 0 && errno != EINTR && errno != EAGAIN)
      throw Error(ErrorCode::OutputFailed, std::strerror(errno));
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t stirred = ::read(wake.number(), &count, sizeof count);
    // Who has all so far has the whole time for what comes now, however long that took to make.
    std::vector<Connection*> idle;
    for (Connection& c : connections)
      if (c.phase == Connection::Phase::Follows && !has_more(c)) idle.push_back(&c);
    const std::size_t known = events.size();
    take_events();
    const auto now = Clock::now();
    if (events.size() > known)
      for (Connection* c : idle) c->until = now + kStallTime;
    std::size_t i = 2;
    for (Connection& c : connections) {
      attend(c, ready > 0 ? polled[i].revents : short{0}, now);
      ++i;
    }
    std::erase_if(connections,
                  [](const Connection& c) { return c.phase == Connection::Phase::Over; });
    if (accepts && ready > 0 && polled[1].revents != 0) accept_all();
    const bool done = std::ranges::none_of(connections, [&](const Connection& c) {
      return c.phase != Connection::Phase::Asks && has_more(c);
    });
    const std::lock_guard lock(mutex);
    if (done && finished && pending.empty()) {
      sent_all = true;
      all_sent.notify_all();
    } else {
      sent_all = false;
    }
  }

  /// What was published becomes events.
  void take_events() {
    std::deque<std::string> lines;
    {
      const std::lock_guard lock(mutex);
      lines.swap(pending);
    }
    std::size_t was = 0, is = 0;
    for (std::string& line : lines) {
      was += line.size();
      std::string event = options.event ? options.event(line) : std::move(line);
      std::ranges::replace(event, '\n', ' ');
      events.push_back("id: " + run + "-" + std::to_string(events.size() + 1) + "\ndata: " + event +
                       "\n\n");
      is += events.back().size();
    }
    if (lines.empty()) return;
    const std::lock_guard lock(mutex);
    bytes = bytes - std::min(bytes, was) + is;
  }

  /// Milliseconds until something is due. -1: nothing is
  [[nodiscard]] int wait_of() const {
    std::optional<Clock::time_point> first;
    const auto consider = [&](Clock::time_point then) {
      first = first ? std::min(*first, then) : then;
    };
    if (Clock::now() < resting) consider(resting);
    for (const Connection& c : connections) consider(c.until);
    if (!first) return -1;
    const auto left = std::chrono::duration_cast<milliseconds>(*first - Clock::now()).count();
    return static_cast<int>(std::clamp<std::int64_t>(left + 1, 0, 60'000));
  }

  void accept_all() {
    for (int k = 0; k < kMostAccepted; ++k) {
      Descriptor socket(accept4(listener.number(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
      if (socket.number() < 0) {
        if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM)
          resting = Clock::now() + kRestTime;
        return;
      }
      if (connections.size() >= kMostConnections) {
        const std::string text = refusal(503);
        [[maybe_unused]] const ssize_t sent =
            send(socket.number(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        continue;
      }
      // Who takes nothing keeps no more of the system's memory than that.
      setsockopt(socket.number(), SOL_SOCKET, SO_SNDBUF, &kSystemsBuffer, sizeof kSystemsBuffer);
      connections.emplace_back(std::move(socket));
    }
  }

  [[nodiscard]] bool has_more(const Connection& c) const {
    using Phase = Connection::Phase;
    if (c.phase == Phase::Gets) return true;
    return c.phase == Phase::Follows && (!c.head.empty() || c.beating || c.event < events.size());
  }

  void attend(Connection& c, short ready, Clock::time_point now) {
    using Phase = Connection::Phase;
    if ((ready & (POLLERR | POLLNVAL)) != 0) {
      c.phase = Phase::Over;
      return;
    }
    if ((ready & (POLLIN | POLLHUP)) != 0) read_from(c, now);
    if ((ready & POLLOUT) != 0 && has_more(c)) write_to(c, now);
    if (c.phase == Phase::Over || now < c.until) return;
    if (c.phase == Phase::Follows && !has_more(c)) {
      c.beating = true;
      c.until = now + kStallTime;
    } else if (c.phase == Phase::Asks && !c.request.empty()) {
      answer(c, refusal(408), {}, now);
    } else {
      c.phase = Phase::Over;
    }
  }

  void read_from(Connection& c, Clock::time_point now) {
    using Phase = Connection::Phase;
    char part[4096];
    const ssize_t got = recv(c.socket.number(), part, sizeof part, 0);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (got <= 0) {
      c.phase = Phase::Over;
      return;
    }
    if (c.phase != Phase::Asks) {
      c.ignored += static_cast<std::size_t>(got);
      if (c.ignored > kMostIgnored) c.phase = Phase::Over;
      return;
    }
    c.request.append(part, static_cast<std::size_t>(got));
    const std::size_t end = c.request.find("\r\n\r\n");
    if (end == std::string::npos || end + 4 > kMostRequest) {
      if (c.request.size() > kMostRequest) answer(c, refusal(431), {}, now);
      return;
    }
    const Request request =
        read_request(std::string_view(c.request).substr(0, end + 4), hosts, folder);
    if (request.refused != 0) {
      answer(c, refusal(request.refused), {}, now);
      return;
    }
    if (request.events && !request.run.empty() && request.run != run) {
      // A page of an earlier run at this port: browsers ask no more then.
      answer(c, std::string("HTTP/1.1 204 No Content\r\n") + kCommonHeaders + "\r\n", {}, now);
      return;
    }
    std::string head = "HTTP/1.1 200 OK\r\nContent-Type: ";
    if (request.events) {
      head += std::string("text/event-stream\r\n") + kCommonHeaders + "\r\n";
    } else {
      head += "text/html; charset=utf-8\r\nContent-Length: " + std::to_string(options.page.size()) +
              "\r\n" + kPageHeaders + kCommonHeaders + "\r\n";
    }
    answer(c, std::move(head), request.head || request.events ? std::string_view() : options.page,
           now);
    if (request.events && !request.head) {
      c.phase = Phase::Follows;
      c.event = std::min<std::uint64_t>(request.after, events.size());
    }
  }

  static void answer(Connection& c, std::string head, std::string_view body,
                     Clock::time_point now) {
    c.phase = Connection::Phase::Gets;
    c.request = {};
    c.head = std::move(head);
    c.body = body;
    c.sent = 0;
    c.until = now + kStallTime;
  }

  /// Sends a part. @return whether all of it was taken; @param sent  grows by what was
  bool send_part(Connection& c, std::string_view text, std::size_t& left, Clock::time_point now) {
    while (c.sent < text.size() && left > 0) {
      const ssize_t went = send(c.socket.number(), text.data() + c.sent,
                                std::min(text.size() - c.sent, left), MSG_NOSIGNAL);
      if (went <= 0) {
        if (went < 0 && errno == EINTR) continue;
        if (went < 0 && errno != EAGAIN) c.phase = Connection::Phase::Over;
        return false;
      }
      c.sent += static_cast<std::size_t>(went);
      left -= static_cast<std::size_t>(went);
      c.until = now + kStallTime;
    }
    return c.sent == text.size();
  }

  void write_to(Connection& c, Clock::time_point now) {
    using Phase = Connection::Phase;
    constexpr std::string_view kBeat = ":\n\n";
    std::size_t left = kMostSent;
    if (!c.head.empty()) {
      if (!send_part(c, c.head, left, now)) return;
      c.sent = 0;
      c.head = {};
    }
    if (c.phase == Phase::Gets) {
      if (!send_part(c, c.body, left, now)) return;
      shutdown(c.socket.number(), SHUT_WR);
      c.phase = Phase::Closes;
      c.until = now + kLingerTime;
      return;
    }
    if (c.beating) {
      if (!send_part(c, kBeat, left, now)) return;
      c.sent = 0;
      c.beating = false;
    }
    while (c.event < events.size()) {
      if (!send_part(c, events[c.event], left, now)) return;
      c.sent = 0;
      ++c.event;
    }
    c.until = now + kQuietTime;
  }

  EventServerOptions options;
  Descriptor listener, wake;
  std::array<std::string, 2> hosts;
  std::string run;  ///< told by ids of events: another server at the port has another one
  std::string folder, address;

  // Of the thread.
  std::list<Connection> connections;
  std::deque<std::string> events;            ///< as they are sent
  Clock::time_point resting = Clock::now();  ///< until then no connection is opened

  // Of both.
  mutable std::mutex mutex;
  std::condition_variable all_sent;
  std::deque<std::string> pending;  ///< lines that are no events yet
  std::size_t bytes = 0;            ///< of these and of events
  bool ended = false, finished = false, sent_all = false, over = false, full = false;
  std::string failed;

  std::thread thread;
};

EventServer::EventServer(EventServerOptions options)
    : data_(std::make_unique<Data>(std::move(options))) {}

EventServer::~EventServer() = default;

const std::string& EventServer::address() const { return data_->address; }

void EventServer::publish(std::string line) {
  {
    const std::lock_guard lock(data_->mutex);
    if (data_->finished || data_->full || data_->over) return;
    data_->bytes += line.size();
    data_->full = data_->bytes > data_->options.most_bytes;
    data_->pending.push_back(data_->full ? R"({"dropped":true})" : std::move(line));
  }
  data_->stir();
}

void EventServer::finish(double patience, double seconds) {
  using Seconds = std::chrono::duration<double>;
  std::unique_lock lock(data_->mutex);
  data_->finished = true;
  data_->sent_all = false;
  data_->stir();
  const auto start = Clock::now();
  data_->all_sent.wait_for(lock, Seconds(patience), [&] { return data_->sent_all || data_->over; });
  data_->all_sent.wait_until(lock,
                             start + std::chrono::duration_cast<Clock::duration>(Seconds(seconds)),
                             [&] { return data_->over; });
}

std::string EventServer::failure() const {
  const std::lock_guard lock(data_->mutex);
  return data_->failed;
}

}  // namespace kaboum::page

// A robot driver: lines of JSON with a program, or with the journal of a run.

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>
#include <kaboum/execution/robot_driver.h>
#include <kaboum/external/line_channel.h>

#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>

#include "finger_motion.h"
#include "journal.h"

namespace kaboum::execution {
namespace {

using nlohmann::json;
using Kind = DriverStop::Kind;
using external::LineSocket;

constexpr std::size_t kExcerpt = 200;    // characters of a line in a message
constexpr double kLastWords = 0.2;       // for telling a driver to stop [s]
constexpr double kRoundedFinger = 1e-9;  // of an answer in decimals [rad or length]
constexpr double kSlower = 1.5;          // a motion may take so many times as long as it is

/// With a sign in place of what is no UTF-8.
std::string utf8(const std::string& text) { return json::parse(dump(text)).get<std::string>(); }

/// The beginning of a line as a message may have it.
std::string excerpt(const std::string& line) {
  std::string begin = line.substr(0, kExcerpt);
  for (char& c : begin)
    if ((c >= 0 && c < ' ') || c == '\x7f') c = '?';
  std::string out = "'";
  out += utf8(begin);
  out += line.size() <= kExcerpt ? "'" : "…'";
  return out;
}

/// A line of a driver, or why there is none.
struct Heard {
  std::string line;
  std::optional<Kind> none;
  std::string why;
};

/// The other side of a driver's lines.
class Side {
 public:
  Side() = default;
  virtual ~Side() = default;
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;
  /// What comes first: the driver's own line, before it is told anything.
  virtual Heard hear(double seconds) = 0;
  /// nullopt: it was told. Else why not.
  virtual std::optional<Heard> tell(const std::string& line) = 0;
  /// What is there already, of a line.
  virtual std::optional<std::string> unasked() = 0;
  virtual void end(bool finished) = 0;
};

/// A length of time, as people write it.
std::string in_words(double seconds) {
  std::ostringstream out;
  out << seconds;
  return out.str();
}

class Program final : public Side {
 public:
  explicit Program(const std::string& command) : channel_(command) {}

  Heard hear(double seconds) override {
    const double most = seconds;
    Heard out;
    switch (channel_.lines().read_line(out.line, seconds)) {
      case LineSocket::ReadOutcome::Line:
        // A journal could not have it as it was.
        if (utf8(out.line) == out.line) return out;
        finish();
        return {"", Kind::Nonsense, "it answered what is no UTF-8: " + excerpt(out.line)};
      case LineSocket::ReadOutcome::End:
        return {"", Kind::Ended, finish() + " without an answer"};
      case LineSocket::ReadOutcome::Late:
        finish();
        return {"", Kind::Late, "no answer within " + in_words(most) + " s; it was ended"};
      case LineSocket::ReadOutcome::TooLong:
        break;
    }
    finish();
    return {"", Kind::Nonsense, "it answered with a line of more than 16 MiB"};
  }

  std::optional<Heard> tell(const std::string& line) override {
    double seconds = 10;
    if (channel_.lines().write_line(line, seconds)) return std::nullopt;
    return Heard{"", Kind::Ended, finish() + ", or reads nothing"};
  }

  std::optional<std::string> unasked() override { return channel_.lines().take_what_is_there(); }

  void end(bool finished) override {
    if (ended_) return;
    double seconds = kLastWords;
    if (!finished) channel_.lines().write_line(R"({"do":"stop"})", seconds);
    finish();
  }

 private:
  /// Ends it. @return in words how it ended
  std::string finish() {
    ended_ = true;
    return channel_.end();
  }

  external::LineChannel channel_;
  bool ended_ = false;
};

/// What a journal says.
class Replayed final : public Side {
 public:
  explicit Replayed(std::string file) : file_(std::move(file)) {
    read_journal(file_, [this](const std::string& /*line*/, json entry, std::size_t number) {
      if (number == 1) return;
      for (const char* key : {"told", "heard", "unasked", "none", "why"})
        if (entry.contains(key) && !entry[key].is_string())
          refuse_journal(file_, number, "'" + std::string(key) + "' is no text");
      for (const char* key : {"told", "heard", "unasked", "none"})
        if (entry.contains(key)) {
          entries_.push_back(std::move(entry));
          return;
        }
    });
  }

  Heard hear(double /*seconds*/) override {
    if (entries_.empty()) return {"", Kind::Ended, "the journal ends here"};
    const json entry = std::move(entries_.front());
    entries_.pop_front();
    if (entry.contains("heard")) return {entry["heard"].get<std::string>(), {}, {}};
    if (entry.contains("none")) {
      for (const Kind kind : {Kind::Ended, Kind::Late, Kind::Nonsense})
        if (entry["none"] == name_of(kind)) return {"", kind, entry.value("why", "")};
    }
    throw Error(ErrorCode::InvalidInput, file_ + ": the run that is repeated is told less: " +
                                             excerpt(dump(entry)) + " would be next");
  }

  std::optional<Heard> tell(const std::string& line) override {
    if (entries_.empty()) return Heard{"", Kind::Ended, "the journal ends here"};
    const json entry = std::move(entries_.front());
    entries_.pop_front();
    if (entry.contains("told") && entry["told"] == line) return std::nullopt;
    throw Error(ErrorCode::InvalidInput,
                file_ + ": the run that is repeated is told something else: " + excerpt(line) +
                    ", in the journal " +
                    (entry.contains("told") ? excerpt(entry["told"].get<std::string>())
                                            : excerpt(dump(entry))));
  }

  std::optional<std::string> unasked() override {
    if (entries_.empty() || !entries_.front().contains("unasked")) return std::nullopt;
    const json entry = std::move(entries_.front());
    entries_.pop_front();
    return entry["unasked"].get<std::string>();
  }

  void end(bool /*finished*/) override {}

 private:
  std::string file_;
  std::deque<json> entries_;
};

/// A number per joint. @throws DriverStop
std::vector<double> numbers(const json& list, std::size_t count, const std::string& line) {
  std::vector<double> out;
  if (list.is_array())
    for (const json& x : list)
      if (x.is_number() && std::isfinite(x.get<double>())) out.push_back(x.get<double>());
  if (!list.is_array() || out.size() != list.size() || out.size() != count)
    throw DriverStop(Kind::Nonsense, "'q' is a list of " + std::to_string(count) +
                                         " numbers, not as in " + excerpt(line));
  return out;
}

}  // namespace

const char* name_of(DriverStop::Kind kind) {
  switch (kind) {
    case Kind::Failed:
      return "failed";
    case Kind::Ended:
      return "ended";
    case Kind::Late:
      return "late";
    case Kind::Nonsense:
      return "nonsense";
    case Kind::Elsewhere:
      return "elsewhere";
    case Kind::Uncertified:
      return "uncertified";
    case Kind::Journal:
      break;
  }
  return "journal";
}

struct RobotDriver::Data {
  using Clock = std::chrono::steady_clock;

  Data(const world::World& w, const DriverOptions& o)
      : world(w), options(o), side(side_of(o)), journal(o) {
    note({{"kaboum_journal", 1}, {"driver", o.command}});
  }

  static std::unique_ptr<Side> side_of(const DriverOptions& o) {
    if (!(o.most_seconds > 0) || !(o.rate > 0) || !(o.tracking > 0))
      throw Error(ErrorCode::InvalidArgument, "a driver's times, rates and widths are above 0");
    if (o.replayed.empty()) return std::make_unique<Program>(o.command);
    return std::make_unique<Replayed>(o.replayed);
  }

  /// Adds to the journal. @throws DriverStop where that fails, unless all is over
  template <class Add>
  void note_by(Add add) {
    try {
      add();
    } catch (const Error& error) {
      if (error.code() != ErrorCode::OutputFailed) throw;
      not_noted = error.what();
      if (over) return;
      end(name_of(Kind::Journal), not_noted);
      throw DriverStop(Kind::Journal, not_noted);
    }
  }
  void note(const json& entry) {
    note_by([&] { journal.note(entry); });
  }

  /// The last thing that is said of the driver, once.
  void end(const char* kind, const std::string& why) {
    if (!std::exchange(over, true)) note({{"stopped", kind}, {"why", why}});
  }

  [[noreturn]] void stop(Kind kind, const std::string& why) {
    end(name_of(kind), why);
    throw DriverStop(kind, "the driver, " + doing + ": " + why);
  }

  /// The next line as an object. @param seconds  that it may take
  json hear(double seconds) {
    const auto before = Clock::now();
    const Heard heard = side->hear(seconds);
    answered = Clock::now();
    waited += std::chrono::duration<double>(*answered - before).count();
    if (heard.none) {
      note({{"none", name_of(*heard.none)}, {"why", heard.why}});
      stop(*heard.none, heard.why);
    }
    note({{"heard", heard.line}});
    if (is_nested_too_deep(heard.line))
      stop(Kind::Nonsense,
           "it answered " + excerpt(heard.line) + ", with " + describe_json_depth());
    json out = json::parse(heard.line, nullptr, false);
    if (!out.is_object())
      stop(Kind::Nonsense, "it answered " + excerpt(heard.line) + ", which is no JSON object");
    line = heard.line;
    return out;
  }

  /// Nothing is said between an answer and the next question.
  void require_silence() {
    const auto more = side->unasked();
    if (!more) return;
    note({{"unasked", *more}});
    stop(Kind::Nonsense, "it said what nobody asked: " + excerpt(*more));
  }

  /// Tells it something, and reads what it answers: "done", "failed" or "sensed".
  /// @param trajectory  in JSON, the message's last member; empty: it has none
  json ask(json message, double seconds, const std::string& trajectory = {}) {
    if (over) throw DriverStop(Kind::Ended, "the driver is told nothing any more");
    require_silence();
    message["id"] = ++messages;
    std::string text = dump(message);
    if (!trajectory.empty()) {
      text.pop_back();
      text += R"(,"trajectory":)" + trajectory + '}';
    }
    if (journal.is_kept()) note_by([&] { journal.note_text("told", text); });
    if (answered && messages > 1)
      between += std::chrono::duration<double>(Clock::now() - *answered).count();
    if (const auto refused = side->tell(text)) {
      note({{"none", name_of(*refused->none)}, {"why", refused->why}});
      stop(*refused->none, refused->why);
    }
    json answer = hear(seconds);
    if (!answer.contains("id") || answer["id"] != messages)
      stop(Kind::Nonsense, "an answer has the 'id' of what was asked, " + std::to_string(messages) +
                               ", not as in " + excerpt(line));
    int kinds = 0;
    for (const char* kind : {"done", "failed", "sensed"}) kinds += answer.contains(kind) ? 1 : 0;
    if (kinds != 1)
      stop(Kind::Nonsense,
           R"(an answer has one of "done", "failed" and "sensed", not )" + excerpt(line));
    if (answer.contains("done") && answer["done"] != true)
      stop(Kind::Nonsense, "'done' is true, not as in " + excerpt(line));
    for (const char* text_of : {"failed", "sensed"})
      if (answer.contains(text_of) && !answer[text_of].is_string())
        stop(Kind::Nonsense,
             "'" + std::string(text_of) + "' is a text, not as in " + excerpt(line));
    return answer;
  }

  /// How far a robot is from a configuration at most, if the answer says where it is.
  std::optional<double> off(const json& answer, std::size_t robot, const std::vector<double>& q) {
    if (!answer.contains("q")) return std::nullopt;
    std::vector<double> is;
    try {
      is = numbers(answer["q"], q.size(), line);
    } catch (const DriverStop& e) {
      stop(e.kind(), e.what());
    }
    double most = 0;
    for (std::size_t j = 0; j < q.size(); ++j) {
      const double distance = std::abs(is[j] - q[j]);
      const auto finger = fingers.find({robot, static_cast<std::uint32_t>(j)});
      if (finger == fingers.end())
        most = std::max(most, distance);
      else
        require_finger(robot, finger->first.second, distance, finger->second);
    }
    return most;
  }

  /// What is certified of what a robot holds is so while its fingers are where they hold it.
  void require_finger(std::size_t robot, std::uint32_t variable, double distance, double within) {
    if (distance <= within + kRoundedFinger) return;
    const world::RobotModel& model = world.robots[robot];
    stop(Kind::Elsewhere, "the joint '" + model.kinematics.variables[variable].name + "' of " +
                              model.name + "'s gripper is " + dump(distance) +
                              " away from where it was told to be; " + dump(within) +
                              " is allowed by the grasp");
  }

  /// Of an answer to a motion of fingers: where they are then.
  void require_fingers(const json& answer, std::size_t robot, const FingerMotion& moved) {
    if (!answer.contains("q") || moved.to.empty()) return;
    std::vector<double> is;
    try {
      is = numbers(answer["q"], world.robots[robot].kinematics.variables.size(), line);
    } catch (const DriverStop& e) {
      stop(e.kind(), e.what());
    }
    for (std::size_t k = 0; k < moved.variables.size(); ++k) {
      const std::uint32_t variable = moved.variables[k];
      const auto held = fingers.find({robot, variable});
      require_finger(robot, variable, std::abs(is[variable] - moved.to[k]),
                     held != fingers.end() ? held->second : options.tracking);
    }
  }

  void require_near(const json& answer, std::size_t robot, const std::vector<double>& q) {
    const auto distance = off(answer, robot, q);
    if (!distance) return;
    most_tracking = std::max(most_tracking, *distance);
    if (*distance > options.tracking)
      stop(Kind::Elsewhere, world.robots[robot].name + " is " + dump(*distance) +
                                " away from where it was told to be, in one of its joints; " +
                                dump(options.tracking) + " is allowed");
  }

  /// The rows [TIME, VALUE...] of an answer; none where it has none.
  std::vector<ExecutedSample> executed(const json& answer, std::size_t values) {
    std::vector<ExecutedSample> out;
    if (!answer.contains("executed")) return out;
    const auto nonsense = [&] {
      stop(Kind::Nonsense,
           "'executed' is [[TIME, VALUE...], ...], times from 0 on that do not fall, and " +
               std::to_string(values) + " values, not as in " + excerpt(line));
    };
    if (!answer["executed"].is_array()) nonsense();
    double last = 0;
    for (const json& row : answer["executed"]) {
      if (!row.is_array() || row.size() != values + 1) nonsense();
      ExecutedSample& sample = out.emplace_back();
      for (const json& x : row) {
        if (!x.is_number() || !std::isfinite(x.get<double>())) nonsense();
        sample.q.push_back(x.get<double>());
      }
      sample.time = sample.q.front();
      sample.q.erase(sample.q.begin());
      if (sample.time < last) nonsense();
      last = sample.time;
    }
    return out;
  }

  /// What changes nothing in the world if it fails is told again.
  json ask_again(const json& message, double seconds, const char* kind) {
    for (std::size_t tried = 0;; ++tried) {
      json answer = ask(message, seconds);
      if (answer.contains(kind)) return answer;
      if (!answer.contains("failed"))
        stop(Kind::Nonsense,
             "it was asked for '" + std::string(kind) + "' or 'failed', not for " + excerpt(line));
      if (tried >= options.retries)
        stop(Kind::Failed, "it says that it failed: " + answer["failed"].get<std::string>());
    }
  }

  const world::World& world;
  DriverOptions options;
  std::unique_ptr<Side> side;
  Journal journal;
  std::optional<Clock::time_point> answered;
  std::string doing = "when it was started", line, not_noted;
  std::uint64_t messages = 0;
  double waited = 0, between = 0, most_tracking = 0;
  /// How far joints of grippers that hold something may be off, by robot and variable.
  std::map<std::pair<std::size_t, std::uint32_t>, double> fingers;
  bool over = false, finished = false;
};

RobotDriver::RobotDriver(const world::World& world, const DriverOptions& options)
    : data_(std::make_unique<Data>(world, options)) {
  const json first = data_->hear(options.most_seconds);
  if (!first.contains("kaboum_driver") || first["kaboum_driver"] != 1)
    data_->stop(Kind::Nonsense,
                R"(its first line is {"kaboum_driver": 1}, not )" + excerpt(data_->line));
}

bool RobotDriver::is_noted() const { return data_->journal.is_kept(); }
void RobotDriver::note(std::string entry) {
  data_->note_by([&] { data_->journal.add(std::move(entry)); });
}
void RobotDriver::end(const std::string& kind, const std::string& why) {
  data_->end(kind.c_str(), why);
}

void RobotDriver::stop() {
  if (data_->finished) return;
  data_->over = true;
  data_->side->end(false);
}
const std::string& RobotDriver::not_noted() const { return data_->not_noted; }

RobotDriver::~RobotDriver() { data_->side->end(data_->finished); }

namespace {

/// Where a state has the objects: poses, or who holds them.
json objects_of(const world::World& world, const judge::CellState& state) {
  json objects = json::object();
  for (std::size_t o = 0; o < world.objects.size(); ++o) {
    const judge::CellState::Place& place = state.objects[o];
    json& entry = objects[world.objects[o].name];
    if (place.away) {
      entry = {{"away", true}};
    } else if (place.hold) {
      entry = {{"held_by", world.robots[place.hold->robot].name}};
    } else {
      json rows = json::array();
      for (int i = 0; i < 3; ++i)
        rows.push_back({place.pose.linear(i, 0), place.pose.linear(i, 1), place.pose.linear(i, 2),
                        place.pose.translation[i]});
      entry = {{"pose", std::move(rows)}};
    }
  }
  return objects;
}

}  // namespace

void RobotDriver::begin(const judge::CellState& state,
                        const std::vector<std::optional<world::Attachment>>& held) {
  data_->doing = "at the start";
  require_fingers(held);
  const world::World& world = data_->world;
  json robots = json::object();
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    json joints = json::array();
    for (const robot::Variable& v : world.robots[r].kinematics.variables) joints.push_back(v.name);
    robots[world.robots[r].name] = {{"joint_names", std::move(joints)}, {"q", state.q[r]}};
  }
  const json objects = objects_of(world, state);
  const json answer = data_->ask_again({{"do", "begin"}, {"robots", robots}, {"objects", objects}},
                                       data_->options.most_seconds, "done");
  if (!answer.contains("q")) return;
  if (!answer["q"].is_object())
    data_->stop(Kind::Nonsense,
                R"('q' is {ROBOT: [NUMBER, ...], ...} here, not )" + excerpt(data_->line));
  for (const auto& [name, q] : answer["q"].items())
    if (!robots.contains(name))
      data_->stop(Kind::Nonsense, "it says where '" + name + "' is, and no robot is called so");
  for (std::size_t r = 0; r < world.robots.size(); ++r)
    if (const std::string& name = world.robots[r].name; answer["q"].contains(name))
      data_->require_near({{"q", answer["q"][name]}}, r, state.q[r]);
}

void RobotDriver::require_fingers(const std::vector<std::optional<world::Attachment>>& held) {
  data_->fingers.clear();
  for (const auto& hold : held)
    for (const world::FingerValue& finger :
         hold ? hold->fingers : std::vector<world::FingerValue>())
      data_->fingers[{hold->robot, finger.variable}] = finger.within;
}

void RobotDriver::act(const std::string& action) {
  data_->doing = "at " + action;
  data_->ask_again({{"do", "act"}, {"action", action}}, data_->options.most_seconds, "done");
}

std::string told_trajectory(const robot::Robot& robot, const motion::Trajectory& trajectory) {
  json names = json::array(), points = json::array();
  for (const robot::Variable& v : robot.variables) names.push_back(v.name);
  for (std::size_t k = 0; k < trajectory.samples(); ++k) {
    const motion::Instant now = trajectory.instant(k);
    points.push_back({{"time_from_start", static_cast<double>(k) / trajectory.rate()},
                      {"positions", now.q},
                      {"velocities", now.velocity},
                      {"accelerations", now.acceleration}});
  }
  return dump({{"joint_names", std::move(names)}, {"points", std::move(points)}});
}

void RobotDriver::move(std::size_t robot, const motion::Trajectory& trajectory,
                       const std::string& told, ExecutedMotion& executed) {
  executed.rate = trajectory.rate();
  const world::RobotModel& model = data_->world.robots[robot];
  const json message = {{"do", "move"}, {"robot", model.name}};
  const std::vector<double> from = trajectory.sample(0),
                            to = trajectory.sample(trajectory.samples() - 1);
  for (std::size_t tried = 0;; ++tried) {
    const json answer =
        data_->ask(message, data_->options.most_seconds + kSlower * trajectory.duration(), told);
    for (ExecutedSample& sample : data_->executed(answer, to.size()))
      executed.samples.push_back(std::move(sample));
    if (answer.contains("done")) {
      data_->require_near(answer, robot, to);
      return;
    }
    if (!answer.contains("failed"))
      data_->stop(Kind::Nonsense, "a motion is 'done' or 'failed', not " + excerpt(data_->line));
    const std::string why = "it says that it failed: " + answer["failed"].get<std::string>();
    const auto off = data_->off(answer, robot, from);
    if (!off) data_->stop(Kind::Failed, why + "; where " + model.name + " is, it does not say");
    if (*off > data_->options.tracking)
      data_->stop(Kind::Failed, why + "; " + model.name + " is not where the motion began");
    if (tried >= data_->options.retries) data_->stop(Kind::Failed, why);
  }
}

void RobotDriver::take(std::size_t object, std::size_t robot, std::uint32_t link,
                       const FingerMotion& fingers) {
  const world::RobotModel& model = data_->world.robots[robot];
  json message = {{"do", "take"},
                  {"robot", model.name},
                  {"object", data_->world.objects[object].name},
                  {"link", model.kinematics.links[link].name}};
  if (!fingers.to.empty()) message["gripper"] = to_json<json>(fingers);
  const json answer = data_->ask_again(message, data_->options.most_seconds, "done");
  for (const std::uint32_t variable : fingers.variables)
    data_->fingers[{robot, variable}] = fingers.within;
  data_->require_fingers(answer, robot, fingers);
}

void RobotDriver::release(std::size_t object, std::size_t robot, const FingerMotion& fingers) {
  json message = {{"do", "release"},
                  {"robot", data_->world.robots[robot].name},
                  {"object", data_->world.objects[object].name}};
  if (!fingers.to.empty()) message["gripper"] = to_json<json>(fingers);
  const json answer = data_->ask_again(message, data_->options.most_seconds, "done");
  for (const std::uint32_t variable : fingers.variables) data_->fingers.erase({robot, variable});
  data_->require_fingers(answer, robot, fingers);
}

std::string RobotDriver::sense(const std::string& fact, const std::vector<std::string>& values) {
  return data_
      ->ask_again({{"do", "sense"}, {"fact", fact}, {"values", values}},
                  data_->options.most_seconds, "sensed")["sensed"]
      .get<std::string>();
}

void RobotDriver::finish(const judge::CellState* end) {
  data_->doing = "at the end";
  json told = {{"do", "finish"}};
  if (end != nullptr) told["objects"] = objects_of(data_->world, *end);
  data_->ask_again(told, data_->options.most_seconds, "done");
  data_->require_silence();
  data_->finished = data_->over = true;
  data_->note({{"finished", true}});
}

std::uint64_t RobotDriver::messages() const { return data_->messages; }
double RobotDriver::waited() const { return data_->waited; }
double RobotDriver::between() const { return data_->between; }
double RobotDriver::most_tracking() const { return data_->most_tracking; }

}  // namespace kaboum::execution

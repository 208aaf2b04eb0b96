// Trajectories as messages of ROS 2.

#include <kaboum/base/error.h>
#include <kaboum/motion/trajectory.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

namespace kaboum::motion {
namespace {

/// A number with a point in it, which YAML 1.1 asks of one with an exponent: "1.0e-05".
void append_real(std::string& out, double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  const std::string_view number(text.data(), static_cast<std::size_t>(end - text.data()));
  const std::size_t exponent = std::min(number.find('e'), number.size());
  out += number.substr(0, exponent);
  if (number.find('.') == std::string_view::npos) out += ".0";
  out += number.substr(exponent);
}

void append_list(std::string& out, const std::vector<double>& values) {
  out += '[';
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out += ", ";
    append_real(out, values[i]);
  }
  out += ']';
}

/// In quotation marks, as JSON and YAML have it.
void append_quoted(std::string& out, const std::string& name) {
  constexpr const char* kDigits = "0123456789abcdef";
  out += '"';
  for (const char c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (code < 0x20) {
      out += "\\u00";
      out += kDigits[code >> 4U];
      out += kDigits[code & 15U];
    } else {
      out += c;
    }
  }
  out += '"';
}

void append_names(std::string& out, const robot::Robot& robot) {
  out += '[';
  for (std::size_t i = 0; i < robot.variables.size(); ++i) {
    if (i > 0) out += ", ";
    append_quoted(out, robot.variables[i].name);
  }
  out += ']';
}

struct Stamp {
  long long seconds = 0, nanoseconds = 0;
};

Stamp stamp_of(double time) {
  constexpr long long kBillion = 1'000'000'000;
  Stamp out{static_cast<long long>(std::floor(time)), 0};
  out.nanoseconds = std::llround((time - std::floor(time)) * 1e9);
  if (out.nanoseconds == kBillion) out = {out.seconds + 1, 0};
  return out;
}

/// What stands before the values of a member.
struct Words {
  const char *names, *points, *position, *velocity, *acceleration, *sec, *nanosec, *end, *between,
      *last;
};

constexpr Words kYaml{"joint_names: ",
                      "\npoints:\n",
                      "- positions: ",
                      "\n  velocities: ",
                      "\n  accelerations: ",
                      "\n  time_from_start: {sec: ",
                      ", nanosec: ",
                      "}",
                      "\n",
                      "\n"};
constexpr Words kJson{"{\"joint_names\": ",
                      ",\n\"points\": [\n",
                      "{\"positions\": ",
                      ", \"velocities\": ",
                      ", \"accelerations\": ",
                      ", \"time_from_start\": {\"sec\": ",
                      ", \"nanosec\": ",
                      "}}",
                      ",\n",
                      "\n]}\n"};

}  // namespace

std::optional<MessageFormat> message_format(const std::string& file) {
  std::string name = file;
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with(".json")) return MessageFormat::Json;
  if (name.ends_with(".yaml") || name.ends_with(".yml")) return MessageFormat::Yaml;
  return std::nullopt;
}

std::string to_joint_trajectory(const Trajectory& trajectory, const robot::Robot& robot,
                                MessageFormat format) {
  if (!(trajectory.duration() < 0x1p31))
    throw Error(ErrorCode::LimitReached,
                "the trajectory takes more seconds than ROS's messages have numbers for");
  const Words& words = format == MessageFormat::Yaml ? kYaml : kJson;
  std::string out = words.names;
  append_names(out, robot);
  out += words.points;
  for (std::size_t k = 0; k < trajectory.samples(); ++k) {
    const Instant now = trajectory.instant(k);
    const Stamp stamp = stamp_of(static_cast<double>(k) / trajectory.rate());
    if (k > 0) out += words.between;
    out += words.position;
    append_list(out, now.q);
    out += words.velocity;
    append_list(out, now.velocity);
    out += words.acceleration;
    append_list(out, now.acceleration);
    out += words.sec + std::to_string(stamp.seconds);
    out += words.nanosec + std::to_string(stamp.nanoseconds);
    out += words.end;
  }
  return out + words.last;
}

}  // namespace kaboum::motion

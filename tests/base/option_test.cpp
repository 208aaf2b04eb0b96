// Options described once: texts of their values, ranges, records.

#include <gtest/gtest.h>
#include <kaboum/base/option.h>
#include <kaboum/base/parse_length.h>

namespace kaboum {
namespace {

struct Part {
  bool flag = false;
};

struct Request {
  std::optional<Length> epsilon;
  std::size_t count = 64;
  std::optional<double> share;
  enum class Way { Left, Right } way = Way::Left;
  std::string name;
  Part part;
};

std::vector<Option<Request>> options() {
  std::vector<Option<Request>> out;
  out.push_back(option<Request>(
      {.name = "epsilon", .text = "Not with {max-count}"},
      [](auto& r) -> auto& { return r.epsilon; }));
  out.push_back(option<Request>(
      {.name = "max-count", .text = "Most", .low = 8, .high = 100, .always_recorded = true},
      [](auto& r) -> auto& { return r.count; }));
  out.push_back(option<Request>(
      {.name = "share", .text = "Share", .low = 0, .high = 1},
      [](auto& r) -> auto& { return r.share; }));
  out.push_back(choice<Request>(
      {.name = "way", .text = "Way"}, [](auto& r) -> auto& { return r.way; },
      std::vector<std::pair<std::string, Request::Way>>{{"left", Request::Way::Left},
                                                        {"right", Request::Way::Right}}));
  out.push_back(option<Request>(
      {.name = "name", .text = "Name", .unrecorded = true},
      [](auto& r) -> auto& { return r.name; }));
  std::vector<Option<Part>> parts{option<Part>(
      {.name = "flag", .text = "Flag"}, [](auto& p) -> auto& { return p.flag; })};
  for (auto& o : options_of_part<Request>(
           parts, [](auto& r) -> auto& { return r.part; }))
    out.push_back(std::move(o));
  return out;
}

const Option<Request>& named(const std::vector<Option<Request>>& all, const std::string& name) {
  for (const Option<Request>& o : all)
    if (o.name == name) return o;
  throw std::out_of_range(name);
}

TEST(Options, AreWhatTheirMembersAre) {
  const auto all = options();
  EXPECT_EQ(value_words(named(all, "epsilon")), "LENGTH|P%");
  EXPECT_EQ(value_words(named(all, "max-count")), "N");
  EXPECT_EQ(value_words(named(all, "way")), "left|right");
  EXPECT_EQ(value_words(named(all, "flag")), "");
  EXPECT_EQ(range_words(named(all, "max-count")), "8 to 100");
  EXPECT_EQ(default_of(named(all, "max-count")), "64");
  EXPECT_EQ(default_of(named(all, "epsilon")), std::nullopt);
  EXPECT_EQ(default_of(named(all, "way")), "left");
  EXPECT_EQ(meaning(named(all, "epsilon").text, [](const std::string& n) { return "--" + n; }),
            "Not with --max-count");
}

TEST(Options, RefuseWrongValues) {
  const auto all = options();
  for (const auto& [name, values] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"epsilon", {"", "0", "-1", "1 %", "1%%", "nan", "inf", "1e999", "x"}},
           {"max-count", {"", "7", "101", "8.0", "-8", "8x", "1e2", "99999999999999999999999"}},
           {"share", {"", "-0.1", "1.1", "nan", "inf", "0.5%"}},
           {"way", {"", "Left", "up"}},
           {"flag", {"", "yes", "1"}}})
    for (const std::string& value : values)
      EXPECT_NE(flaw_of(named(all, name), value), "") << name << " " << value;
  EXPECT_NE(flaw_of(named(all, "way"), "rigth").find("did you mean 'right'"), std::string::npos);
}

/// A unit says what a number is in; it is brought into the one that is needed, without rounding
/// between units of ten.
TEST(Options, LengthsWithUnits) {
  const auto all = options();
  Request request;
  const auto stated = [&](const std::string& text, std::string_view unit) {
    EXPECT_EQ(flaw_of(named(all, "epsilon"), text), "") << text;
    named(all, "epsilon").assign(request, text);
    EXPECT_EQ(named(all, "epsilon").value(request), text);
    bring_lengths_into(unit, all, request);
    return *request.epsilon;
  };
  EXPECT_EQ(stated("5mm", "m"), Length{0.005});
  EXPECT_EQ(stated("0.7cm", "m"), Length{0.7 / 100});
  EXPECT_EQ(stated("2in", "mm"), Length{50.8});
  EXPECT_EQ(stated("3ft", "in"), Length{36});
  EXPECT_EQ(stated("1m", "um"), Length{1e6});
  EXPECT_EQ(stated("0.1km", "dm"), Length{1000});
  EXPECT_EQ(stated("5mm", "mm"), Length{5});
  EXPECT_EQ(stated("5", "mm"), Length{5}) << "in the unit of what it is about";
  EXPECT_EQ(stated("5", ""), Length{5});
  EXPECT_EQ(stated("0.5%", ""), (Length{0.5, true}));
  EXPECT_THROW(stated("5mm", ""), Error) << "nobody has said what the unit is";
  EXPECT_THROW(stated("5mm", "0.005 m"), Error);
  request.epsilon = parse_length("5mm");
  EXPECT_THROW(static_cast<void>(request.epsilon->of(1)), Error) << "never taken for 5";
  for (const char* wrong : {"5 mm", "mm", "5MM", "5mm%", "5%mm", "0mm", "-1mm", "5nm", "5mmm"})
    EXPECT_NE(flaw_of(named(all, "epsilon"), wrong), "") << wrong;
}

/// Bytes with and without a unit; no number that is no size.
TEST(Options, SizesOfMemory) {
  EXPECT_EQ(parse_memory("1000"), 1000U);
  EXPECT_EQ(parse_memory("1k"), 1024U);
  EXPECT_EQ(parse_memory("0.5K"), 512U);
  EXPECT_EQ(parse_memory("500M"), 500U << 20U);
  EXPECT_EQ(parse_memory("2G"), std::size_t{2} << 30U);
  for (const char* wrong : {"", "M", "0", "-1", "0.5", "1T", "1 M", "1MM", "nan", "inf", "1e16"})
    EXPECT_EQ(parse_memory(wrong), std::nullopt) << wrong;
  struct Limits {
    std::size_t bytes = 0;
    double seconds = 0;
  } limits;
  const auto memory = limit_option<Limits>(
      {.name = "max-memory", .text = "Most", .kind = OptionDescription::Kind::Memory},
      [](auto& r) -> auto& { return r.bytes; });
  const auto time = limit_option<Limits>(
      {.name = "timeout", .text = "Longest", .low = 0, .between = true},
      [](auto& r) -> auto& { return r.seconds; });
  EXPECT_EQ(memory.value(limits), std::nullopt);
  EXPECT_EQ(time.value(limits), std::nullopt);
  memory.assign(limits, "2k");
  time.assign(limits, "0.5");
  EXPECT_EQ(memory.value(limits), "2048");
  EXPECT_EQ(time.value(limits), "0.5");
  EXPECT_NE(flaw_of(memory, "2 GB"), "");
  EXPECT_EQ(flaw_of(time, "0"), "must be a number above 0, without a unit, not 0");
  EXPECT_EQ(range_words(time), "above 0");
}

/// Numbers by name, numbers that are lengths, and numbers without end, which state nothing.
TEST(Options, OtherMembers) {
  struct Motion {
    std::map<std::string, double> joints;
    double resolution = 1e-5, work = std::numeric_limits<double>::infinity();
    double gap = 0.001;
  } motion;
  const std::vector<Option<Motion>> all{
      option<Motion>(
          {.name = "joint", .text = "Value"}, [](auto& r) -> auto& { return r.joints; }),
      option<Motion>(
          {.name = "resolution", .text = "Resolution", .absolute = true},
          [](auto& r) -> auto& { return r.resolution; }),
      option<Motion>(
          {.name = "work", .text = "Work"}, [](auto& r) -> auto& { return r.work; }),
      option<Motion>(
          {.name = "gap", .text = "Gap", .low = 0, .absolute = true},
          [](auto& r) -> auto& { return r.gap; })};
  EXPECT_EQ(record_of(all, motion), "");
  EXPECT_EQ(value_words(all[1]), "LENGTH");
  EXPECT_EQ(facts_of(all[1]), "metres, or with a unit, as in 5mm");
  EXPECT_EQ(facts_of(all[3]), "at least 0; metres, or with a unit, as in 5mm");
  EXPECT_NE(flaw_of(all[1], "1%").find("no diagonal"), std::string::npos);
  EXPECT_NE(flaw_of(all[1], "0"), "");
  EXPECT_EQ(flaw_of(all[1], "5mm"), "");
  all[1].assign(motion, "5mm");
  EXPECT_EQ(motion.resolution, 0.005);
  motion.resolution = 1e-5;
  for (const std::string none : {"0", "0mm"}) {
    motion.gap = 1;
    EXPECT_EQ(flaw_of(all[3], none), "");
    all[3].assign(motion, none);
    EXPECT_EQ(motion.gap, 0);
  }
  EXPECT_NE(flaw_of(all[3], "-1mm").find("a length of at least 0"), std::string::npos);
  motion.gap = 0.001;
  EXPECT_NE(flaw_of(all[0], "a=1\na=2"), "");
  EXPECT_EQ(read_record(all, "--joint b=0.25 --joint a=1 --resolution 0.5 --work 3", motion), "");
  EXPECT_EQ(motion.joints, (std::map<std::string, double>{{"a", 1}, {"b", 0.25}}));
  EXPECT_EQ(motion.resolution, 0.5);
  EXPECT_EQ(record_of(options_named(all, {"work", "joint"}), motion),
            "--work 3 --joint a=1 --joint b=0.25");
  EXPECT_THROW(option_named(all, "none"), Error);
}

/// Lengths by name, which keep their units until somebody knows the unit of what they are about.
TEST(Options, LengthsByName) {
  struct Kept {
    std::map<std::string, Length> margins;
  } kept;
  const Option<Kept> margin = option<Kept>(
      {.name = "margin",
       .text = "Margin",
       .low = 0,
       .absolute = true,
       .own_unit = "the scene's unit",
       .for_all = true},
      [](auto& r) -> auto& { return r.margins; });
  EXPECT_EQ(value_words(margin), "LENGTH|NAME=LENGTH");
  EXPECT_EQ(facts_of(margin), "at least 0; the scene's unit, or with a unit, as in 5mm");
  for (const char* sound : {"0", "0mm", "5mm", "arm=5mm\n0.01", "arm,box=0", "arm=0m"})
    EXPECT_EQ(flaw_of(margin, sound), "") << sound;
  for (const char* wrong :
       {"", "-1", "arm=-1mm", "arm=", "=1", "5 mm", "arm=5nm", "arm=nan", "arm=1\narm=1mm", "1\n2"})
    EXPECT_NE(flaw_of(margin, wrong), "") << wrong;
  for (const char* share : {"1%", "arm=0%"})
    EXPECT_NE(flaw_of(margin, share).find("no diagonal"), std::string::npos) << share;
  margin.assign(kept, "0.01\narm=5mm\narm,box=0");
  EXPECT_EQ(kept.margins[""], Length{0.01});
  EXPECT_EQ(kept.margins["arm"].in("mm"), Length{5});
  EXPECT_EQ(kept.margins["arm"].in("m"), Length{0.005});
  EXPECT_EQ(kept.margins["arm,box"], Length{0});
  EXPECT_EQ(margin.value(kept), "0.01\narm=5mm\narm,box=0");
}

TEST(Options, RecordsAreReadBack) {
  const auto all = options();
  EXPECT_EQ(record_of(all, Request{}), "--max-count 64");
  Request given{.epsilon = Length{0.1, true},
                .count = 8,
                .share = 1.0 / 3,
                .way = Request::Way::Right,
                .name = "left out",
                .part = {true}};
  const std::string record = record_of(all, given);
  EXPECT_EQ(record, "--epsilon 0.1% --max-count 8 --share 0.3333333333333333 --way right --flag");
  Request back;
  EXPECT_EQ(read_record(all, record, back), "");
  EXPECT_EQ(back.epsilon, given.epsilon);
  EXPECT_EQ(back.count, 8U);
  EXPECT_EQ(back.share, given.share);
  EXPECT_EQ(back.way, Request::Way::Right);
  EXPECT_TRUE(back.part.flag);
  EXPECT_EQ(back.name, "");
}

TEST(Options, RecordsThatAreNotUnderstoodAreNamed) {
  const auto all = options();
  Request r;
  EXPECT_EQ(read_record(all, "--share 2", r), "--share 2");
  EXPECT_EQ(read_record(all, "--share", r), "--share");
  EXPECT_EQ(read_record(all, "--name x", r), "--name");
  EXPECT_EQ(read_record(all, "--flag extra", r), "extra");
  EXPECT_EQ(read_record(all, "share 1", r), "share");
  EXPECT_EQ(read_record(all, "", r), "");
}

// Options in remedies are spelled as each front end names them; all else stays.
TEST(Remedy, IsSpelledByTheFrontEnd) {
  const std::string text =
      "sheets; have them dropped («drop-sheets»), «prepare=wrap» or «scale=1e3»";
  EXPECT_EQ(remedy_of_program(text),
            "sheets; have them dropped (--drop-sheets), --prepare wrap or --scale 1e3");
  EXPECT_EQ(remedy_of_python(text),
            "sheets; have them dropped (drop_sheets), prepare='wrap' or scale=1e3");
  for (const char* other : {"", "{part}.stl: no", "a « alone", "a » alone"}) {
    EXPECT_EQ(remedy_of_program(other), other);
    EXPECT_EQ(remedy_of_python(other), other);
  }
}

struct Limits {
  std::map<std::string, double> speeds;
};

/// A number without a name is of all, where an option says so; limits are of each number.
TEST(Options, SettingsMayBeOfAll) {
  const auto speeds = option<Limits>(
      {.name = "speed", .text = "Most", .low = 0, .between = true, .for_all = true},
      [](auto& r) -> auto& { return r.speeds; });
  EXPECT_EQ(value_words(speeds), "X|NAME=X");
  Limits limits;
  ASSERT_EQ(flaw_of(speeds, "2\nelbow=0.5"), "");
  speeds.assign(limits, "2\nelbow=0.5");
  EXPECT_EQ(limits.speeds, (std::map<std::string, double>{{"", 2}, {"elbow", 0.5}}));
  EXPECT_EQ(speeds.value(limits), "2\nelbow=0.5");
  for (const char* wrong : {"0", "elbow=0", "-1", "1\n2", "elbow=1\nelbow=2", "=1", "x", "elbow="})
    EXPECT_NE(flaw_of(speeds, wrong), "") << wrong;
  const auto joints = option<Limits>(
      {.name = "joint", .text = "Value"}, [](auto& r) -> auto& { return r.speeds; });
  EXPECT_NE(flaw_of(joints, "2"), "");
  EXPECT_EQ(flaw_of(joints, "elbow=-2"), "");
}

}  // namespace
}  // namespace kaboum

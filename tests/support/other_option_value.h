#pragma once

#include <kaboum/base/option.h>

#include <algorithm>
#include <string>

namespace kaboum::test {

/// A sound value of an option that is not its default.
template <class Request>
std::string other_value(const Option<Request>& o) {
  switch (o.kind) {
    case OptionDescription::Kind::Flag:
      return "true";
    case OptionDescription::Kind::Count:
    case OptionDescription::Kind::Counts: {
      const std::string next = std::to_string(static_cast<std::size_t>(std::max(o.low, 0.0)) + 1);
      return next == default_of(o) ? next + "0" : next;
    }
    case OptionDescription::Kind::Memory:
      return "1000";
    case OptionDescription::Kind::Number:
      return option_text::of(0.5 * (o.low + std::min(o.high, o.low + 1.0)));
    case OptionDescription::Kind::Length:
      return o.absolute ? "0.125" : "0.125%";
    case OptionDescription::Kind::Choice:
      return default_of(o) == o.choices.front() ? o.choices.back() : o.choices.front();
    case OptionDescription::Kind::Settings:
      return "another=0.125";
    case OptionDescription::Kind::Files:
    case OptionDescription::Kind::Names:
    case OptionDescription::Kind::Text:
      break;
  }
  return "another";
}

}  // namespace kaboum::test

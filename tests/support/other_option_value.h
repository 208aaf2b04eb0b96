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
    case OptionDescription::Kind::Counts:
      return std::to_string(static_cast<std::size_t>(o.low) + 1);
    case OptionDescription::Kind::Number:
      return option_text::of(0.5 * (o.low + std::min(o.high, 1.0)));
    case OptionDescription::Kind::Length:
      return "0.125%";
    case OptionDescription::Kind::Choice:
      return default_of(o) == o.choices.front() ? o.choices.back() : o.choices.front();
    case OptionDescription::Kind::Text:
      break;
  }
  return "another";
}

}  // namespace kaboum::test

// Lists of numbers in options.

#include <gtest/gtest.h>
#include <kaboum/base/parse_numbers.h>

namespace kaboum {
namespace {

TEST(ParseNumbers, TakesFiniteNumbersWithCommasBetweenAndNothingElse) {
  EXPECT_EQ(parse_numbers("0.5,-1.25,3e2"), (std::vector<double>{0.5, -1.25, 300}));
  EXPECT_EQ(parse_numbers("7"), std::vector<double>{7});
  for (const char* text :
       {"", ",", "1,", ",1", "1,,2", "1 2", "1, 2", "1;2", "nan", "inf", "1e999", "0x1", "one"})
    EXPECT_FALSE(parse_numbers(text)) << text;
}

}  // namespace
}  // namespace kaboum

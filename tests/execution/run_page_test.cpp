// Events of the page of a run.

#include <gtest/gtest.h>
#include <kaboum/execution/run_page.h>

#include <nlohmann/json.hpp>

namespace kaboum::execution {
namespace {

using nlohmann::json;

/// A line of a journal with a plan that is a chain.
std::string plan_of(std::size_t count) {
  json nodes = json::array();
  for (std::size_t i = 0; i < count; ++i) {
    const json to = i + 1 < count ? json(i + 1) : json(nullptr);
    nodes.push_back(
        {{"text", "act(o1)"}, {"branches", false}, {"next", {{{"to", to}, {"if", ""}}}}});
  }
  return json{{"plan", 0}, {"name", "chain"}, {"graph", {{"root", 0}, {"nodes", nodes}}}}.dump();
}

TEST(RunPage, PlansAreDrawn) {
  const json event = json::parse(run_event(plan_of(2000)));
  EXPECT_NE(event.at("svg").get<std::string>().find("id=\"node-1999\""), std::string::npos);
  EXPECT_FALSE(event.contains("undrawn"));
  EXPECT_FALSE(event.contains("graph"));
}

TEST(RunPage, OfALargePlanItsSizeIsSaid) {
  const json event = json::parse(run_event(plan_of(100000)));
  EXPECT_EQ(event.at("undrawn"), 100000);
  EXPECT_FALSE(event.contains("svg"));
  EXPECT_FALSE(event.contains("graph"));
  EXPECT_EQ(event.at("name"), "chain");
}

TEST(RunPage, WhatALineSaysOfDrawingsIsNotBelieved) {
  const json event = json::parse(run_event(R"({"plan": 0, "svg": "<b>", "undrawn": "<b>"})"));
  EXPECT_FALSE(event.contains("svg"));
  EXPECT_FALSE(event.contains("undrawn"));
}

}  // namespace
}  // namespace kaboum::execution

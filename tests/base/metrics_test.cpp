#include "server/base/metrics.hpp"

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace tweend {
namespace {

struct Family {
  std::string help, type, value;
};

/// Reads the text as a scraper does: HELP and TYPE once each before their sample; anything else fails the test.
std::map<std::string, Family> scrape(const std::string& text) {
  std::map<std::string, Family> families;
  std::set<std::string> helped;
  std::istringstream lines(text);
  const std::regex help(R"(# HELP ([a-zA-Z_:][a-zA-Z0-9_:]*) (.+))");
  const std::regex type(R"(# TYPE ([a-zA-Z_:][a-zA-Z0-9_:]*) (counter|gauge))");
  const std::regex sample(R"(([a-zA-Z_:][a-zA-Z0-9_:]*) (-?[0-9]+))");
  for (std::string line; std::getline(lines, line);) {
    std::smatch m;
    if (std::regex_match(line, m, help)) {
      EXPECT_TRUE(families[m[1]].help.empty() && families[m[1]].type.empty()) << line;
      families[m[1]].help = m[2];
    } else if (std::regex_match(line, m, type)) {
      EXPECT_TRUE(families[m[1]].type.empty() && families[m[1]].value.empty()) << line;
      families[m[1]].type = m[2];
    } else if (std::regex_match(line, m, sample)) {
      EXPECT_TRUE(!families[m[1]].type.empty() && families[m[1]].value.empty()) << line;
      families[m[1]].value = m[2];
    } else {
      ADD_FAILURE() << "no line of the exposition format: " << line;
    }
  }
  return families;
}

TEST(Metrics, TextDescribesEachFigureOnceBeforeItsValue) {
  const Metrics metrics;
  const std::string text = metrics.prometheus_text();
  ASSERT_FALSE(text.empty());
  EXPECT_EQ(text.back(), '\n');
  const auto families = scrape(text);
  EXPECT_EQ(families.size(), metrics.read().size());
  for (const auto& [name, family] : families) {
    EXPECT_FALSE(family.help.empty()) << name;
    EXPECT_FALSE(family.type.empty()) << name;
    EXPECT_EQ(family.value, "0") << name;
  }
}

TEST(Metrics, CountersAndOnlyTheyEndInTotal) {
  const Metrics metrics;
  for (const auto& [name, family] : scrape(metrics.prometheus_text())) {
    EXPECT_TRUE(name.starts_with("tweend_")) << name;
    EXPECT_EQ(name.ends_with("_total"), family.type == "counter") << name;
  }
}

TEST(Metrics, ReadingsSayTheSameAsTheText) {
  Metrics metrics;
  add(metrics.edits_total, 41);
  add(metrics.edits_total);
  add(metrics.connections, 5);
  add(metrics.connections, -7);
  add(metrics.bytes_sent_total, 5'000'000'000);
  const auto families = scrape(metrics.prometheus_text());
  EXPECT_EQ(families.at("tweend_edits_total").value, "42");
  EXPECT_EQ(families.at("tweend_connections").value, "-2");
  EXPECT_EQ(families.at("tweend_bytes_sent_total").value, "5000000000");
  for (const Metrics::Reading& r : metrics.read()) {
    const Family& family = families.at("tweend_" + std::string(r.name));
    EXPECT_EQ(family.value, std::to_string(r.value));
    EXPECT_EQ(family.help, r.help);
    EXPECT_EQ(family.type, r.type);
  }
}

TEST(Metrics, LosesNoCountBetweenThreads) {
  Metrics metrics;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&metrics] {
        for (int i = 0; i < 10'000; ++i) add(metrics.requests_total);
      });
    }
  }
  EXPECT_EQ(metrics.requests_total.load(), 40'000);
}

}  // namespace
}  // namespace tweend

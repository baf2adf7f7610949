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
  std::string help, type;
  std::map<std::string, double> samples;  ///< by their whole name
};

/// What a sample's name belongs to: a histogram's samples have endings and a label.
std::string family_of(const std::string& name) {
  return std::regex_replace(name, std::regex(R"((_bucket\{le="[^"]+"\}|_sum|_count)$)"), "");
}

/// Reads the text as a scraper does: HELP and TYPE once each before their samples; anything else fails the test.
std::map<std::string, Family> scrape(const std::string& text) {
  std::map<std::string, Family> families;
  std::istringstream lines(text);
  const std::regex help(R"(# HELP ([a-zA-Z_:][a-zA-Z0-9_:]*) (.+))");
  const std::regex type(R"(# TYPE ([a-zA-Z_:][a-zA-Z0-9_:]*) (counter|gauge|histogram))");
  const std::regex sample(R"(([a-zA-Z_:][a-zA-Z0-9_:]*(?:\{le="[^"]+"\})?) (-?[0-9.e+-]+))");
  for (std::string line; std::getline(lines, line);) {
    std::smatch m;
    if (std::regex_match(line, m, help)) {
      EXPECT_TRUE(families[m[1]].help.empty() && families[m[1]].type.empty()) << line;
      families[m[1]].help = m[2];
    } else if (std::regex_match(line, m, type)) {
      EXPECT_TRUE(families[m[1]].type.empty() && families[m[1]].samples.empty()) << line;
      families[m[1]].type = m[2];
    } else if (std::regex_match(line, m, sample)) {
      Family& family = families[family_of(m[1])];
      EXPECT_TRUE(!family.type.empty() && !family.samples.contains(m[1])) << line;
      family.samples[m[1]] = std::stod(m[2]);
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
  for (const auto& [name, family] : scrape(text)) {
    EXPECT_FALSE(family.help.empty()) << name;
    EXPECT_FALSE(family.type.empty()) << name;
    EXPECT_FALSE(family.samples.empty()) << name;
    for (const auto& [sample, value] : family.samples) EXPECT_EQ(value, 0.0) << sample;
  }
}

TEST(Metrics, CountersAndOnlyTheyEndInTotal) {
  const Metrics metrics;
  for (const auto& [name, family] : scrape(metrics.prometheus_text())) {
    EXPECT_TRUE(name.starts_with("tweend_")) << name;
    EXPECT_EQ(name.ends_with("_total"), family.type == "counter") << name;
    EXPECT_EQ(name.ends_with("_seconds"), family.type == "histogram") << name;
  }
}

TEST(Metrics, ReadingsSayTheSameAsTheText) {
  Metrics metrics;
  add(metrics.edits_total, 41);
  add(metrics.edits_total);
  add(metrics.connections, 5);
  add(metrics.connections, -7);
  add(metrics.bytes_sent_total, 5'000'000'000);
  metrics.packet_delay_seconds.observe(1'500);
  const auto families = scrape(metrics.prometheus_text());
  EXPECT_EQ(families.at("tweend_edits_total").samples.at("tweend_edits_total"), 42.0);
  EXPECT_EQ(families.at("tweend_connections").samples.at("tweend_connections"), -2.0);
  EXPECT_EQ(families.at("tweend_bytes_sent_total").samples.at("tweend_bytes_sent_total"), 5e9);
  std::size_t samples = 0;
  for (const auto& [name, family] : families) samples += family.samples.size();
  EXPECT_EQ(metrics.read().size(), samples);
  for (const Metrics::Reading& r : metrics.read()) {
    EXPECT_EQ(families.at(family_of(r.name)).samples.at(r.name), r.value) << r.name;
  }
}

TEST(Metrics, HistogramsCountWhatIsNotAboveEachBound) {
  Metrics metrics;
  for (const std::int64_t us : {0, 50, 51, 1'000, 2'000'000}) metrics.packet_delay_seconds.observe(us);
  const auto samples = scrape(metrics.prometheus_text()).at("tweend_packet_delay_seconds").samples;
  const auto up_to = [&](const std::string& bound) {
    return samples.at("tweend_packet_delay_seconds_bucket{le=\"" + bound + "\"}");
  };
  EXPECT_EQ(up_to("5e-05"), 2.0) << "a bound is part of its bucket";
  EXPECT_EQ(up_to("0.0001"), 3.0);
  EXPECT_EQ(up_to("0.0005"), 3.0);
  EXPECT_EQ(up_to("0.001"), 4.0);
  EXPECT_EQ(up_to("1"), 4.0);
  EXPECT_EQ(up_to("+Inf"), 5.0);
  EXPECT_EQ(samples.at("tweend_packet_delay_seconds_count"), 5.0);
  EXPECT_NEAR(samples.at("tweend_packet_delay_seconds_sum"), 2.001101, 1e-9);
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

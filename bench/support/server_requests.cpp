#include "bench/support/server_requests.hpp"

#include <fmt/format.h>

#include <string_view>

namespace tweend::bench {

std::string request(const std::string& method, const std::string& params) {
  return fmt::format(R"({{"jsonrpc":"2.0","id":7,"method":"{}","params":{}}})", method, params) + "\n";
}

void must(LineClient& client, const std::string& method, const std::string& params) {
  const std::string_view answer = client.exchange(request(method, params));
  if (answer.find("\"result\":") == std::string_view::npos) {
    give_up(method + ": " + std::string(answer.substr(0, 400)));
  }
}

double stat(LineClient& client, const std::string& name) {
  const std::string_view answer = client.exchange(request("server.stats", "{}"));
  const std::string key = "\"tweend_" + name + "\":";
  const std::size_t at = answer.find(key);
  if (at == std::string_view::npos) give_up("server.stats has no " + name);
  return std::stod(std::string(answer.substr(at + key.size(), 20)));
}

void add_sphere(LineClient& client, const SphereGrid& sphere, float lobes) {
  must(client, "actor.add",
       fmt::format(R"({{"actor":"sphere","mesh":{{"positions":[{}],"indices":[{}]}},"closed":true,"duration":2}})",
                   fmt::join(sphere.positions(0.0F), ","), fmt::join(sphere.indices(), ",")));
  for (const float out : {0.0F, lobes}) {
    must(client, "keyframe.add",
         fmt::format(R"({{"actor":"sphere","vertices":{{"positions":[{}]}}}})", fmt::join(sphere.positions(out), ",")));
  }
}

}  // namespace tweend::bench

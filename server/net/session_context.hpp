#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "server/base/worker_pool.hpp"
#include "server/commands/command.hpp"
#include "server/commands/services.hpp"
#include "server/net/web_files.hpp"

namespace tweend::net {

/// What sessions share. Network thread only; outlives them.
struct SessionContext {
  commands::Services services;
  Post to_network;
  std::vector<std::string> allowed_origins;
  bool stopping = false;

  /// Ways to make each open session end soon, while the server stops.
  struct Ender {
    virtual ~Ender() = default;
    virtual void end_soon() = 0;
  };
  std::set<Ender*> sessions;

  WebFiles web = {};
};

/// While it lives, the session is told when the server stops; at once, if it is stopping already.
class Registered : public SessionContext::Ender {
 public:
  Registered(SessionContext& context, std::function<void()> end) : context_(context), end_(std::move(end)) {
    context_.sessions.insert(this);
    if (context_.stopping) end_();
  }
  ~Registered() override { context_.sessions.erase(this); }
  Registered(const Registered&) = delete;
  Registered& operator=(const Registered&) = delete;
  void end_soon() override { end_(); }

 private:
  SessionContext& context_;
  std::function<void()> end_;
};

/// How long a client may take to say what it is, to finish a request's header, or between two requests of HTTP.
inline constexpr std::chrono::seconds kFirstBytes{5};
inline constexpr std::chrono::seconds kHttpIdle{30};
/// How long answers may take to leave when the connection is to end.
inline constexpr std::chrono::seconds kFarewell{5};

/// A client of the network without authentication: everyone may do everything.
inline constexpr commands::Role kEveryonesRole = commands::Role::Admin;

}  // namespace tweend::net

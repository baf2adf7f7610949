#pragma once

#include <any>
#include <concepts>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/type_info.hpp"
#include "server/commands/services.hpp"
#include "server/commands/wire_types.hpp"

// What a handler looks like, and how its type is erased into a row of the command table. A handler takes its decoded
// parameters and a context, and returns its result struct; JSON stays on the other side of protocol::decode and encode.

namespace tweend::commands {

/// Each includes those before it.
enum class Role : std::uint8_t { View, Control, Admin };
[[nodiscard]] std::string_view role_name(Role role) noexcept;

/// Where and after what a command is carried out.
enum class Shape : std::uint8_t {
  Ping,         ///< network thread, at once
  Query,        ///< network thread: reads the published view
  WorkerQuery,  ///< a worker: reads files, evaluates, or answers at length
  AsyncQuery,   ///< begun on the network thread with the view of that moment; answered from wherever it ends
  Edit,         ///< planned on the stage's strand; pipelined
  HeavyEdit,    ///< planned on a worker first, to warm its scratch, then on the strand
  SceneEdit,    ///< creates or removes a scene, or moves in its history
  Players,      ///< the stage's strand: a turn at the players
  Connection,   ///< network thread: what this client is sent (events, streams)
};

class Conversation;

/// What a query sees: everything published, at one reading of the clock.
struct QueryContext {
  const Services& services;
  stage::StageViewPtr view;
  ClockUs now_us = 0;
};

/// What an edit has worked out and need not again: a plan runs on a worker first and then, with the same scratch, on the
/// strand, where only what depends on a newer head is done anew.
class EditScratch {
 public:
  /// The value under `key`, made by `make` the first time. T is what `make` returns.
  template <class Make>
  auto once(const std::string& key, Make&& make) -> decltype(make())& {
    using T = decltype(make());
    std::any& slot = values_[key];
    if (!slot.has_value()) slot = std::make_shared<T>(make());
    return *std::any_cast<std::shared_ptr<T>&>(slot);
  }

 private:
  std::map<std::string, std::any> values_;
};

/// What an edit's plan works with.
struct EditContext {
  const Services& services;
  stage::Transaction& transaction;
  EditScratch& scratch;
  std::string scratch_prefix;  ///< tells the edits of an edit.apply apart
  stage::SceneViewPtr view;    ///< the published scene: its players say which clip is meant, and what is shown
  ClockUs now_us = 0;          ///< the request's reading: "this moment" for `capture`

  [[nodiscard]] const model::Scene& scene() const noexcept { return transaction.scene(); }
  template <class Make>
  auto& once(const std::string& key, Make&& make) {
    return scratch.once(scratch_prefix + key, std::forward<Make>(make));
  }
};

using Params = std::shared_ptr<void>;  ///< decoded, of the type that Command::params describes

/// A connection command answers, and may have something to do once its answer is on its way.
struct ConnectionAnswer {
  Result<std::string> result;
  std::function<void()> afterwards;
};
using ConnectionDone = std::function<void(ConnectionAnswer)>;

/// Takes the answer of a query that ends elsewhere, on any thread. Once.
template <class R>
using AsyncDone = std::function<void(Result<R>)>;

/// One row of the table.
struct Command {
  std::string_view name;
  Role role = Role::View;
  Shape shape = Shape::Query;
  std::string_view summary;
  const protocol::TypeInfo* params = nullptr;
  const protocol::TypeInfo* result = nullptr;

  Params (*make_params)() = nullptr;
  // The one that fits the shape is set:
  Result<std::string> (*query)(const void*, const QueryContext&) = nullptr;
  void (*async_query)(const void*, const QueryContext&, AsyncDone<std::string>) = nullptr;
  Result<std::string> (*edit)(const void*, EditContext&) = nullptr;
  const EditTarget& (*target)(const void*) = nullptr;
  /// Set for what takes at_us.
  const Timed& (*timed)(const void*) = nullptr;
  void (*scene_edit)(const void*, const Services&, stage::EditOptions, stage::EditDone) = nullptr;
  Result<std::vector<std::size_t>> (*players)(const void*, const stage::PlayersTurn&) = nullptr;
  std::string (*players_scene)(const void*) = nullptr;
  std::string (*players_answer)(const stage::PlayersAnswer&) = nullptr;
  void (*connection)(const void*, const std::shared_ptr<Conversation>&, const ConnectionDone&) = nullptr;

  [[nodiscard]] bool is_edit() const noexcept {
    return shape == Shape::Edit || shape == Shape::HeavyEdit || shape == Shape::SceneEdit;
  }
};

/// Decodes parameters of a row; errors name the path.
[[nodiscard]] Result<Params> decode_params(const Command& command, const protocol::JsonValue& params,
                                           const std::string& path = "params");

namespace detail {

template <class F>
struct Signature;
template <class R, class P, class C>
struct Signature<R (*)(const P&, C&)> {
  using Answer = R;
  using Request = P;
};
template <class R, class P, class C>
struct Signature<R (*)(const P&, const C&)> {
  using Answer = R;
  using Request = P;
};
template <class R>
struct Unwrapped {
  using Type = R;
};
template <class T>
struct Unwrapped<Result<T>> {
  using Type = T;
};

template <class P>
Command row(std::string_view name, Role role, Shape shape, std::string_view summary) {
  Command c;
  c.name = name;
  c.role = role;
  c.shape = shape;
  c.summary = summary;
  c.params = &protocol::type_of<P>();
  c.make_params = []() -> Params { return std::make_shared<P>(); };
  if constexpr (std::derived_from<P, Timed>) {
    c.timed = [](const void* p) -> const Timed& { return *static_cast<const P*>(p); };
  }
  return c;
}

template <class T>
Result<std::string> encoded(const Result<T>& result) {
  if (!result) return result.error();
  return protocol::encode(*result);
}

}  // namespace detail

/// `Result<R> handler(const P&, const QueryContext&)`
template <auto Handler>
Command query_command(std::string_view name, Role role, std::string_view summary, Shape shape = Shape::Query) {
  using S = detail::Signature<decltype(Handler)>;
  Command c = detail::row<typename S::Request>(name, role, shape, summary);
  c.result = &protocol::type_of<typename detail::Unwrapped<typename S::Answer>::Type>();
  c.query = [](const void* p, const QueryContext& context) {
    return detail::encoded(Handler(*static_cast<const typename S::Request*>(p), context));
  };
  return c;
}

/// `void handler(const P&, const QueryContext&, const AsyncDone<R>&)`
template <class R, class P, void (*Handler)(const P&, const QueryContext&, const AsyncDone<R>&)>
Command async_query_command(std::string_view name, Role role, std::string_view summary) {
  Command c = detail::row<P>(name, role, Shape::AsyncQuery, summary);
  c.result = &protocol::type_of<R>();
  c.async_query = [](const void* p, const QueryContext& context, AsyncDone<std::string> done) {
    Handler(*static_cast<const P*>(p), context,
            [done = std::move(done)](const Result<R>& result) { done(detail::encoded(result)); });
  };
  return c;
}

/// `Result<R> handler(const P&, EditContext&)`; P derives from EditTarget, R has `revision`, which is filled in here.
template <auto Handler>
Command edit_command(std::string_view name, Role role, std::string_view summary, Shape shape = Shape::Edit) {
  using S = detail::Signature<decltype(Handler)>;
  Command c = detail::row<typename S::Request>(name, role, shape, summary);
  c.result = &protocol::type_of<typename detail::Unwrapped<typename S::Answer>::Type>();
  c.target = [](const void* p) -> const EditTarget& { return *static_cast<const typename S::Request*>(p); };
  c.edit = [](const void* p, EditContext& context) -> Result<std::string> {
    auto result = Handler(*static_cast<const typename S::Request*>(p), context);
    if (result) result->revision = context.transaction.revision();
    return detail::encoded(result);
  };
  return c;
}

/// `Result<std::vector<std::size_t>> handler(const P&, const stage::PlayersTurn&)`: the players concerned, of which
/// `playback.changed` tells, and the answer.
template <auto Handler, class R = PlayersResult>
Command players_command(std::string_view name, std::string_view summary) {
  using S = detail::Signature<decltype(Handler)>;
  Command c = detail::row<typename S::Request>(name, Role::Control, Shape::Players, summary);
  c.result = &protocol::type_of<R>();
  c.players_answer = [](const stage::PlayersAnswer& answer) {
    if constexpr (std::is_same_v<R, PlayersResult>) {
      return protocol::encode(players_result(*answer.view, answer.concerned, answer.now_us));
    } else {
      return protocol::encode(R{});
    }
  };
  c.players = [](const void* p, const stage::PlayersTurn& turn) {
    return Handler(*static_cast<const typename S::Request*>(p), turn);
  };
  c.players_scene = [](const void* p) { return scene_or_main(static_cast<const typename S::Request*>(p)->scene); };
  return c;
}

/// `void handler(const P&, const Services&, stage::EditOptions, stage::EditDone)`
template <class R, class P, void (*Handler)(const P&, const Services&, stage::EditOptions, stage::EditDone)>
Command scene_command(std::string_view name, Role role, std::string_view summary) {
  Command c = detail::row<P>(name, role, Shape::SceneEdit, summary);
  c.result = &protocol::type_of<R>();
  c.target = [](const void* p) -> const EditTarget& { return *static_cast<const P*>(p); };
  c.scene_edit = [](const void* p, const Services& services, stage::EditOptions options, stage::EditDone done) {
    Handler(*static_cast<const P*>(p), services, std::move(options), std::move(done));
  };
  return c;
}

/// `void handler(const P&, const std::shared_ptr<Conversation>&, const ConnectionDone&)`
template <class R, class P, void (*Handler)(const P&, const std::shared_ptr<Conversation>&, const ConnectionDone&)>
Command connection_command(std::string_view name, std::string_view summary) {
  Command c = detail::row<P>(name, Role::View, Shape::Connection, summary);
  c.result = &protocol::type_of<R>();
  c.connection = [](const void* p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done) {
    Handler(*static_cast<const P*>(p), conversation, done);
  };
  return c;
}

}  // namespace tweend::commands

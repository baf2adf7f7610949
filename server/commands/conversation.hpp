#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/envelope.hpp"
#include "server/commands/command.hpp"
#include "server/commands/peer.hpp"

namespace tweend::commands {

/// One client's requests: carried out and answered in the order they came, edits pipelined.
///
/// Lives on the network thread and never waits: messages wait in units, each with a slot for every answer, and a unit's text
/// leaves when all its slots and all units before it are full. `server.ping` alone overtakes.
class Conversation : public std::enable_shared_from_this<Conversation> {
 public:
  /// @param to_network  posts to the thread this lives on
  Conversation(const Services& services, Post to_network, std::shared_ptr<Peer> peer, Role role);

  /// Takes one message. Large ones are parsed on a worker, in their place.
  void receive(std::string text);
  /// Answers a message that could not even be taken (too long, not UTF-8) in its place in the order.
  void reject(const Error& error);
  /// Whether another message may be read, or enough of them wait already.
  [[nodiscard]] bool wants_more() const noexcept;
  /// Whether everything has been answered.
  [[nodiscard]] bool settled() const noexcept { return units_.empty(); }
  /// The peer has taken what was sent: whatever was held back goes on.
  void resume();
  /// The client is gone: ends its streams and subscriptions; what is under way ends unheard.
  void close();
  /// A stream's actor or scene is gone: tells the client.
  void stream_ended(std::uint32_t stream, const std::string& reason);
  /// Its producer is told that this stream has gone.
  void unsubscribe_later(std::uint32_t stream, const streams::StreamKey& key) const;
  /// An adaptive stream goes on with another rung of the ladder; one that was closed does not.
  void move_to_rung(std::uint32_t stream, std::size_t rung);
  /// Told after every change that may let the connection read on or close.
  void on_progress(Task progress) { progress_ = std::move(progress); }

  // For connection commands (network thread):
  [[nodiscard]] const Services& services() const noexcept { return services_; }
  [[nodiscard]] const Post& to_network() const noexcept { return to_network_; }
  [[nodiscard]] const std::shared_ptr<Peer>& peer() const noexcept { return peer_; }
  [[nodiscard]] bool closed() const noexcept { return closed_; }
  /// A stream that was opened. Its producer hears of it once the answer is on its way, which in a batch may be much later.
  struct OpenStream {
    streams::StreamKey key;
    bool subscribed = false;
  };
  /// This connection's streams, by their number.
  [[nodiscard]] std::map<std::uint32_t, OpenStream>& streams() noexcept { return streams_; }
  [[nodiscard]] bool has_stream(std::uint32_t stream) const noexcept { return streams_.contains(stream); }
  [[nodiscard]] std::uint32_t next_stream() noexcept { return ++last_stream_; }

 private:
  struct Item {
    std::string id;  ///< empty: a notification
    const Command* command = nullptr;
    Params params;
    std::optional<Error> refused;  ///< decided while decoding
    std::string text;
    Task afterwards;
  };
  struct Unit {
    std::uint64_t number = 0;
    bool parsed = false;
    bool batch = false;
    std::vector<Item> items;
    std::size_t answered = 0;
    std::size_t bytes = 0;
    std::size_t answer_bytes = 0;
  };
  struct ItemKey {
    std::uint64_t unit;
    std::size_t item;
  };

  /// An answer as it will leave; empty for a notification.
  struct Answer {
    std::string text;
    bool failed = false;
  };

  [[nodiscard]] static std::vector<Item> decode_items(const protocol::Message& message);
  void parsed(std::uint64_t unit, bool batch, std::vector<Item> items);
  void advance();
  [[nodiscard]] bool may_start(const Item& item) const noexcept;
  void start(const ItemKey& key);
  void start_query(const ItemKey& key, Item& item);
  void start_worker_query(const ItemKey& key, Item& item);
  void start_async_query(const ItemKey& key, Item& item);
  void start_edit(const ItemKey& key, Item& item);
  void start_players(const ItemKey& key, Item& item);
  void start_timed(const ItemKey& key, Item& item);
  void start_connection(const ItemKey& key, Item& item);
  void plan_on_strand(const ItemKey& key, const Command& command, Params params, std::shared_ptr<EditScratch> scratch,
                      ClockUs now_us);
  void started(bool edit);
  /// From any thread.
  void finish_later(const ItemKey& key, Result<std::string> result);
  void finish(const ItemKey& key, const Result<std::string>& result, Task afterwards = {});
  void finish(const ItemKey& key, Answer answer, Task afterwards = {});
  [[nodiscard]] static Answer print(const std::string& id, const Result<std::string>& result);
  void flush();
  [[nodiscard]] Unit* find_unit(std::uint64_t number) noexcept;

  const Services services_;
  const Post to_network_;
  const std::shared_ptr<Peer> peer_;
  const Role role_;
  Task progress_;
  std::deque<Unit> units_;
  std::uint64_t next_unit_ = 1;
  ItemKey cursor_{1, 0};  ///< what is started next
  std::size_t queued_bytes_ = 0;
  std::size_t outstanding_ = 0;  ///< started, not yet answered
  std::size_t outstanding_edits_ = 0;
  bool worker_busy_ = false;  ///< a request is with a worker: its effects are not in the strand's queue yet
  bool advancing_ = false;
  bool closed_ = false;
  std::map<std::uint32_t, OpenStream> streams_;
  std::uint32_t last_stream_ = 0;
};

}  // namespace tweend::commands

import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { Connection, ConnectionLost, RpcError, backoff_ms } from "../../clients/web/connection.js";
import { FakeSocket, FakeTimers, settled } from "./support/fake_socket.mjs";

const kHello = { server: "tweend", version: "1", protocol: 1, role: "admin", capabilities: [] };

let sockets, timers, connection, phases;

function make(options = {}) {
  sockets = [];
  timers = new FakeTimers();
  connection = new Connection({
    url: "ws://host/ws",
    client: "test",
    open_socket: () => sockets[sockets.push(new FakeSocket()) - 1],
    timers,
    random: () => 0.5,
    ...options,
  });
  phases = [];
  connection.states.add((s) => phases.push(s.phase));
}

async function open() {
  connection.start();
  const socket = sockets.at(-1);
  socket.opens();
  socket.answers("server.hello", kHello);
  await settled();
  return socket;
}

beforeEach(() => make());

describe("opening", () => {
  test("a call without a connection is refused", async () => {
    await assert.rejects(connection.call("server.ping"), ConnectionLost);
  });

  test("the first message is hello, and only its answer opens", async () => {
    connection.start();
    sockets[0].opens();
    assert.deepEqual(sockets[0].sent.map((m) => [m.jsonrpc, m.method, m.params]), [["2.0", "server.hello", { client: "test" }]]);
    assert.equal(connection.state.phase, "connecting");
    sockets[0].answers("server.hello", kHello);
    await settled();
    assert.equal(connection.state.phase, "open");
    assert.deepEqual(connection.state.hello, kHello);
    assert.deepEqual(phases, ["connecting", "open"]);
  });

  test("a token is passed to hello", () => {
    make({ token: "secret" });
    connection.start();
    sockets[0].opens();
    assert.equal(sockets[0].sent[0].params.token, "secret");
  });

  test("a hello that is refused is final, and says why", async () => {
    connection.start();
    sockets[0].opens();
    sockets[0].refuses("server.hello", { code: -32003, message: "forbidden", data: { kind: "forbidden", message: "expected a token" } });
    await settled();
    assert.equal(connection.state.phase, "refused");
    assert.equal(connection.state.reason, "expected a token");
    assert.ok(sockets[0].closed);
    assert.deepEqual(timers.waiting, []);
  });

  test("a server that does not say hello is given up", () => {
    connection.start();
    sockets[0].opens();
    timers.pass(8000);
    assert.equal(connection.state.phase, "waiting");
    assert.ok(sockets[0].closed);
  });
});

describe("calls", () => {
  test("answers find their calls whatever their order", async () => {
    const socket = await open();
    const [first, second] = [connection.call("a.one", { x: 1 }), connection.call("a.two")];
    assert.notEqual(socket.asked("a.one").id, socket.asked("a.two").id);
    assert.deepEqual(socket.asked("a.one").params, { x: 1 });
    socket.answers("a.two", 2);
    socket.answers("a.one", 1);
    assert.deepEqual(await Promise.all([first, second]), [1, 2]);
  });

  test("an error is the server's own words", async () => {
    const socket = await open();
    const call = connection.call("playback.seek", { time: "x" });
    socket.refuses("playback.seek", {
      code: -32602,
      message: "a parameter is not valid",
      data: { kind: "invalid_params", path: "params.time", message: "expected a number, found a string" },
    });
    await assert.rejects(call, (error) => {
      assert.ok(error instanceof RpcError);
      assert.deepEqual(
        [error.method, error.code, error.kind, error.path, error.message],
        ["playback.seek", -32602, "invalid_params", "params.time", "expected a number, found a string"],
      );
      return true;
    });
  });

  test("an error without data has its message", async () => {
    const socket = await open();
    const call = connection.call("x");
    socket.refuses("x", { code: -32601, message: "no such method" });
    await assert.rejects(call, /no such method/);
  });

  test("events and packets go to those who listen", async () => {
    const socket = await open();
    const got = [];
    connection.events.add((e) => got.push(e));
    const end = connection.packets.add((p) => got.push(p));
    const packet = new ArrayBuffer(4);
    socket.says({ jsonrpc: "2.0", method: "playback.ended", params: { actor: "a" } });
    socket.says(packet);
    end();
    socket.says(packet);
    assert.deepEqual(got, [{ method: "playback.ended", params: { actor: "a" } }, packet]);
  });

  test("an answer to nobody is let pass", async () => {
    const socket = await open();
    socket.says({ jsonrpc: "2.0", id: 999, result: {} });
    assert.equal(connection.state.phase, "open");
  });
});

describe("coming back", () => {
  test("waits double up to a bound, with a fifth of jitter", () => {
    assert.deepEqual([1, 2, 3, 4, 5, 6, 50].map((n) => backoff_ms(n, 0.5)), [250, 500, 1000, 2000, 4000, 5000, 5000]);
    assert.equal(backoff_ms(1, 0), 200);
    assert.equal(backoff_ms(1, 1), 300);
  });

  test("what waits for an answer is told that none will come", async () => {
    const socket = await open();
    const calls = [connection.call("a"), connection.call("b")];
    socket.breaks("going down");
    for (const call of calls) await assert.rejects(call, ConnectionLost);
    assert.equal(connection.state.phase, "waiting");
    assert.equal(connection.state.reason, "going down");
    await assert.rejects(connection.call("c"), ConnectionLost);
  });

  test("it tries again, later each time, and says so", async () => {
    await open();
    sockets[0].breaks();
    assert.deepEqual([connection.state.phase, connection.state.retry_ms], ["waiting", 250]);
    timers.pass(249);
    assert.equal(sockets.length, 1);
    timers.pass(1);
    assert.equal(sockets.length, 2);
    assert.equal(connection.state.phase, "connecting");
    sockets[1].breaks();
    assert.equal(connection.state.retry_ms, 500);
    timers.pass(500);
    sockets[2].opens();
    sockets[2].answers("server.hello", kHello);
    await settled();
    assert.deepEqual(phases, ["connecting", "open", "waiting", "connecting", "waiting", "connecting", "open"]);
  });

  test("a connection that has lived counts as a good one", async () => {
    await open();
    for (const wait of [250, 500, 1000]) {
      sockets.at(-1).breaks();
      assert.equal(connection.state.retry_ms, wait);
      timers.pass(wait);
    }
    sockets.at(-1).opens();
    sockets.at(-1).answers("server.hello", kHello);
    await settled();
    timers.pass(5000);
    sockets.at(-1).breaks();
    assert.equal(connection.state.retry_ms, 250);
  });

  test("one that breaks at once does not", async () => {
    await open();
    sockets[0].breaks();
    timers.pass(250);
    sockets[1].opens();
    sockets[1].answers("server.hello", kHello);
    await settled();
    sockets[1].breaks();
    assert.equal(connection.state.retry_ms, 500);
  });

  test("who is impatient need not wait", async () => {
    await open();
    sockets[0].breaks();
    connection.start();
    assert.equal(sockets.length, 2);
    connection.start();
    assert.equal(sockets.length, 2, "one at a time");
    timers.pass(7000);
    assert.equal(sockets.length, 2, "the wait that was cut short is forgotten");
  });

  test("a socket that was given up is not listened to any more", async () => {
    const socket = await open();
    const got = [];
    connection.events.add((e) => got.push(e));
    connection.restart("no answer");
    timers.pass(250);
    socket.says({ jsonrpc: "2.0", method: "playback.ended", params: {} });
    socket.breaks();
    assert.deepEqual(got, []);
    assert.equal(connection.state.phase, "connecting");
  });

  test("what is not JSON ends the connection", async () => {
    const socket = await open();
    socket.says("<html>");
    assert.equal(connection.state.phase, "waiting");
    assert.match(connection.state.reason, /expected JSON.*<html>/);
  });

  test("stopped is stopped", async () => {
    const socket = await open();
    const call = connection.call("a");
    connection.stop();
    await assert.rejects(call, ConnectionLost);
    assert.ok(socket.closed);
    assert.deepEqual(timers.waiting, []);
    assert.equal(connection.state.phase, "stopped");
  });
});

/**
 * The WebSocket: JSON-RPC calls and their answers, events, packets; it comes back by itself. The only part of the page that
 * sees a socket.
 *
 * @import {HelloMessage, ServerEvent} from "./protocol_types.js"
 */
import { Listeners } from "./listeners.js";

export const kSubprotocol = "tweend.v1";

const kFirstRetry_ms = 250;
const kLongestRetry_ms = 5000;
/** A connection that lived this long was a good one: the next retry comes early again. */
const kGoodLife_ms = 5000;
/** How long the server may take to say hello. */
const kHello_ms = 8000;

/**
 * @typedef {"connecting" | "open" | "waiting" | "refused" | "stopped"} Phase
 *   waiting: for the next attempt; refused: the server does not want us, so there is no next attempt
 *
 * @typedef {object} ConnectionState
 * @property {Phase} phase
 * @property {string} reason    why it is not open, for a person
 * @property {number} retry_ms  waiting: how long, from the moment this was said
 * @property {HelloMessage | null} hello  open: what the server said of itself
 *
 * @typedef {object} Timers
 * @property {(action: () => void, ms: number) => any} set
 * @property {(timer: any) => void} clear
 * @property {() => number} now_ms
 *
 * @typedef {object} ConnectionOptions
 * @property {string} url
 * @property {string} client     who we are, for the server's log
 * @property {string} [token]
 * @property {(url: string) => WebSocket} [open_socket]
 * @property {Timers} [timers]
 * @property {() => number} [random]  0 … 1
 *
 * @typedef {object} Pending
 * @property {(result: any) => void} resolve
 * @property {(error: Error) => void} reject
 * @property {string} method
 */

/** An error that the server answered. */
export class RpcError extends Error {
  /**
   * @param {string} method
   * @param {{code: number, message: string, data?: {kind?: string, path?: string, message?: string}}} error
   */
  constructor(method, error) {
    super(error.data?.message || error.message);
    this.name = "RpcError";
    this.method = method;
    this.code = error.code;
    this.kind = error.data?.kind ?? "";
    this.path = error.data?.path ?? "";
  }
}

/** The connection is not there, or went before the answer came. Views need not repeat it: the state says so already. */
export class ConnectionLost extends Error {
  /** @param {string} message */
  constructor(message) {
    super(message);
    this.name = "ConnectionLost";
  }
}

/**
 * How long to wait before an attempt: doubling, with a fifth of jitter so that pages do not return all at once.
 * @param {number} failures  attempts that failed in a row, from 1
 * @param {number} random    0 … 1
 */
export function backoff_ms(failures, random) {
  const plain = Math.min(kFirstRetry_ms * 2 ** (failures - 1), kLongestRetry_ms);
  return Math.round(plain * (0.8 + 0.4 * random));
}

/** @type {Timers} */
const kWindowTimers = {
  set: (action, ms) => setTimeout(action, ms),
  clear: (timer) => clearTimeout(timer),
  now_ms: () => performance.now(),
};

export class Connection {
  #options;
  /** @type {Timers} */
  #timers;
  /** @type {WebSocket | null} */
  #socket = null;
  /** @type {Map<number, Pending>} */
  #pending = new Map();
  #next_id = 1;
  #failures = 0;
  #opened_ms = 0;
  /** @type {any} the next attempt, or the end of our patience with this one */
  #timer = null;
  /** @type {ConnectionState} */
  #state = { phase: "stopped", reason: "", retry_ms: 0, hello: null };

  /** @type {Listeners<ConnectionState>} */
  states = new Listeners();
  /** @type {Listeners<ServerEvent>} */
  events = new Listeners();
  /** @type {Listeners<ArrayBuffer>} */
  packets = new Listeners();

  /** @param {ConnectionOptions} options */
  constructor(options) {
    this.#options = options;
    this.#timers = options.timers ?? kWindowTimers;
  }

  get state() {
    return this.#state;
  }

  /** Connects; also at once, if it waits for its next attempt. */
  start() {
    if (this.#socket) return;
    this.#clear_timer();
    this.#open();
  }

  /** Ends it for good. */
  stop() {
    this.#clear_timer();
    this.#let_go("the page has ended the connection");
    this.#say({ phase: "stopped", reason: "", retry_ms: 0, hello: null });
  }

  /**
   * Gives up this socket, whose other end does not answer any more, and connects anew.
   * @param {string} reason
   */
  restart(reason) {
    if (this.#socket) this.#lost(reason);
  }

  /**
   * @param {string} method
   * @param {Record<string, unknown>} [params]
   * @returns {Promise<any>} the result
   * @throws {RpcError} the server's answer
   * @throws {ConnectionLost} not connected, or not any more; whether the call was carried out is unknown then
   */
  call(method, params = {}) {
    if (this.#state.phase !== "open") {
      return Promise.reject(new ConnectionLost(`${method}: expected a connection, found none`));
    }
    return this.#request(method, params);
  }

  /**
   * @param {string} method
   * @param {Record<string, unknown>} params
   * @returns {Promise<any>}
   */
  #request(method, params) {
    const id = this.#next_id++;
    return new Promise((resolve, reject) => {
      this.#pending.set(id, { resolve, reject, method });
      this.#socket?.send(JSON.stringify({ jsonrpc: "2.0", id, method, params }));
    });
  }

  #open() {
    const open_socket = this.#options.open_socket ?? ((url) => new WebSocket(url, kSubprotocol));
    const socket = open_socket(this.#options.url);
    this.#socket = socket;
    socket.binaryType = "arraybuffer";
    /** @param {() => void} action @returns {() => void} that it does nothing once another socket has taken over */
    const mine = (action) => () => this.#socket === socket && action();
    socket.onopen = mine(() => void this.#hello());
    socket.onclose = (event) => mine(() => this.#lost(event.reason || "the server can't be reached"))();
    socket.onmessage = (event) => mine(() => this.#receive(event.data))();
    this.#say({ phase: "connecting", reason: this.#state.reason, retry_ms: 0, hello: null });
    this.#timer = this.#timers.set(() => this.#lost("the server does not answer"), kHello_ms);
  }

  async #hello() {
    const { client, token } = this.#options;
    const socket = this.#socket;
    try {
      const hello = await this.#request("server.hello", token ? { client, token } : { client });
      if (this.#socket !== socket) return;
      this.#clear_timer();
      this.#opened_ms = this.#timers.now_ms();
      this.#say({ phase: "open", reason: "", retry_ms: 0, hello });
    } catch (error) {
      // Asking again would be answered the same.
      if (error instanceof RpcError) this.#refuse(error.message);
    }
  }

  /** @param {string} reason */
  #refuse(reason) {
    this.#clear_timer();
    this.#let_go(reason);
    this.#say({ phase: "refused", reason, retry_ms: 0, hello: null });
  }

  /** @param {string | ArrayBuffer} data */
  #receive(data) {
    if (typeof data !== "string") {
      this.packets.tell(data);
      return;
    }
    /** @type {any} */
    let message;
    try {
      message = JSON.parse(data);
    } catch {
      this.#lost(`expected JSON from the server, found "${data.slice(0, 40)}"`);
      return;
    }
    if (message.method) {
      this.events.tell({ method: message.method, params: message.params ?? {} });
      return;
    }
    const pending = this.#pending.get(message.id);
    if (!pending) return; // to nobody who waits
    this.#pending.delete(message.id);
    if (message.error) pending.reject(new RpcError(pending.method, message.error));
    else pending.resolve(message.result);
  }

  /** @param {string} reason */
  #lost(reason) {
    const was_good = this.#state.phase === "open" && this.#timers.now_ms() - this.#opened_ms >= kGoodLife_ms;
    this.#clear_timer();
    this.#let_go(reason);
    this.#failures = was_good ? 1 : this.#failures + 1;
    const retry_ms = backoff_ms(this.#failures, (this.#options.random ?? Math.random)());
    this.#timer = this.#timers.set(() => this.start(), retry_ms);
    this.#say({ phase: "waiting", reason, retry_ms, hello: null });
  }

  /** @param {string} reason */
  #let_go(reason) {
    const socket = this.#socket;
    this.#socket = null;
    socket?.close();
    const pending = [...this.#pending.values()];
    this.#pending.clear();
    for (const { reject, method } of pending) reject(new ConnectionLost(`${method}: no answer, ${reason}`));
  }

  #clear_timer() {
    this.#timers.clear(this.#timer);
    this.#timer = null;
  }

  /** @param {ConnectionState} state */
  #say(state) {
    this.#state = state;
    this.states.tell(state);
  }
}

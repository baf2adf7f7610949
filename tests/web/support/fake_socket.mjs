/**
 * A WebSocket whose other end is the test, and time that passes when the test says so.
 */
export class FakeSocket {
  /** @type {any[]} what the page has sent, parsed */
  sent = [];
  closed = false;
  onopen = () => {};
  onclose = (_event) => {};
  onmessage = (_event) => {};

  send(text) {
    this.sent.push(JSON.parse(text));
  }
  close() {
    this.closed = true;
  }

  opens() {
    this.onopen();
  }
  says(message) {
    this.onmessage({ data: typeof message === "string" || message instanceof ArrayBuffer ? message : JSON.stringify(message) });
  }
  /** Answers the last request of that method. */
  answers(method, result) {
    this.says({ jsonrpc: "2.0", id: this.asked(method).id, result });
  }
  refuses(method, error) {
    this.says({ jsonrpc: "2.0", id: this.asked(method).id, error });
  }
  asked(method) {
    const request = this.sent.findLast((m) => m.method === method);
    if (!request) throw new Error(`expected a request ${method}, found ${this.sent.map((m) => m.method).join(", ") || "none"}`);
    return request;
  }
  breaks(reason = "") {
    this.onclose({ reason });
  }
}

export class FakeTimers {
  #now_ms = 0;
  #due = new Map();
  #next = 1;

  set = (action, ms) => {
    this.#due.set(this.#next, { action, at_ms: this.#now_ms + ms });
    return this.#next++;
  };
  clear = (timer) => this.#due.delete(timer);
  now_ms = () => this.#now_ms;

  /** What is set to happen, in milliseconds from now. */
  get waiting() {
    return [...this.#due.values()].map((d) => d.at_ms - this.#now_ms);
  }
  pass(ms) {
    this.#now_ms += ms;
    for (const [timer, { action, at_ms }] of [...this.#due]) {
      if (at_ms <= this.#now_ms && this.#due.delete(timer)) action();
    }
  }
}

/** Lets promises that have been settled say so. */
export const settled = () => new Promise((resolve) => setImmediate(resolve));

/**
 * Sends the newest of many values, one at a time: while one is on its way, only the newest of those that come waits. What a
 * dragged slider needs, so that it never runs behind a slow connection.
 * @template T
 */
export class Latest {
  #send;
  /** @type {{value: T} | null} */
  #waiting = null;
  #busy = false;

  /** @param {(value: T) => Promise<unknown>} send  its failures are its own business: reported before it settles */
  constructor(send) {
    this.#send = send;
  }

  /** Whether a value is on its way or waits for that. */
  get busy() {
    return this.#busy;
  }

  /** @param {T} value */
  push(value) {
    this.#waiting = { value };
    if (!this.#busy) void this.#run();
  }

  async #run() {
    this.#busy = true;
    while (this.#waiting) {
      const { value } = this.#waiting;
      this.#waiting = null;
      try {
        await this.#send(value);
      } catch {
        // The sender has said it; what came meanwhile is tried all the same.
      }
    }
    this.#busy = false;
  }
}

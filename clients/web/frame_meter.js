/**
 * How many pictures a second were drawn of late, how old they were, and how much came for them. Pure: time is a parameter.
 */

const kWindow_ms = 1000;

export class FrameMeter {
  /** @type {{at_ms: number, age_ms: number | null}[]} */
  #frames = [];
  /** @type {{at_ms: number, bytes: number}[]} */
  #received = [];

  /**
   * @param {number} at_ms
   * @param {number | null} age_ms  null: the server's clock is not known yet
   */
  add(at_ms, age_ms) {
    this.#frames.push({ at_ms, age_ms });
    this.#forget(at_ms);
  }

  /**
   * @param {number} at_ms
   * @param {number} bytes  of a packet, whether it will be drawn or not
   */
  receive(at_ms, bytes) {
    this.#received.push({ at_ms, bytes });
    this.#forget(at_ms);
  }

  /**
   * @param {number} now_ms
   * @returns {{per_second: number, age_ms: number | null, bytes_per_second: number}} the age is the median, null where nobody knows
   */
  read(now_ms) {
    this.#forget(now_ms);
    const ages = this.#frames.flatMap((f) => f.age_ms ?? []).sort((a, b) => a - b);
    return {
      per_second: this.#frames.length,
      age_ms: ages[Math.floor(ages.length / 2)] ?? null,
      bytes_per_second: this.#received.reduce((sum, r) => sum + r.bytes, 0),
    };
  }

  /** @param {number} now_ms */
  #forget(now_ms) {
    this.#frames = this.#frames.filter((f) => now_ms - f.at_ms < kWindow_ms);
    this.#received = this.#received.filter((r) => now_ms - r.at_ms < kWindow_ms);
  }
}

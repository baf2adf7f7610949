/**
 * Tells when a stream loses packets again and again, as it does where a connection takes less than the stream brings. Pure: time
 * is a parameter.
 */

const kWindow_ms = 10_000;
/** Gaps so close are one trouble: a stall, or a hand on the time line, whose newest pictures replace those that wait. */
const kOneTrouble_ms = 1000;
const kMostTroubles = 4;

export class GapWatch {
  /** @type {number | null} */
  #sequence = null;
  /** @type {number[]} when each trouble began */
  #troubles_ms = [];

  /** Another stream begins, whose numbers are its own. */
  begin() {
    this.#sequence = null;
    this.#troubles_ms = [];
  }

  /**
   * @param {number} at_ms
   * @param {number} sequence  of a packet
   * @returns {boolean} whether there have been too many gaps of late
   */
  receive(at_ms, sequence) {
    const expected = this.#sequence === null ? sequence : (this.#sequence + 1) >>> 0;
    this.#sequence = sequence;
    this.#troubles_ms = this.#troubles_ms.filter((trouble_ms) => at_ms - trouble_ms < kWindow_ms);
    const last_ms = this.#troubles_ms.at(-1) ?? -Infinity;
    if (sequence !== expected && at_ms - last_ms >= kOneTrouble_ms) this.#troubles_ms.push(at_ms);
    return this.#troubles_ms.length >= kMostTroubles;
  }
}

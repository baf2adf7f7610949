/**
 * Tells when a stream loses packets again and again, as it does where a connection takes less than the stream brings. Pure: time
 * is a parameter.
 *
 * @import {Packet} from "./packet.js"
 */

const kWindow_ms = 10_000;
/** A stall makes one gap; a connection that is too slow one a second or more. */
const kMostGaps = 3;

export class GapWatch {
  /** @type {number | null} */
  #sequence = null;
  /** @type {number[]} when there were gaps */
  #gaps_ms = [];

  /** Another stream begins, whose numbers are its own. */
  begin() {
    this.#sequence = null;
    this.#gaps_ms = [];
  }

  /**
   * Where playback jumps again and again, as under a hand on the time line, newer packets replace older ones on any connection:
   * such gaps say nothing.
   * @param {number} at_ms
   * @param {Pick<Packet, "sequence" | "discontinuity">} packet
   * @returns {boolean} whether there have been too many gaps of late
   */
  receive(at_ms, { sequence, discontinuity }) {
    const expected = this.#sequence === null ? sequence : (this.#sequence + 1) >>> 0;
    this.#sequence = sequence;
    this.#gaps_ms = this.#gaps_ms.filter((gap_ms) => at_ms - gap_ms < kWindow_ms);
    if (sequence !== expected && !discontinuity) this.#gaps_ms.push(at_ms);
    return this.#gaps_ms.length >= kMostGaps;
  }
}

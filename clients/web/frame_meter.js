/**
 * How many pictures a second were drawn of late, and how old they were. Pure: time is a parameter.
 */

const kWindow_ms = 1000;

export class FrameMeter {
  /** @type {{at_ms: number, age_ms: number | null}[]} */
  #frames = [];

  /** Whether there has been any. */
  ever = false;

  /**
   * @param {number} at_ms
   * @param {number | null} age_ms  null: the server's clock is not known yet
   */
  add(at_ms, age_ms) {
    this.ever = true;
    this.#frames.push({ at_ms, age_ms });
    this.#forget(at_ms);
  }

  /**
   * @param {number} now_ms
   * @returns {{per_second: number, age_ms: number | null}} the age is the median, null where nobody knows
   */
  read(now_ms) {
    this.#forget(now_ms);
    const ages = this.#frames.flatMap((f) => f.age_ms ?? []).sort((a, b) => a - b);
    return { per_second: this.#frames.length, age_ms: ages[Math.floor(ages.length / 2)] ?? null };
  }

  /** @param {number} now_ms */
  #forget(now_ms) {
    this.#frames = this.#frames.filter((f) => now_ms - f.at_ms < kWindow_ms);
  }
}

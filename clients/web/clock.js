/**
 * The server's steady clock, read from here: NTP's estimate over `server.ping`. The quickest round trip of late is the
 * truest: the estimate is off by half of it at most.
 */

/** Samples that are kept, and for how long: the two clocks drift by some tens of microseconds a second. */
const kSamples = 16;
const kSampleLife_us = 60e6;

/**
 * @typedef {object} ClockSample
 * @property {number} received_us    local clock
 * @property {number} round_trip_us
 * @property {number} offset_us      server minus local
 */

export class ServerClock {
  /** @type {ClockSample[]} */
  #samples = [];
  #local_us;

  /** @param {() => number} local_us  a steady local clock, microseconds */
  constructor(local_us = () => performance.now() * 1000) {
    this.#local_us = local_us;
  }

  /** Another server, or the same one again: its clock may be another. */
  reset() {
    this.#samples = [];
  }

  /** The local clock, to be read before a ping and after its answer. */
  local_us() {
    return this.#local_us();
  }

  /**
   * @param {number} sent_us      local reading when the question left
   * @param {number} server_us    the answer
   * @param {number} received_us  local reading when the answer came
   */
  add(sent_us, server_us, received_us) {
    const sample = {
      received_us,
      round_trip_us: received_us - sent_us,
      offset_us: server_us - (sent_us + received_us) / 2,
    };
    this.#samples = [...this.#samples, sample]
      .filter((s) => received_us - s.received_us <= kSampleLife_us)
      .slice(-kSamples);
  }

  /** @returns {ClockSample | null} the one that is believed; null before the first */
  get best() {
    return this.#samples.reduce(
      (best, s) => (best && best.round_trip_us <= s.round_trip_us ? best : s),
      /** @type {ClockSample | null} */ (null),
    );
  }

  /** @returns {number | null} what the server's clock says now; null while nobody knows */
  now_us() {
    const best = this.best;
    return best ? this.#local_us() + best.offset_us : null;
  }
}

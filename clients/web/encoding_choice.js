/**
 * How pictures are asked for: by what somebody has chosen, and what browser and server can do.
 *
 * @import {Connection} from "./connection.js"
 */
import { Listeners } from "./listeners.js";

/** @typedef {"h264" | "jpeg"} FrameEncoding */
/** @typedef {"auto" | FrameEncoding} EncodingWish */

/**
 * The most that the page asks for: as many pixels as 1280 × 720 have, 30 times a second, which in some shapes are more macroblocks
 * than level 3.1 has.
 */
const kLargestCodec = "avc1.42c020";

/**
 * Whether this browser decodes live H.264. WebCodecs is there on pages that came by https or from localhost.
 * @param {{VideoDecoder?: {isConfigSupported(config: VideoDecoderConfig): Promise<VideoDecoderSupport>}}} [scope]
 * @returns {Promise<string>} "" if so, else why not
 */
export async function obstacle_to_h264(scope = globalThis) {
  if (!scope.VideoDecoder) return globalThis.isSecureContext === false ? "needs https or localhost" : "not in this browser";
  try {
    const { supported } = await scope.VideoDecoder.isConfigSupported({ codec: kLargestCodec, optimizeForLatency: true });
    return supported ? "" : "not in this browser";
  } catch {
    return "not in this browser";
  }
}

export class EncodingChoice {
  /** @type {EncodingWish} */
  #wish = "auto";
  /** @type {string | null} why the browser can't; "": it can; null: not known yet */
  #obstacle = null;
  #offered = true;
  /** Why H.264 is not used though it could be; "": it is. Of this connection. */
  #trouble = "";
  /** @type {FrameEncoding | null} */
  #told = null;

  /** @type {Listeners<FrameEncoding>} */
  changes = new Listeners();
  /** @type {Listeners<void>} told when anything that can be read here may have changed */
  updates = new Listeners();

  /** @param {EncodingWish} wish */
  choose(wish) {
    this.#wish = wish;
    this.#trouble = ""; // who asks for it again has it tried again
    this.#say();
  }

  /** @param {string} obstacle  what obstacle_to_h264() found */
  set_obstacle(obstacle) {
    this.#obstacle = obstacle;
    this.#say();
  }

  /** @param {Connection["state"]} state  the server tells what it has */
  follow({ hello }) {
    if (!hello) {
      this.#trouble = ""; // the next may be another server, and another way to it
      return;
    }
    this.#offered = hello.capabilities.includes("frames:h264");
    this.#say();
  }

  /**
   * H.264 was tried and can't be used. Whoever has chosen it is given the choice again.
   * @param {string} [why]  in a word or two
   */
  give_up(why = "H.264 failed") {
    this.#wish = this.#wish === "h264" ? "auto" : this.#wish;
    this.#trouble = why;
    this.#say();
  }

  /** The connection takes less than H.264 brings: JPEG adapts. Who has chosen H.264 keeps it. */
  too_slow() {
    if (this.#wish === "auto" && this.encoding === "h264") this.give_up("slow connection");
  }

  get wish() {
    return this.#wish;
  }

  /** Why what is chosen automatically is not H.264, though nothing speaks against it; "": it is. */
  get trouble() {
    return this.#trouble;
  }

  /** "": nothing speaks against it. */
  get why_not_h264() {
    return this.#obstacle || (this.#offered ? "" : "not on this server");
  }

  /** @returns {FrameEncoding | null} null: not known yet */
  get encoding() {
    if (this.#wish === "jpeg") return "jpeg";
    if (this.#obstacle === null) return null;
    return this.why_not_h264 || this.#trouble ? "jpeg" : "h264";
  }

  #say() {
    this.updates.tell();
    const { encoding } = this;
    if (encoding === null || encoding === this.#told) return;
    this.#told = encoding;
    this.changes.tell(encoding);
  }
}

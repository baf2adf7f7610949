/**
 * How pictures are asked for: by what somebody has chosen, and what browser and server can do.
 *
 * @import {Connection} from "./connection.js"
 */
import { Listeners } from "./listeners.js";

/** @typedef {"h264" | "jpeg"} FrameEncoding */
/** @typedef {"auto" | FrameEncoding} EncodingWish */

/** What a stream of at most 1280 × 720 is at 30 pictures a second: whoever decodes this decodes all that the page asks for. */
const kTypicalCodec = "avc1.42c01f";

/**
 * Whether this browser decodes live H.264. WebCodecs is there on pages that came by https or from localhost.
 * @param {{VideoDecoder?: {isConfigSupported(config: VideoDecoderConfig): Promise<VideoDecoderSupport>}}} [scope]
 * @returns {Promise<string>} "" if so, else why not
 */
export async function obstacle_to_h264(scope = globalThis) {
  if (!scope.VideoDecoder) return globalThis.isSecureContext === false ? "needs https or localhost" : "not in this browser";
  try {
    const { supported } = await scope.VideoDecoder.isConfigSupported({ codec: kTypicalCodec, optimizeForLatency: true });
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
  #broken = false;
  /** @type {FrameEncoding | null} */
  #told = null;

  /** @type {Listeners<FrameEncoding>} */
  changes = new Listeners();
  /** @type {Listeners<void>} told when `why_not_h264` may have changed */
  updates = new Listeners();

  /** @param {EncodingWish} wish */
  choose(wish) {
    this.#wish = wish;
    this.#broken = false; // who asks for it again has it tried again
    this.#say();
  }

  /** @param {string} obstacle  what obstacle_to_h264() found */
  set_obstacle(obstacle) {
    this.#obstacle = obstacle;
    this.#say();
  }

  /** @param {Connection["state"]} state  the server tells what it has */
  follow({ hello }) {
    if (!hello) return;
    this.#offered = hello.capabilities.includes("frames:h264");
    this.#say();
  }

  /** H.264 was tried and can't be used. */
  give_up() {
    this.#broken = true;
    this.#say();
  }

  /** "": nothing speaks against it. */
  get why_not_h264() {
    return this.#obstacle || (this.#offered ? "" : "not on this server");
  }

  /** @returns {FrameEncoding | null} null: not known yet */
  get encoding() {
    if (this.#wish === "jpeg") return "jpeg";
    if (this.#obstacle === null) return null;
    return this.why_not_h264 || this.#broken ? "jpeg" : "h264";
  }

  #say() {
    this.updates.tell();
    const { encoding } = this;
    if (encoding === null || encoding === this.#told) return;
    this.#told = encoding;
    this.changes.tell(encoding);
  }
}

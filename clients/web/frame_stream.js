/**
 * The stream of pictures: brings what the server sends to what is wanted (encoding, size, camera, whether anybody looks), one
 * request at a time, so that a fast hand never gets ahead of a slow connection.
 *
 * @import {Connection} from "./connection.js"
 * @import {FrameEncoding} from "./encoding_choice.js"
 * @import {StreamCamera} from "./view_camera.js"
 * @import {Packet} from "./packet.js"
 */
import { RpcError } from "./connection.js";
import { decode_packet } from "./packet.js";
import { Listeners } from "./listeners.js";

const kRate = 30;
const kQuality = 80;
/** About 1280 × 720: beyond it, sharpness costs the server more than it gives the eye. */
const kMostPixels = 1280 * 720;
const kLeastSide = 16;
/** Parameters of `stream.open` that an encoding may not be able to take. */
const kOfEncoding = new Set(["params.encoding", "params.width", "params.height", "params.bitrate"]);

/** @typedef {{width: number, height: number}} Size */
/** @typedef {{encoding: FrameEncoding, codec: string} & Size} FrameLayout  what the pictures of a stream are */

/**
 * The size to ask for: that of the screen's pixels, even (as H.264 needs it), within the cap, in the same shape.
 * @param {number} css_width
 * @param {number} css_height
 * @param {number} pixel_ratio
 * @returns {Size}
 */
export function stream_size(css_width, css_height, pixel_ratio) {
  const [width, height] = [css_width * pixel_ratio, css_height * pixel_ratio];
  const scale = Math.min(1, Math.sqrt(kMostPixels / Math.max(width * height, 1)));
  /** @param {number} side */
  const even = (side) => Math.max(kLeastSide, 2 * Math.floor((side * scale) / 2));
  return { width: even(width), height: even(height) };
}

/**
 * Whether an error says that there is no such encoding, here or of such pictures; not that there is no scene, or no more room.
 * @param {unknown} error
 * @returns {error is RpcError}
 */
function refuses_encoding(error) {
  if (!(error instanceof RpcError)) return false;
  return error.kind === "unavailable" || (error.kind === "invalid_params" && kOfEncoding.has(error.path));
}

export class FrameStream {
  #connection;
  #scene;
  #report;
  /** @type {Size | null} */
  #size = null;
  /** @type {FrameEncoding | null} */
  #encoding = null;
  /** @type {StreamCamera | null} */
  #camera = null;
  #watched = true;
  /** @type {{stream: number, encoding: FrameEncoding, size: Size, camera: StreamCamera | null} | null} what the server has */
  #open = null;
  #busy = false;
  /** Counts what was wanted; what failed is not tried again until something else is. */
  #wish = 0;
  #failed_wish = -1;

  /** @type {Listeners<FrameLayout>} told before the first packet of each stream */
  opened = new Listeners();
  /** @type {Listeners<void>} told when nobody looks any more */
  closed = new Listeners();
  /** @type {Listeners<Packet>} */
  packets = new Listeners();
  /** @type {Listeners<RpcError>} H.264 was asked for and refused */
  refusals = new Listeners();

  /**
   * @param {Connection} connection
   * @param {string} scene
   * @param {(error: unknown) => void} report
   */
  constructor(connection, scene, report) {
    this.#connection = connection;
    this.#scene = scene;
    this.#report = report;
    connection.states.add(() => {
      this.#open = null; // streams go with their connection
      this.#wanted();
    });
    connection.packets.add((bytes) => this.#receive(bytes));
    connection.events.add(({ method, params }) => {
      if (method !== "stream.ended" || params.stream !== this.#open?.stream) return;
      this.#open = null;
      this.#fail(this.#wish, new Error(`the picture has ended: ${params.reason}`));
    });
  }

  /** @param {Size} size */
  set_size(size) {
    this.#size = size;
    this.#wanted();
  }

  /** @param {FrameEncoding} encoding  nothing is asked for before it is known */
  set_encoding(encoding) {
    this.#encoding = encoding;
    this.#wanted();
  }

  /** Asks for a packet that decodes on its own. */
  request_key() {
    const open = this.#open;
    if (!open) return;
    this.#connection.call("stream.request_key", { stream: open.stream }).catch((error) => {
      if (this.#open === open) this.#report(error); // else the stream has gone meanwhile
    });
  }

  /** @param {StreamCamera | null} camera  null: the scene's */
  set_camera(camera) {
    this.#camera = camera;
    this.#wanted();
  }

  /** @param {boolean} watched  a page that nobody sees asks for no pictures */
  set_watched(watched) {
    this.#watched = watched;
    this.#wanted();
  }

  #wanted() {
    this.#wish += 1;
    if (!this.#busy) void this.#reconcile();
  }

  /**
   * @param {number} wish
   * @param {unknown} error
   */
  #fail(wish, error) {
    this.#failed_wish = wish; // asked again, the same would be answered the same
    this.#report(error);
  }

  async #reconcile() {
    this.#busy = true;
    for (let step = this.#next_step(); step; step = this.#next_step()) {
      const wish = this.#wish;
      try {
        await step();
      } catch (error) {
        this.#fail(wish, error);
      }
    }
    this.#busy = false;
  }

  /** @returns {(() => Promise<void>) | null} */
  #next_step() {
    if (this.#failed_wish === this.#wish || this.#connection.state.phase !== "open") return null;
    const [open, size, encoding] = [this.#open, this.#size, this.#encoding];
    if (!this.#watched || !size || !encoding) return open && (() => this.#close(open.stream));
    const same = open?.encoding === encoding && open.size.width === size.width && open.size.height === size.height;
    if (!open || !same) return () => this.#replace(size, encoding);
    if (open.camera !== this.#camera) return () => this.#update(open);
    return null;
  }

  /**
   * @param {Size} size
   * @param {FrameEncoding} encoding
   */
  async #replace(size, encoding) {
    const camera = this.#camera;
    const opened = await this.#ask(size, encoding, camera);
    if (!opened) return;
    const { stream, layout } = opened;
    const before = this.#open;
    this.#open = { stream, encoding, size, camera };
    try {
      this.opened.tell({ encoding, codec: layout.codec, ...size });
    } finally {
      if (before) await this.#connection.call("stream.close", { stream: before.stream }); // no gap: the new one is there
    }
  }

  /**
   * @param {Size} size
   * @param {FrameEncoding} encoding
   * @param {StreamCamera | null} camera
   * @returns {Promise<{stream: number, layout: {codec: string}} | null>} null: refused, and another encoding is wanted since
   */
  async #ask(size, encoding, camera) {
    try {
      return await this.#connection.call("stream.open", {
        kind: "frames",
        scene: this.#scene,
        encoding,
        rate: kRate,
        ...(encoding === "jpeg" ? { quality: kQuality } : {}),
        ...size,
        ...(camera ? { camera } : {}),
      });
    } catch (error) {
      if (encoding === "h264" && refuses_encoding(error)) this.refusals.tell(error);
      if (encoding === this.#encoding) throw error;
      return null;
    }
  }

  /** @param {{stream: number, camera: StreamCamera | null}} open */
  async #update(open) {
    const camera = this.#camera;
    await this.#connection.call("stream.update", { stream: open.stream, camera });
    open.camera = camera;
  }

  /** @param {number} stream */
  async #close(stream) {
    this.#open = null;
    this.closed.tell();
    await this.#connection.call("stream.close", { stream });
  }

  /** @param {ArrayBuffer} bytes */
  #receive(bytes) {
    try {
      const packet = decode_packet(bytes);
      if (packet.stream === this.#open?.stream) this.packets.tell(packet);
    } catch (error) {
      this.#report(error);
    }
  }
}

/**
 * The canvas: has pictures decoded and draws the newest, once a frame of the screen. What is not drawn before something newer
 * has come is never drawn.
 *
 * @import {Packet} from "./packet.js"
 * @import {FrameLayout, Size} from "./frame_stream.js"
 */
import { Listeners } from "./listeners.js";
import { stream_size } from "./frame_stream.js";
import { StillDecoder } from "./still_decoder.js";
import { UnitDecoder } from "./video_decoder.js";

/** While a window is being resized, the old picture is stretched; a new size is asked for when the hand rests. */
const kResizeRest_ms = 200;

/**
 * @typedef {object} PictureSink  what a decoder tells
 * @property {(image: ImageBitmap | VideoFrame, packet: Packet) => void} show  takes the image over
 * @property {() => void} need_key                  it can't go on before a packet that decodes on its own
 * @property {(error: unknown) => void} fail        it can't go on at all
 * @property {(error: unknown) => void} report      of one picture
 */

/** @typedef {{packet: Packet, layout: FrameLayout, size: Size}} Drawn  what was asked for, and the size that the picture came in */

/** @param {ImageBitmap | VideoFrame} image @returns {Size} */
function size_of(image) {
  if ("displayWidth" in image) return { width: image.displayWidth, height: image.displayHeight };
  return { width: image.width, height: image.height };
}

export class FrameView {
  #canvas;
  #context;
  #report;
  /** @type {StillDecoder | UnitDecoder | null} of the stream that was opened last */
  #decoder = null;
  /** @type {{image: ImageBitmap | VideoFrame, packet: Packet, layout: FrameLayout} | null} waits for the screen */
  #decoded = null;

  /** @type {Listeners<Drawn>} told when a picture is on the canvas */
  drawn = new Listeners();
  /** @type {Listeners<void>} the decoder needs a packet that decodes on its own */
  keys_needed = new Listeners();
  /** @type {Listeners<unknown>} the encoding can't be decoded here after all */
  failures = new Listeners();
  /** @type {Listeners<Size>} the size that pictures should have */
  sizes = new Listeners();

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {(error: unknown) => void} report
   */
  constructor(canvas, report) {
    this.#canvas = canvas;
    this.#report = report;
    const context = canvas.getContext("2d");
    if (!context) throw new Error("expected a canvas that can be drawn on, found none; is there enough memory?");
    this.#context = context;
  }

  /** The height of the picture in CSS pixels, what gestures are measured by. */
  get css_height() {
    return this.#canvas.clientHeight;
  }

  /** Watches the size of the element, and the density of the screen it is on. */
  start() {
    let timer = 0;
    const say = () => {
      const { clientWidth, clientHeight } = this.#canvas;
      if (clientWidth > 0 && clientHeight > 0) {
        this.sizes.tell(stream_size(clientWidth, clientHeight, devicePixelRatio));
      }
    };
    const soon = () => {
      clearTimeout(timer);
      timer = setTimeout(say, kResizeRest_ms);
    };
    new ResizeObserver(soon).observe(this.#canvas);
    addEventListener("resize", soon);
    say();
  }

  /**
   * Another stream begins; the last picture stays until its first.
   * @param {FrameLayout} layout
   */
  begin(layout) {
    this.end();
    /** @type {PictureSink} */
    const sink = {
      show: (image, packet) => this.#show(image, packet, layout),
      need_key: () => this.keys_needed.tell(),
      fail: (error) => this.failures.tell(error),
      report: this.#report,
    };
    try {
      this.#decoder = layout.encoding === "h264" ? new UnitDecoder(layout.codec, sink) : new StillDecoder(sink);
    } catch (error) {
      this.failures.tell(error); // there is no such decoder, though there seemed to be
    }
  }

  /** Lets go of the stream's decoder, of which a device may have few; the last picture stays. */
  end() {
    this.#decoder?.close();
    this.#decoder = null;
  }

  /** @param {Packet} packet */
  push(packet) {
    this.#decoder?.push(packet);
  }

  /**
   * @param {ImageBitmap | VideoFrame} image
   * @param {Packet} packet
   * @param {FrameLayout} layout
   */
  #show(image, packet, layout) {
    if (this.#decoded) {
      this.#decoded.image.close(); // it came too late for the screen
    } else {
      requestAnimationFrame(() => this.#draw());
    }
    this.#decoded = { image, packet, layout };
  }

  /** Pictures that the server has made smaller for a slow connection fill the canvas all the same. */
  #draw() {
    const decoded = this.#decoded;
    if (!decoded) return;
    this.#decoded = null;
    const { image, packet, layout } = decoded;
    const { width, height } = layout;
    if (this.#canvas.width !== width || this.#canvas.height !== height) {
      Object.assign(this.#canvas, { width, height }); // also clears it, so only where it has to
    }
    const size = size_of(image);
    this.#context.drawImage(image, 0, 0, width, height);
    image.close();
    this.drawn.tell({ packet, layout, size });
  }
}

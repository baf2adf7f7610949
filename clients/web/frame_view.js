/**
 * The canvas: decodes pictures and draws the newest, once a frame of the screen. What is not drawn before something newer
 * has come is never drawn.
 *
 * @import {Packet} from "./packet.js"
 * @import {Size} from "./frame_stream.js"
 */
import { Listeners } from "./listeners.js";
import { image_type } from "./packet.js";
import { stream_size } from "./frame_stream.js";

/** While a window is being resized, the old picture is stretched; a new size is asked for when the hand rests. */
const kResizeRest_ms = 200;

export class FrameView {
  #canvas;
  #context;
  #report;
  /** @type {Packet | null} came while another was being decoded */
  #waiting = null;
  #decoding = false;
  /** @type {{bitmap: ImageBitmap, packet: Packet} | null} */
  #decoded = null;

  /** @type {Listeners<Packet>} told when its picture is on the canvas */
  drawn = new Listeners();
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

  /** @param {Packet} packet */
  push(packet) {
    this.#waiting = packet;
    if (!this.#decoding) void this.#decode();
  }

  async #decode() {
    this.#decoding = true;
    while (this.#waiting) {
      const packet = this.#waiting;
      this.#waiting = null;
      try {
        const bitmap = await createImageBitmap(new Blob([packet.payload], { type: image_type(packet) }));
        this.#show(bitmap, packet);
      } catch (error) {
        this.#report(new Error(`the picture can't be decoded: ${error instanceof Error ? error.message : error}`));
      }
    }
    this.#decoding = false;
  }

  /**
   * @param {ImageBitmap} bitmap
   * @param {Packet} packet
   */
  #show(bitmap, packet) {
    if (this.#decoded) {
      this.#decoded.bitmap.close(); // it came too late for the screen
    } else {
      requestAnimationFrame(() => this.#draw());
    }
    this.#decoded = { bitmap, packet };
  }

  #draw() {
    const decoded = this.#decoded;
    if (!decoded) return;
    this.#decoded = null;
    const { bitmap, packet } = decoded;
    const { width, height } = bitmap;
    if (this.#canvas.width !== width || this.#canvas.height !== height) {
      Object.assign(this.#canvas, { width, height }); // also clears it, so only where it has to
    }
    this.#context.drawImage(bitmap, 0, 0);
    bitmap.close();
    this.drawn.tell(packet);
  }
}

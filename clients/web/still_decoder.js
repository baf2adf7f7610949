/**
 * Decodes pictures that each stand alone (JPEG, PNG), the newest first: what is not begun before something newer has come
 * never is.
 *
 * @import {Packet} from "./packet.js"
 * @import {PictureSink} from "./frame_view.js"
 */
import { image_type } from "./packet.js";

/** @typedef {(payload: Blob) => Promise<ImageBitmap>} DecodeImage */

export class StillDecoder {
  #sink;
  #decode_image;
  /** @type {Packet | null} came while another was being decoded */
  #waiting = null;
  #busy = false;
  #closed = false;

  /**
   * @param {PictureSink} sink
   * @param {DecodeImage} [decode_image]
   */
  constructor(sink, decode_image = (blob) => createImageBitmap(blob)) {
    this.#sink = sink;
    this.#decode_image = decode_image;
  }

  /** @param {Packet} packet */
  push(packet) {
    this.#waiting = packet;
    if (!this.#busy) void this.#run();
  }

  /** Nothing is shown after it. */
  close() {
    this.#closed = true;
    this.#waiting = null;
  }

  async #run() {
    this.#busy = true;
    while (this.#waiting) {
      const packet = this.#waiting;
      this.#waiting = null;
      const bitmap = await this.#decode(packet);
      if (this.#closed) bitmap?.close();
      else if (bitmap) this.#sink.show(bitmap, packet);
    }
    this.#busy = false;
  }

  /**
   * @param {Packet} packet
   * @returns {Promise<ImageBitmap | null>} null: it is none, which has been reported
   */
  async #decode(packet) {
    try {
      return await this.#decode_image(new Blob([packet.payload], { type: image_type(packet) }));
    } catch (error) {
      const why = error instanceof Error ? error.message : error;
      if (!this.#closed) this.#sink.report(new Error(`the picture can't be decoded: ${why}`));
      return null;
    }
  }
}

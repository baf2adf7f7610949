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
      try {
        const bitmap = await this.#decode_image(new Blob([packet.payload], { type: image_type(packet) }));
        if (this.#closed) bitmap.close();
        else this.#sink.show(bitmap, packet);
      } catch (error) {
        this.#sink.report(new Error(`the picture can't be decoded: ${error instanceof Error ? error.message : error}`));
      }
    }
    this.#busy = false;
  }
}

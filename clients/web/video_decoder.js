/**
 * Decodes a live H.264 stream by WebCodecs: each packet is one access unit (Annex B, so that no description is needed), a
 * packet without the key flag needs its predecessor. What can't be decoded, or not in time, is dropped up to the next key,
 * which is asked for.
 *
 * @import {Packet} from "./packet.js"
 * @import {PictureSink} from "./frame_view.js"
 */
import { kEncodingH264, kKindFrame, PacketError } from "./packet.js";

/** Units that the decoder has not begun. More of them, and it is slower than the stream: what waits is of the past. */
const kMostQueued = 8;

/** @typedef {(init: VideoDecoderInit) => VideoDecoder} MakeDecoder */

export class UnitDecoder {
  #codec;
  #sink;
  #make;
  /** @type {VideoDecoder} */
  #decoder;
  /** @type {Map<number, Packet>} by timestamp, in the order in which they were handed over */
  #handed = new Map();
  #waits_for_key = true;
  /** @type {number | null} of the last unit handed over */
  #sequence = null;
  /** Something went wrong, and no picture has come since. */
  #troubled = false;
  #closed = false;

  /**
   * @param {string} codec  as `stream.open` told it
   * @param {PictureSink} sink
   * @param {MakeDecoder} [make]
   */
  constructor(codec, sink, make = (init) => new VideoDecoder(init)) {
    this.#codec = codec;
    this.#sink = sink;
    this.#make = make;
    this.#decoder = this.#begin();
  }

  /**
   * @param {Packet} packet
   * @throws {PacketError} if it is no unit of H.264
   */
  push(packet) {
    if (packet.kind !== kKindFrame || packet.encoding !== kEncodingH264) {
      throw new PacketError(`expected a frame as h264, found kind ${packet.kind}, encoding ${packet.encoding}`);
    }
    if (this.#closed) return;
    if (packet.key) this.#take_key();
    else if (this.#waits_for_key) return;
    else if (packet.sequence !== next(this.#sequence)) return this.#wait_for_key();
    else if (this.#decoder.decodeQueueSize >= kMostQueued) return this.#trouble(new Error("the decoder is too slow"));
    this.#hand_over(packet);
  }

  /** Nothing is shown after it. */
  close() {
    this.#closed = true;
    this.#handed.clear();
    if (this.#decoder.state !== "closed") this.#decoder.close();
  }

  #begin() {
    const decoder = this.#make({
      output: (frame) => (this.#decoder === decoder && !this.#closed ? this.#decoded(frame) : frame.close()),
      error: (error) => {
        if (this.#decoder === decoder && !this.#closed) this.#trouble(error);
      },
    });
    decoder.configure({ codec: this.#codec, optimizeForLatency: true });
    return decoder;
  }

  /** A key needs nothing of what came before it, so neither does what is late have to be decoded. */
  #take_key() {
    this.#waits_for_key = false;
    if (this.#decoder.decodeQueueSize >= kMostQueued) this.#renew();
  }

  #renew() {
    if (this.#decoder.state !== "closed") this.#decoder.close();
    this.#handed.clear();
    this.#decoder = this.#begin();
  }

  /** @param {Packet} packet */
  #hand_over(packet) {
    this.#sequence = packet.sequence;
    this.#handed.set(packet.server_us, packet);
    const { payload: data, server_us: timestamp } = packet;
    try {
      this.#decoder.decode(new EncodedVideoChunk({ type: packet.key ? "key" : "delta", timestamp, data }));
    } catch (error) {
      this.#trouble(error);
    }
  }

  /** @param {VideoFrame} frame */
  #decoded(frame) {
    this.#troubled = false;
    const packet = this.#handed.get(frame.timestamp);
    if (!packet) return frame.close();
    for (const timestamp of this.#handed.keys()) {
      this.#handed.delete(timestamp); // what was handed over earlier will not come any more
      if (timestamp === frame.timestamp) break;
    }
    this.#sink.show(frame, packet);
  }

  #wait_for_key() {
    this.#waits_for_key = true;
    this.#sink.need_key();
  }

  /**
   * A first time may be the stream's or a moment's; a second one without any picture between is the decoder's.
   * @param {unknown} error
   */
  #trouble(error) {
    if (this.#troubled) {
      this.close();
      this.#sink.fail(error);
      return;
    }
    this.#troubled = true;
    if (this.#decoder.state === "closed") this.#renew(); // an error has closed it
    this.#wait_for_key();
  }
}

/**
 * Sequence numbers are 32 bits and go round.
 * @param {number | null} sequence
 */
function next(sequence) {
  return sequence === null ? null : (sequence + 1) >>> 0;
}

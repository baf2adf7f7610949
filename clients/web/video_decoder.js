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
/** Some decoders take half a second before they begin. One that has put nothing out for so long, by the stream's time, never will. */
const kLongestStart_us = 5_000_000;

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
  /** This decoder has put something out: before that it may be starting, and being full is no trouble. */
  #started = false;
  /** @type {number | null} server_us of the first unit handed to this decoder */
  #first_us = null;
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
    if (packet.key) return this.#take_key(packet);
    if (this.#waits_for_key) return;
    if (packet.sequence !== next(this.#sequence)) return this.#wait_for_key();
    if (!this.#is_full) return this.#hand_over(packet);
    if (this.#started) this.#trouble(new Error("the decoder is too slow"));
    else this.#wait_for_key();
  }

  /** Nothing is shown after it. */
  close() {
    this.#closed = true;
    this.#handed.clear();
    if (this.#decoder.state !== "closed") this.#decoder.close();
  }

  get #is_full() {
    return this.#decoder.decodeQueueSize >= kMostQueued;
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

  /**
   * A key needs nothing of what came before it, so neither does what is late have to be decoded; but a decoder that is still
   * starting would only have to start again.
   * @param {Packet} packet
   */
  #take_key(packet) {
    if (this.#is_full && !this.#started) {
      if (packet.server_us - (this.#first_us ?? 0) < kLongestStart_us) return this.#wait_for_key();
      return this.#end(new Error("the decoder does not begin"));
    }
    this.#waits_for_key = false;
    if (this.#is_full) this.#renew();
    this.#hand_over(packet);
  }

  #renew() {
    if (this.#decoder.state !== "closed") this.#decoder.close();
    this.#handed.clear();
    this.#started = false;
    this.#first_us = null;
    try {
      this.#decoder = this.#begin();
    } catch (error) {
      this.#end(error);
    }
  }

  /** @param {Packet} packet */
  #hand_over(packet) {
    if (this.#closed) return; // there was no decoder to be had
    this.#first_us ??= packet.server_us;
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
    this.#started = true;
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
    if (this.#troubled) return this.#end(error);
    this.#troubled = true;
    if (this.#decoder.state === "closed") this.#renew(); // an error has closed it
    if (!this.#closed) this.#wait_for_key();
  }

  /** @param {unknown} error */
  #end(error) {
    this.close();
    this.#sink.fail(error);
  }
}

/**
 * Sequence numbers are 32 bits and go round.
 * @param {number | null} sequence
 */
function next(sequence) {
  return sequence === null ? null : (sequence + 1) >>> 0;
}

/**
 * Just enough of RFC 6455 to speak with a browser on loopback: whole messages, no extensions.
 */
import { createHash } from "node:crypto";

const kGuid = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";

/** One accepted WebSocket. */
export class ServerSocket {
  #stream;
  #received = Buffer.alloc(0);
  on_message = (/** @type {string} */ _text) => {};
  on_close = () => {};

  /** @param {import("node:http").IncomingMessage} request @param {import("node:net").Socket} stream */
  constructor(request, stream) {
    this.#stream = stream;
    const key = request.headers["sec-websocket-key"];
    const accept = createHash("sha1").update(key + kGuid).digest("base64");
    stream.write(
      "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" +
        `Sec-WebSocket-Protocol: tweend.v1\r\nSec-WebSocket-Accept: ${accept}\r\n\r\n`,
    );
    stream.setNoDelay(true);
    stream.on("data", (bytes) => this.#receive(bytes));
    stream.on("close", () => this.on_close());
    stream.on("error", () => stream.destroy());
  }

  /** What waits to be sent, bytes. */
  get waiting() {
    return this.#stream.writableLength;
  }

  /** @param {string | Buffer} message */
  send(message) {
    const payload = Buffer.from(message);
    const head = Buffer.alloc(10);
    head[0] = 0x80 | (typeof message === "string" ? 1 : 2);
    const size = payload.length;
    let used = 2;
    if (size < 126) head[1] = size;
    else if (size < 65536) used = head.writeUInt16BE(size, ((head[1] = 126), 2));
    else used = head.writeBigUInt64BE(BigInt(size), ((head[1] = 127), 2));
    this.#stream.write(Buffer.concat([head.subarray(0, used), payload]));
  }

  /** @param {Buffer} bytes */
  #receive(bytes) {
    this.#received = Buffer.concat([this.#received, bytes]);
    for (let frame = this.#take(); frame; frame = this.#take()) {
      if (frame.opcode === 8) this.#stream.end();
      else if (frame.opcode === 1) this.on_message(frame.payload.toString());
    }
  }

  #take() {
    const all = this.#received;
    if (all.length < 6) return null;
    const short = all[1] & 0x7f;
    const extra = short === 126 ? 2 : short === 127 ? 8 : 0;
    if (all.length < 6 + extra) return null;
    const size = extra === 2 ? all.readUInt16BE(2) : extra === 8 ? Number(all.readBigUInt64BE(2)) : short;
    const start = 6 + extra;
    if (all.length < start + size) return null;
    const mask = all.subarray(start - 4, start);
    const payload = Buffer.from(all.subarray(start, start + size).map((byte, i) => byte ^ mask[i % 4]));
    this.#received = all.subarray(start + size);
    return { opcode: all[0] & 0x0f, payload };
  }
}

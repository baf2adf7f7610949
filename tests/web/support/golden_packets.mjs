/**
 * The packets that the server's own tests write and read: tests/protocol/golden, its format in golden_packets.hpp.
 */
import { readFileSync } from "node:fs";

/**
 * @typedef {object} GoldenPacket
 * @property {boolean} key
 * @property {Uint8Array} payload
 * @property {Float32Array} out  what is read from it, to the last bit
 */

/**
 * @param {string} name
 * @returns {{elements: number, weights: number, packets: GoldenPacket[]}}
 */
export function read_golden(name) {
  const file = readFileSync(new URL(`../../protocol/golden/${name}`, import.meta.url));
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  let at = 0;
  const number = () => view.getUint32((at += 4) - 4, true);
  const floats = (count) => Float32Array.from({ length: count }, () => view.getFloat32((at += 4) - 4, true));
  const elements = number();
  const weights = number();
  const packets = Array.from({ length: number() }, () => {
    const flags = number();
    const payload_bytes = number();
    const float_count = number();
    const payload = new Uint8Array(file.subarray(at, at + payload_bytes));
    at += payload_bytes;
    at += 4 * float_count; // what was encoded
    return { key: (flags & 2) !== 0, payload, out: floats(float_count) };
  });
  return { elements, weights, packets };
}
